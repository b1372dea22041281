#include "adapters/table/cells/decimal_sign.hpp"

#include <algorithm>
#include <vector>

#include "adapters/csv/fields.hpp"
#include "adapters/table/cells/cell_number.hpp"

namespace recald::table {
namespace {

/// Counts cells with one meaning of their signs.
struct Signs {
  std::size_t count = 0;
  const KeptRow* row = nullptr;  ///< The latest of these.
  std::string cell;

  void add(const KeptRow& in, std::string_view text) {
    ++count;
    row = &in;
    cell = text;
  }
  [[nodiscard]] std::string words() const {
    return "row " + std::to_string(row->number) + " has " + csv::in_quotes(cell);
  }
};

struct SignsFound {
  Signs points;
  Signs commas;
  Signs open_points;  // 1.234 may be about a thousand, or about one
  Signs open_commas;
  std::size_t plain = 0;  ///< Without a sign, in columns where others have one.

  [[nodiscard]] bool decides() const { return points.count != commas.count; }
  [[nodiscard]] bool is_open() const { return open_points.count + open_commas.count > 0; }
};

SignsFound signs_in(std::span<const KeptRow* const> rows, std::span<const std::size_t> columns) {
  SignsFound found;
  std::vector<std::size_t> plain(columns.size());
  std::vector<bool> has_sign(columns.size());
  for (const KeptRow* row : rows) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string_view cell = split_number(cell_of(*row, columns[i])).number;
      const DecimalSigns signs = possible_decimal_signs(cell);
      if (!signs.point && !signs.comma) continue;
      const bool has_comma = cell.find(',') != std::string_view::npos;
      if (!has_comma && cell.find('.') == std::string_view::npos) {
        ++plain[i];
        continue;
      }
      has_sign[i] = true;
      if (signs.point == signs.comma) {
        (has_comma ? found.open_commas : found.open_points).add(*row, cell);
      } else {
        (signs.point ? found.points : found.commas).add(*row, cell);
      }
    }
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (has_sign[i]) found.plain += plain[i];
  }
  return found;
}

DecimalSign decisive(const SignsFound& found) {
  const bool is_point = found.points.count > found.commas.count;
  const Signs& signs = is_point ? found.points : found.commas;
  return {is_point ? '.' : ',',
          "as in " + csv::in_quotes(signs.cell) + ", row " + std::to_string(signs.row->number)};
}

/// Every cell has three digits after the sign. If it separated thousands, smaller values
/// would have no sign.
DecimalSign open_sign(const SignsFound& found) {
  if (!found.is_open()) return {'.', "no value shows it"};
  const bool is_comma = found.open_commas.count >= found.open_points.count;
  const Signs& open = is_comma ? found.open_commas : found.open_points;
  const bool is_decimal = 19 * found.plain <= open.count;
  return {is_comma == is_decimal ? ',' : '.',
          "guessed from " + csv::in_quotes(open.cell) + ": " +
              (is_decimal ? "all values have three digits after the sign"
                          : "some values have no sign, so it sets thousands apart") +
              "; another number of digits would decide"};
}

}  // namespace

Result<DecimalSign> guess_decimal(std::span<const KeptRow* const> rows,
                                  std::span<const std::size_t> values,
                                  std::span<const std::size_t> others) {
  const SignsFound found = signs_in(rows, values);
  const std::size_t decided = found.points.count + found.commas.count;
  if (std::min(found.points.count, found.commas.count) * 100 > decided) {
    return failure(ErrorCode::malformed, "its numbers change their decimal sign: " +
                                             found.points.words() + ", " + found.commas.words());
  }
  if (found.decides()) return decisive(found);
  if (found.is_open()) {
    if (const SignsFound more = signs_in(rows, others); more.decides()) return decisive(more);
  }
  return open_sign(found);
}

}  // namespace recald::table
