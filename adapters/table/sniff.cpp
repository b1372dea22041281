#include "adapters/table/sniff.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "adapters/csv/fields.hpp"
#include "adapters/table/cell_number.hpp"
#include "adapters/table/delimited.hpp"
#include "core/metering/units.hpp"
#include "core/text/ascii.hpp"
#include "core/text/printable.hpp"

namespace recald::table {
namespace {

using metering::Instant;
using std::chrono::seconds;

constexpr double kMost = 0.8;  // share of a column's cells that must be of one kind
constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);
constexpr std::array kDateFormats{TimeFormat::year_first, TimeFormat::day_first,
                                  TimeFormat::month_first};

bool contains_any(std::string_view text, std::span<const std::string_view> words) {
  const std::string lower = to_lower(text);
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return lower.find(word) != std::string::npos; });
}

std::string_view cell_of(const KeptRow& row, std::size_t column) {
  return column < row.cells.size() ? std::string_view{row.cells[column]} : std::string_view{};
}

std::size_t filled_cells(const KeptRow& row) {
  return static_cast<std::size_t>(std::count_if(
      row.cells.begin(), row.cells.end(), [](const std::string& cell) { return !cell.empty(); }));
}

bool is_number(std::string_view cell) {
  const DecimalSigns signs = possible_decimal_signs(cell);
  return signs.point || signs.comma;
}

/// Whether a cell is a date in some order of its parts, and not a plain number, except one
/// like 202403311415.
bool is_stamp(std::string_view cell) {
  if (cell.size() < 6 || cell.size() > 40) return false;
  if (is_number(cell) && (cell.size() < 8 || !csv::is_digits(cell))) return false;
  return std::any_of(kDateFormats.begin(), kDateFormats.end(),
                     [&](TimeFormat format) { return parse_stamp(cell, format).has_value(); });
}

std::string row_words(const KeptRow& row) { return "row " + std::to_string(row.number); }

/// The contents of one column in the rows below the header.
struct ColumnKinds {
  std::size_t filled = 0;
  std::size_t numbers = 0;
  std::size_t times_of_day = 0;
  std::set<std::string> texts;  ///< Different texts that are not numbers, up to a hundred.
  std::size_t words = 0;        ///< Cells that are not numbers.

  [[nodiscard]] bool is_mostly(std::size_t count) const {
    return filled > 0 && static_cast<double>(count) >= kMost * static_cast<double>(filled);
  }
};

/// Builds up the guess step by step.
class TableSniffer {
 public:
  explicit TableSniffer(std::span<const KeptRow> rows) {
    for (const KeptRow& row : rows) {
      if (filled_cells(row) > 0) rows_.push_back(&row);
      width_ = std::max(width_, row.cells.size());
    }
  }

  Result<TableGuess> run() {
    if (rows_.empty()) return failure(ErrorCode::malformed, "it is empty");
    TRY(find_times());
    TRY(find_header());
    inspect_columns();
    find_clock();
    TRY(find_time_format());
    find_meters();
    TRY(find_decimal());
    TRY(list_values());
    return std::move(guess_);
  }

 private:
  /// Finds the column with most stamps, and the first row that has one.
  Result<void> find_times() {
    std::size_t most = 0;
    for (std::size_t column = 0; column < width_; ++column) {
      const auto count = static_cast<std::size_t>(
          std::count_if(rows_.begin(), rows_.end(),
                        [&](const KeptRow* row) { return is_stamp(cell_of(*row, column)); }));
      if (count <= most) continue;
      most = count;
      time_ = column;
    }
    const auto is_time = [&](const KeptRow* row) { return is_stamp(cell_of(*row, time_)); };
    if (most > 0) {
      data_ = static_cast<std::size_t>(std::find_if(rows_.begin(), rows_.end(), is_time) -
                                       rows_.begin());
      if (2 * most >= rows_.size() - data_) return {};
    }
    for (std::size_t column = 0; column < width_; ++column) {
      if (find_counted_times(column)) return {};
    }
    return failure(ErrorCode::malformed,
                   "no column has dates and times in most of its rows; recald looks for such as "
                   "2024-03-31 14:15, 31/03/2024 14:15 or 03/31/2024 2:15 PM");
  }

  /// Finds a column of numbers that always rise or always fall: days of a spreadsheet, or
  /// seconds since 1970.
  bool find_counted_times(std::size_t column) {
    std::vector<double> counts;
    std::size_t first = kNowhere;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const std::string_view cell = cell_of(*rows_[i], column);
      auto count = parse_cell(cell, '.');
      if (!count) count = parse_cell(cell, ',');
      if (!count) continue;
      if (first == kNowhere) first = i;
      counts.push_back(*count);
    }
    if (counts.size() < 3 || counts.size() + first < rows_.size() * 9 / 10) return false;
    if (counts.front() > counts.back()) std::reverse(counts.begin(), counts.end());
    if (!std::is_sorted(counts.begin(), counts.end())) return false;
    const double begin = counts.front();
    const double end = counts.back();
    const double step = (end - begin) / static_cast<double>(counts.size() - 1);
    constexpr double kLatest_s =
        static_cast<double>(metering::kLatestInstant.time_since_epoch().count());
    constexpr double kLatestDay = 25'569.0 + kLatest_s / 86'400.0;  // since the end of 1899
    const bool is_excel = begin > 32'000.0 && end < kLatestDay && step > 0.0 && step < 1.01;
    const bool is_unix = (begin > 6e8 && end < kLatest_s && step >= 60.0) ||
                         (begin > 6e11 && end < 1e3 * kLatest_s && step >= 6e4);
    if (!is_excel && !is_unix) return false;
    time_ = column;
    data_ = first;
    guess_.shape.time_format = is_excel ? TimeFormat::excel : TimeFormat::unix;
    is_counted_ = true;
    return true;
  }

  Result<void> find_header() {
    if (data_ == 0) return {};
    std::size_t at = data_ - 1;
    const auto is_units = [&](const KeptRow& row) {
      std::size_t units = 0;
      for (std::size_t column = 0; column < row.cells.size(); ++column) {
        const std::string_view cell = cell_of(row, column);
        if (column == time_ || cell.empty()) continue;
        const NameAndUnit parts = split_unit(cell);
        if (!parts.name.empty() || parts.unit.empty()) return false;
        ++units;
      }
      return units > 0;
    };
    // A row of units stands below names; units without names are the header itself.
    if (at > 0 && is_units(*rows_[at]) && filled_cells(*rows_[at - 1]) >= 2 &&
        filled_cells(*rows_[at - 1]) + 1 >= filled_cells(*rows_[at])) {
      units_ = rows_[at];
      --at;
    }
    header_ = rows_[at];
    if (filled_cells(*header_) < 2) {
      header_ = nullptr;
      return {};
    }
    if (at == 0) return {};
    const KeptRow& above = *rows_[at - 1];
    const bool is_another = filled_cells(above) >= 3 &&
                            2 * filled_cells(above) >= filled_cells(*header_) &&
                            std::none_of(above.cells.begin(), above.cells.end(),
                                         [](const std::string& cell) { return is_number(cell); });
    if (!is_another) return {};
    return failure(ErrorCode::malformed,
                   "rows " + std::to_string(above.number) + " and " +
                       std::to_string(header_->number) +
                       " both look like headers; keep one row with the columns' names, and at most "
                       "a row of units below it");
  }

  [[nodiscard]] std::span<const KeptRow* const> data() const {
    return std::span{rows_}.subspan(data_);
  }

  void inspect_columns() {
    kinds_.assign(width_, {});
    for (const KeptRow* row : data()) {
      for (std::size_t column = 0; column < row->cells.size(); ++column) {
        const std::string_view cell = cell_of(*row, column);
        if (is_blank(cell)) continue;
        ColumnKinds& kinds = kinds_[column];
        ++kinds.filled;
        if (is_number(cell)) {
          ++kinds.numbers;
        } else {
          ++kinds.words;
        }
        if (parse_time_of_day(cell)) ++kinds.times_of_day;
        if (kinds.texts.size() < 100) kinds.texts.insert(std::string{cell});
      }
    }
  }

  [[nodiscard]] std::string_view header_text(std::size_t column) const {
    return header_ == nullptr ? std::string_view{} : cell_of(*header_, column);
  }

  /// The name by which the column is found again.
  [[nodiscard]] std::string column_text(std::size_t column) const {
    const std::string_view text = header_text(column);
    std::size_t first = kNowhere;
    for (std::size_t i = 0; i < width_ && first == kNowhere; ++i) {
      if (header_text(i) == text) first = i;
    }
    if (text.empty() || first != column) return "#" + std::to_string(column + 1);
    return std::string{text};
  }

  /// If the stamps are only dates, finds the column with the times.
  void find_clock() {
    guess_.shape.time_column = column_text(time_);
    if (is_counted_) return;
    const bool has_times = std::any_of(data().begin(), data().end(), [&](const KeptRow* row) {
      for (const TimeFormat format : kDateFormats) {
        const auto stamp = parse_stamp(cell_of(*row, time_), format);
        if (stamp && stamp->has_time) return stamp->clock != floor_day(stamp->clock);
      }
      return false;
    });
    if (has_times) return;
    for (std::size_t column = 0; column < width_; ++column) {
      const ColumnKinds& kinds = kinds_[column];
      if (column == time_ || !kinds.is_mostly(kinds.times_of_day)) continue;
      if (kinds.is_mostly(kinds.numbers)) continue;  // 1415 may be anything
      clock_ = column;
      guess_.shape.clock_column = column_text(column);
      return;
    }
  }

  static Instant floor_day(Instant t) { return std::chrono::floor<std::chrono::days>(t); }

  struct FormatTrial {
    std::size_t wrong = 0;
    std::size_t jumps = 0;  ///< Steps of more than a day and a half.
    const KeptRow* first_wrong = nullptr;
    std::size_t offsets = 0;
    std::size_t read = 0;
  };

  [[nodiscard]] FormatTrial trial_of(TimeFormat format) const {
    FormatTrial trial;
    std::optional<Instant> last;
    for (const KeptRow* row : data()) {
      const std::string_view cell = cell_of(*row, time_);
      if (cell.empty()) continue;
      const auto stamp = parse_stamp(cell, format);
      if (!stamp) {
        ++trial.wrong;
        if (trial.first_wrong == nullptr) trial.first_wrong = row;
        continue;
      }
      ++trial.read;
      if (stamp->utc_offset) ++trial.offsets;
      constexpr seconds kJump{36 * 3600};
      if (last && (stamp->clock - *last > kJump || *last - stamp->clock > kJump)) ++trial.jumps;
      last = stamp->clock;
    }
    return trial;
  }

  Result<void> find_time_format() {
    if (is_counted_) {
      const bool is_excel = guess_.shape.time_format == TimeFormat::excel;
      guess_.time_format_because =
          is_excel ? "days as a spreadsheet counts them" : "seconds since 1970, in UTC";
      guess_.has_offsets = !is_excel;
      return {};
    }
    std::array<FormatTrial, 3> trials;
    for (std::size_t i = 0; i < 3; ++i) trials[i] = trial_of(kDateFormats[i]);
    const auto best = static_cast<std::size_t>(
        std::min_element(trials.begin(), trials.end(),
                         [](const FormatTrial& a, const FormatTrial& b) {
                           return a.wrong != b.wrong ? a.wrong < b.wrong : a.jumps < b.jumps;
                         }) -
        trials.begin());
    const FormatTrial& trial = trials[best];
    const std::string example = csv::in_quotes(cell_of(*rows_[data_], time_));
    if (100 * trial.wrong > trial.wrong + trial.read) {
      return failure(ErrorCode::malformed,
                     "its dates change their format: " + row_words(*rows_[data_]) + " has " +
                         example + ", " + row_words(*trial.first_wrong) + " has " +
                         csv::in_quotes(cell_of(*trial.first_wrong, time_)));
    }
    guess_.shape.time_format = kDateFormats[best];
    guess_.has_offsets = trial.offsets == trial.read;
    explain(trials, best, example);
    return {};
  }

  void explain(const std::array<FormatTrial, 3>& trials, std::size_t best,
               const std::string& example) {
    guess_.time_format_because = "such as " + example;
    if (best == 0) return;
    const FormatTrial& other = trials[3 - best];
    if (other.first_wrong != nullptr) {
      guess_.time_format_because = csv::in_quotes(cell_of(*other.first_wrong, time_)) + " in " +
                                   row_words(*other.first_wrong) + " decides";
    } else if (other.jumps > trials[best].jumps) {
      guess_.time_format_because += ", the other way round its days would not follow each other";
    } else {
      guess_.is_time_format_open = true;
      guess_.time_format_because +=
          ", but it may be " + std::string{to_string(kDateFormats[3 - best])} +
          "; a day after the 12th of a month, or a second day, would decide";
    }
  }

  /// A long table has one column of numbers, and a column that names each row's meter.
  void find_meters() {
    std::vector<std::size_t> numbers;
    std::vector<std::size_t> names;
    constexpr std::array<std::string_view, 16> kMeterWords{
        "meter", "point",         "sensor",  "channel", "device", "tag",      "series", "mpan",
        "mprn",  "z\xC3\xA4hler", "zaehler", "esi id",  "esiid",  "register", "name",   "variable"};
    constexpr std::array<std::string_view, 7> kFlagWords{"status", "quality", "flag",   "estimate",
                                                         "note",   "remark",  "comment"};
    for (std::size_t column = 0; column < width_; ++column) {
      const ColumnKinds& kinds = kinds_[column];
      if (column == time_ || column == clock_ || kinds.filled == 0) continue;
      const std::string_view header = header_text(column);
      const bool is_all_units = std::all_of(kinds.texts.begin(), kinds.texts.end(),
                                            [](const std::string& text) { return is_unit(text); });
      if (is_all_units && kinds.words == kinds.filled) {
        unit_ = column;
        continue;
      }
      const bool repeats = kinds.texts.size() < 100 && kinds.texts.size() * 3 <= kinds.filled;
      const bool is_called_so =
          contains_any(header, kMeterWords) && split_unit(header).unit.empty();
      const bool may_name = repeats && !contains_any(header, kFlagWords);
      if (kinds.is_mostly(kinds.words) && may_name && (is_called_so || kinds.texts.size() > 1)) {
        names.push_back(column);
      } else if (kinds.is_mostly(kinds.numbers)) {
        numbers.push_back(column);
      }
    }
    // Names may be numbers too: 100200300 in a column called "meter id".
    if (names.empty() && numbers.size() == 2) {
      for (const std::size_t column : numbers) {
        const ColumnKinds& kinds = kinds_[column];
        const bool is_called_so = contains_any(header_text(column), kMeterWords);
        const bool are_ids = std::all_of(kinds.texts.begin(), kinds.texts.end(),
                                         [](const std::string& t) { return csv::is_digits(t); });
        if (!is_called_so || !are_ids || kinds.texts.size() * 3 > kinds.filled) continue;
        names.push_back(column);
      }
      for (const std::size_t column : names) std::erase(numbers, column);
    }
    values_ = numbers;
    if (names.empty() || numbers.size() != 1) {
      unit_of_all_ = unit_;
      unit_ = kNowhere;
      return;
    }
    const auto called = std::find_if(names.begin(), names.end(), [&](std::size_t column) {
      return contains_any(header_text(column), kMeterWords);
    });
    meter_ = called == names.end() ? names.front() : *called;
    guess_.shape.meter_column = column_text(meter_);
    if (unit_ != kNowhere) guess_.shape.unit_column = column_text(unit_);
  }

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
  };

  Result<void> find_decimal() {
    Signs points;
    Signs commas;
    Signs open_points;  // 1.234 may be about a thousand, or about one
    Signs open_commas;
    std::size_t plain = 0;
    for (const KeptRow* row : data()) {
      for (const std::size_t column : values_) {
        const std::string_view cell = cell_of(*row, column);
        const DecimalSigns signs = possible_decimal_signs(cell);
        if (!signs.point && !signs.comma) continue;
        const bool has_comma = cell.find(',') != std::string_view::npos;
        if (!has_comma && cell.find('.') == std::string_view::npos) {
          ++plain;
        } else if (signs.point == signs.comma) {
          (has_comma ? open_commas : open_points).add(*row, cell);
        } else {
          (signs.point ? points : commas).add(*row, cell);
        }
      }
    }
    if (std::min(points.count, commas.count) * 100 > points.count + commas.count) {
      return failure(ErrorCode::malformed,
                     "its numbers change their decimal sign: " + row_words(*points.row) + " has " +
                         csv::in_quotes(points.cell) + ", " + row_words(*commas.row) + " has " +
                         csv::in_quotes(commas.cell));
    }
    if (points.count != commas.count) {
      const Signs& decisive = points.count > commas.count ? points : commas;
      guess_.shape.decimal = points.count > commas.count ? '.' : ',';
      guess_.decimal_because =
          "as in " + csv::in_quotes(decisive.cell) + ", " + row_words(*decisive.row);
    } else {
      guess_open_decimal(open_points, open_commas, plain);
    }
    return {};
  }

  /// Every cell has three digits after the sign. If it separated thousands, smaller values
  /// would have no sign.
  void guess_open_decimal(const Signs& points, const Signs& commas, std::size_t plain) {
    guess_.shape.decimal = '.';
    guess_.decimal_because = "no value shows it";
    if (points.count + commas.count == 0) return;
    const Signs& open = points.count > commas.count ? points : commas;
    const bool is_comma = &open == &commas;
    const bool is_decimal = 19 * plain <= open.count;
    guess_.shape.decimal = is_comma == is_decimal ? ',' : '.';
    guess_.decimal_because = "guessed from " + csv::in_quotes(open.cell) + ": " +
                             (is_decimal ? "all values have three digits after the sign"
                                         : "some values have no sign, so it sets thousands apart") +
                             "; another number of digits would decide";
  }

  /// Temperatures, voltages, costs: numbers, but not a meter's.
  [[nodiscard]] bool is_other_quantity(std::size_t column) const {
    constexpr std::array<std::string_view, 22> kWords{
        "temp",   "\xC2\xB0", "humid", "degc", "deg c",        "degf", "deg f",    "volt",
        "ampere", "amps",     "kvar",  "kva",  "power factor", "(hz)", "pressure", "setpoint",
        "%",      "dry_bulb", "co2",   "wind", "irradiance",   "price"};
    const std::string_view header = header_text(column);
    return split_unit(header).unit.empty() && contains_any(header, kWords);
  }

  Result<void> list_values() {
    for (std::size_t column = 0; column < width_; ++column) {
      if (column == time_ || column == clock_ || column == meter_ || column == unit_) continue;
      const std::string text = column_text(column);
      if (std::find(values_.begin(), values_.end(), column) != values_.end()) {
        if (is_other_quantity(column)) {
          guess_.ignored.push_back(printable(text) + " (no energy)");
        } else {
          add_value(column, text);
        }
      } else if (kinds_[column].filled > 0) {
        const bool is_mixed = kinds_[column].numbers > 0;
        guess_.ignored.push_back(printable(text) +
                                 (is_mixed ? " (numbers among text)" : " (text)"));
      } else if (!header_text(column).empty()) {
        guess_.ignored.push_back(printable(text) + " (empty)");
      }
    }
    if (!guess_.values.empty()) return {};
    std::string columns;
    for (const std::string& one : guess_.ignored) columns += (columns.empty() ? "" : ", ") + one;
    return failure(ErrorCode::malformed, "beside the times in " +
                                             csv::in_quotes(guess_.shape.time_column) +
                                             " no column has numbers" +
                                             (columns.empty() ? "" : "; there are " + columns));
  }

  void add_value(std::size_t column, const std::string& text) {
    const NameAndUnit parts = split_unit(header_text(column));
    GuessedColumn value{parts.name, text, parts.unit};
    if (units_ != nullptr) {
      const std::string_view cell = cell_of(*units_, column);
      const std::string inside = split_unit(cell).unit;
      if (!cell.empty()) value.unit = inside.empty() ? std::string{cell} : inside;
    }
    if (value.unit.empty() && unit_of_all_ != kNowhere && kinds_[unit_of_all_].texts.size() == 1) {
      value.unit = *kinds_[unit_of_all_].texts.begin();
    }
    guess_.values.push_back(std::move(value));
  }

  std::vector<const KeptRow*> rows_;  ///< Rows that are not blank.
  std::size_t width_ = 0;
  std::size_t time_ = kNowhere;
  std::size_t clock_ = kNowhere;
  std::size_t meter_ = kNowhere;
  std::size_t unit_ = kNowhere;         ///< Of a long table.
  std::size_t unit_of_all_ = kNowhere;  ///< Of any other table.
  std::size_t data_ = 0;                ///< First row with a time.
  bool is_counted_ = false;
  const KeptRow* header_ = nullptr;
  const KeptRow* units_ = nullptr;
  std::vector<ColumnKinds> kinds_;
  std::vector<std::size_t> values_;
  TableGuess guess_;
};

/// "{" before a key, or "[" before an object, a list, a text or a number.
bool begins_json(std::string_view text) {
  const bool is_list = text.starts_with('[');
  if (!is_list && !text.starts_with('{')) return false;
  text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) {
    text.remove_prefix(1);
  }
  constexpr std::string_view kInList = "{[\"-0123456789";
  return !text.empty() &&
         (is_list ? kInList.find(text.front()) != std::string_view::npos : text.front() == '"');
}

}  // namespace

Result<TableGuess> guess_table(std::span<const KeptRow> rows) { return TableSniffer{rows}.run(); }

Result<Container> guess_container(std::string_view first_bytes) {
  const auto begins = [&](std::string_view mark) {
    return first_bytes.substr(0, mark.size()) == mark;
  };
  if (first_bytes.empty()) return failure(ErrorCode::malformed, "it is empty");
  if (begins("PK\x03\x04")) return Container::xlsx;
  if (begins("\xD0\xCF\x11\xE0")) {
    return failure(ErrorCode::malformed,
                   "it is an .xls workbook of the old kind, or one with a password; save it as "
                   ".xlsx or CSV");
  }
  if (begins("\xFF\xFE") || begins("\xFE\xFF")) return Container::text;
  std::string_view text = first_bytes;
  if (begins("\xEF\xBB\xBF")) text.remove_prefix(3);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) {
    text.remove_prefix(1);
  }
  if (text.substr(0, 1) == "<") return Container::green_button;
  if (begins_json(text)) return Container::json;
  const auto odd = std::count_if(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x09 || (byte > 0x0D && byte < 0x20);
  });
  if (odd > 0) {
    return failure(
        ErrorCode::malformed,
        "it is no text; recald reads CSV, other delimited text, JSON, .xlsx and Green Button "
        "(XML)");
  }
  return Container::text;
}

char guess_separator(std::span<const std::string> lines) {
  // If several signs fit equally well, the one that is rarer in text wins:
  // "1,5;2,5" is two numbers.
  for (const char sign : {'\t', ';', '|', ','}) {
    std::map<std::ptrdiff_t, std::size_t> counts;
    std::size_t filled = 0;
    for (const std::string& line : lines) {
      if (csv::trimmed(line).empty()) continue;
      ++filled;
      const auto count = std::count(line.begin(), line.end(), sign);
      if (count > 0) ++counts[count];
    }
    for (const auto& [count, times] : counts) {
      if (static_cast<double>(times) >= 0.7 * static_cast<double>(filled)) return sign;
    }
  }
  return ',';
}

bool is_unit(std::string_view text) {
  if (text.empty() || text.size() > 20) return false;
  constexpr std::array kUtilities{metering::Utility::electricity, metering::Utility::gas,
                                  metering::Utility::steam};
  const metering::UnitFactors factors{.gas_kWh_per_m3 = 10.0};
  return std::any_of(kUtilities.begin(), kUtilities.end(), [&](metering::Utility utility) {
    return metering::find_unit(text, utility, factors).has_value();
  });
}

NameAndUnit split_unit(std::string_view header) {
  const std::string_view text = csv::trimmed(header);
  for (const auto& [open, close] : {std::pair{'(', ')'}, std::pair{'[', ']'}}) {
    const std::size_t end = text.rfind(close);
    const std::size_t begin = text.rfind(open);
    if (begin == std::string_view::npos || end == std::string_view::npos || end < begin) continue;
    const std::string_view unit = csv::trimmed(text.substr(begin + 1, end - begin - 1));
    if (!is_unit(unit)) continue;
    std::string name{csv::trimmed(text.substr(0, begin))};
    if (const std::string_view rest = csv::trimmed(text.substr(end + 1)); !rest.empty()) {
      name += (name.empty() ? "" : " ") + std::string{rest};
    }
    return {name, std::string{unit}};
  }
  if (is_unit(text)) return {"", std::string{text}};
  // Take the longest ending that is a unit: "ton-hours", not "hours". A single letter is more often
  // a wing or a storey than watts.
  constexpr std::string_view kSigns = " _,;:-";
  for (std::size_t cut = text.find_first_of(kSigns); cut != std::string_view::npos;
       cut = text.find_first_of(kSigns, cut + 1)) {
    const std::string_view unit = csv::trimmed(text.substr(cut + 1));
    if (cut == 0 || unit.size() < 2 || !is_unit(unit)) continue;
    std::string_view name = text.substr(0, cut);
    while (!name.empty() && kSigns.find(name.back()) != std::string_view::npos) {
      name.remove_suffix(1);
    }
    return {std::string{name}, std::string{unit}};
  }
  return {std::string{text}, ""};
}

}  // namespace recald::table
