#include "adapters/table/read_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string>

#include "adapters/csv/fields.hpp"
#include "adapters/csv/reading_intake.hpp"
#include "adapters/table/cell_number.hpp"
#include "adapters/table/delimited.hpp"
#include "core/absent.hpp"
#include "core/text/nearest.hpp"

namespace recald::table {
namespace {

using metering::Instant;
using std::chrono::seconds;

constexpr std::uint64_t kHeaderRowsMax = 200;  // the header must be within these
constexpr std::size_t kColumnsShown = 12;
constexpr std::size_t kOrderRows = 64;  // these show whether the file runs from old to new
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

/// "#3" is the third column: index 2.
std::optional<std::size_t> numbered(std::string_view column) {
  if (column.size() < 2 || column.front() != '#') return {};
  std::size_t number = 0;
  const auto [end, error] =
      std::from_chars(column.data() + 1, column.data() + column.size(), number);
  const bool is_whole = error == std::errc{} && end == column.data() + column.size();
  if (!is_whole || number == 0 || number > kCellsMax) return {};
  return number - 1;
}

/// Number of digits after the decimal sign, or nothing.
std::size_t decimals_of(std::string_view cell, char decimal) {
  const std::size_t sign = cell.find(decimal);
  return sign == std::string_view::npos ? 0 : cell.size() - sign - 1;
}

/// All rows of a file in one block of memory, for a file that must be read backwards.
class KeptRows {
 public:
  void add(const TableRow& row) {
    rows_.push_back({row.number, bytes_.size(), row.text.size(), ends_.size(), row.cells.size()});
    bytes_ += row.text;
    for (const std::string_view cell : row.cells) {
      bytes_ += cell;
      ends_.push_back(bytes_.size());
    }
  }

  [[nodiscard]] std::size_t size() const { return rows_.size(); }

  /// @return valid until the next call.
  [[nodiscard]] const TableRow& row(std::size_t index) {
    const Place& place = rows_[index];
    const std::string_view bytes = bytes_;
    shown_.number = place.number;
    shown_.text = bytes.substr(place.begin, place.text_length);
    shown_.cells.clear();
    std::size_t begin = place.begin + place.text_length;
    for (std::size_t i = 0; i < place.cells; ++i) {
      const std::size_t end = ends_[place.first_cell + i];
      shown_.cells.push_back(bytes.substr(begin, end - begin));
      begin = end;
    }
    return shown_;
  }

 private:
  struct Place {
    std::uint64_t number;
    std::size_t begin;
    std::size_t text_length;
    std::size_t first_cell;
    std::size_t cells;
  };
  std::vector<Place> rows_;
  std::vector<std::size_t> ends_;  ///< Where each cell ends.
  std::string bytes_;
  TableRow shown_;
};

enum class Order : std::uint8_t { unknown, old_to_new, new_to_old };

class TableReader {
 public:
  TableReader(RowSource& rows, std::string_view name, const TableShape& shape,
              std::span<const TableMeter> meters, const metering::LocalCalendar& calendar,
              csv::ReadingIntake& intake)
      : rows_{rows},
        name_{name},
        shape_{shape},
        meters_{meters},
        calendar_{calendar},
        intake_{intake} {}

  Result<void> run() {
    if (auto found = find_header(); !found) return found;
    TableRow row;
    while (rows_.next(row)) read_row(row);
    if (rows_.error()) return failed_source();
    if (order_ == Order::unknown) find_order();
    hand_on_kept();
    // A column may be in a block further down, but in one it must be.
    for (std::size_t i = 0; i < meters_.size(); ++i) {
      if (!is_placed_[i]) return no_column(header_, meters_[i].column);
    }
    return {};
  }

  [[nodiscard]] const ClockFacts& facts() const { return facts_; }

 private:
  /// Moves to the row below the header.
  Result<void> find_header() {
    if (numbered(shape_.time_column)) return resolve({});
    TableRow row;
    std::vector<std::string> widest;
    for (std::uint64_t i = 0; i < kHeaderRowsMax && rows_.next(row); ++i) {
      std::vector<std::string> header;
      for (const std::string_view cell : row.cells) header.push_back(utf8_of(cell));
      if (find_column(header, shape_.time_column)) {
        is_below_header_ = true;
        return resolve(std::move(header));
      }
      if (header.size() > widest.size()) widest = std::move(header);
    }
    if (rows_.error()) return failed_source();
    if (widest.empty()) return failure(ErrorCode::malformed, in_quotes(name_) + " is empty");
    return no_column(widest, shape_.time_column);
  }

  [[nodiscard]] tl::unexpected<Error> failed_source() const {
    const Error& error = *rows_.error();
    if (error.message.find(name_) != std::string::npos) return tl::unexpected(error);
    return failure(error.code, in_quotes(name_) + ": " + error.message);
  }

  [[nodiscard]] static std::string in_quotes(std::string_view text) { return csv::in_quotes(text); }

  [[nodiscard]] tl::unexpected<Error> no_column(const std::vector<std::string>& header,
                                                std::string_view column) const {
    std::string words = in_quotes(name_) + " has no column " + in_quotes(column);
    const std::vector<std::string_view> names{header.begin(), header.end()};
    if (const std::string_view nearest = nearest_name(column, names); !nearest.empty()) {
      words += "; did you mean " + in_quotes(nearest) + "?";
    } else {
      words += "; it has ";
      for (std::size_t i = 0; i < std::min(kColumnsShown, names.size()); ++i) {
        words += (i > 0 ? ", " : "") + in_quotes(names[i].substr(0, 60));
      }
      if (names.size() > kColumnsShown) words += " and more";
    }
    return failure(ErrorCode::malformed, words);
  }

  Result<void> resolve(std::vector<std::string> header) {
    is_placed_.assign(meters_.size(), false);
    TRY(place_columns(std::move(header)));
    next_of_name_.assign(meters_.size(), kNone);
    is_first_of_name_.assign(meters_.size(), true);
    for (std::size_t i = meters_.size(); i-- > 0;) {
      const auto [known, is_new] = by_name_.try_emplace(meters_[i].rows.name, i);
      if (is_new) continue;
      next_of_name_[i] = std::exchange(known->second, i);
      is_first_of_name_[next_of_name_[i]] = false;
    }
    for (std::size_t i = 0; i < meters_.size(); ++i) {
      if (meters_[i].unit.empty()) continue;
      if (auto known = intake_.set_unit(intake_.meter(i), meters_[i].unit); !known) return known;
    }
    const std::size_t clocks = meter_ == kNone ? 1 : std::max<std::size_t>(1, meters_.size());
    clocks_.assign(clocks, ClockReader{calendar_});
    return {};
  }

  /// Finds the columns in the header above the rows that follow. Those of some meters may stand in
  /// another block.
  Result<void> place_columns(std::vector<std::string> header) {
    header_ = std::move(header);
    const auto place = [&](std::string_view column, std::size_t& into) -> Result<void> {
      into = kNone;
      if (column.empty()) return {};
      const auto found = find_column(header_, column);
      if (!found) return no_column(header_, column);
      into = *found;
      return {};
    };
    value_.assign(meters_.size(), kNone);
    for (std::size_t i = 0; i < meters_.size(); ++i) {
      const bool is_here = place(meters_[i].column, value_[i]).has_value();
      is_placed_[i] = is_placed_[i] || is_here;
    }
    for (const auto& [column, into] :
         {std::pair{&shape_.time_column, &time_}, std::pair{&shape_.clock_column, &clock_},
          std::pair{&shape_.meter_column, &meter_}, std::pair{&shape_.unit_column, &unit_}}) {
      if (auto found = place(*column, *into); !found) return found;
    }
    return {};
  }

  void read_row(const TableRow& row) {
    if (!row.problem.empty()) {
      intake_.count_line();
      return intake_.refuse(row.number, row.problem, row.text);
    }
    if (std::all_of(row.cells.begin(), row.cells.end(),
                    [](std::string_view cell) { return cell.empty(); })) {
      return;
    }
    const bool is_next_to_header = std::exchange(is_below_header_, false);
    if (is_header_again(row)) return take_header_again(row);
    if (is_next_to_header && is_row_of_units(row)) return;
    intake_.count_line();
    if (!row.is_terminated && !is_surely_whole(row)) {
      return intake_.refuse(
          row.number, "the last line has no line end and may be cut; it is kept out", row.text);
    }
    last_cells_ = row.cells.size();
    last_decimals_ = row.cells.empty() ? 0 : decimals_of(row.cells.back(), shape_.decimal);
    if (order_ == Order::old_to_new) return take_row(row);
    kept_.add(row);
    if (order_ == Order::new_to_old || kept_.size() < kOrderRows) return;
    find_order();
    if (order_ == Order::old_to_new) hand_on_kept();
  }

  /// Portals often list the newest row first; such a file is kept in memory and read from its end.
  void find_order() {
    std::size_t rises = 0;
    std::size_t falls = 0;
    std::optional<Instant> last;
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      const auto clock = clock_of(kept_.row(i));
      if (!clock) continue;
      if (last && *clock > *last) ++rises;
      if (last && *clock < *last) ++falls;
      last = clock;
    }
    order_ = falls > rises ? Order::new_to_old : Order::old_to_new;
  }

  void hand_on_kept() {
    const std::size_t count = kept_.size();
    for (std::size_t i = 0; i < count; ++i) {
      take_row(kept_.row(order_ == Order::new_to_old ? count - 1 - i : i));
    }
    kept_ = {};
  }

  void take_row(const TableRow& row) {
    if (meter_ == kNone) return read_wide(row);
    read_long(row);
  }

  /// The row's time as its clock shows it, whatever its zone.
  [[nodiscard]] std::optional<Instant> clock_of(const TableRow& row) const {
    const auto written = parse_stamp(cell(row, time_), shape_.time_format);
    if (!written) return {};
    if (clock_ == kNone) return written->clock;
    const auto time = parse_time_of_day(cell(row, clock_));
    return time ? std::optional{written->clock + *time} : std::nullopt;
  }

  [[nodiscard]] static std::string_view cell(const TableRow& row, std::size_t column) {
    return column < row.cells.size() ? row.cells[column] : std::string_view{};
  }

  [[nodiscard]] bool is_header_again(const TableRow& row) const {
    return time_ < header_.size() && cell(row, time_) == header_[time_];
  }

  /// The header of another block, which may have other columns, or of one with none of ours.
  void take_header_again(const TableRow& row) {
    std::vector<std::string> header;
    for (const std::string_view one : row.cells) header.push_back(utf8_of(one));
    if (header == header_) return;
    if (order_ != Order::old_to_new) {
      find_order();
      hand_on_kept();
      order_ = Order::unknown;
    }
    is_below_header_ = true;
    if (!place_columns(std::move(header))) value_.assign(meters_.size(), kNone);
  }

  /// Whether the row below the names has no time, and no number in any meter's column.
  [[nodiscard]] bool is_row_of_units(const TableRow& row) const {
    if (parse_stamp(cell(row, time_), shape_.time_format)) return false;
    return std::none_of(value_.begin(), value_.end(), [&](std::size_t column) {
      return parse_cell(cell(row, column), shape_.decimal).has_value();
    });
  }

  [[nodiscard]] bool is_surely_whole(const TableRow& row) const {
    if (row.cells.empty() || row.cells.size() != last_cells_) return false;
    const std::size_t decimals = decimals_of(row.cells.back(), shape_.decimal);
    return decimals > 0 && decimals == last_decimals_;
  }

  /// @param clock  Index of the clock.
  std::optional<Instant> instant_of(const TableRow& row, std::size_t clock,
                                    csv::IntakeMeter* meter) {
    const auto refuse = [&](std::string_view reason) {
      intake_.refuse(row.number, reason, row.text, meter);
      return std::nullopt;
    };
    const std::string_view text = cell(row, time_);
    auto written = parse_stamp(text, shape_.time_format);
    if (!written) return refuse(written.error().message);
    if (clock_ != kNone) {
      const auto time = parse_time_of_day(cell(row, clock_));
      if (!time) return refuse("time " + in_quotes(cell(row, clock_)) + " is not hh:mm");
      written->clock += *time;
    }
    if (written->utc_offset) return written->clock - *written->utc_offset;
    ++facts_.naive;
    const auto instant = clocks_[clock].instant_of(written->clock);
    if (instant) return instant;
    ++facts_.skipped;
    return refuse("timestamp " + in_quotes(text) + " does not exist in " + calendar_.zone_name() +
                  ", whose clock jumps over it; if the meter's clock is never changed, give its "
                  "own zone as 'timezone', such as \"Etc/GMT-1\"");
  }

  void read_wide(const TableRow& row) {
    const auto instant = instant_of(row, 0, nullptr);
    if (!instant) return;
    for (std::size_t i = 0; i < meters_.size(); ++i) {
      if (value_[i] != kNone) take(row, i, *instant);
    }
  }

  void read_long(const TableRow& row) {
    const std::string_view name = cell(row, meter_);
    const auto index = meter_named(name);
    if (!index) return intake_.count_other(utf8_of(name));
    csv::IntakeMeter& first = intake_.meter(*index);
    const auto instant = instant_of(row, *index, &first);
    if (!instant) return;
    // A row may have a column for each of several meters of its name.
    for (std::size_t i = *index; i != kNone; i = next_of_name_[i]) {
      if (value_[i] == kNone) continue;
      csv::IntakeMeter& meter = intake_.meter(i);
      if (unit_ != kNone && (meter.unit.empty() || meter.unit != cell(row, unit_))) {
        if (const auto known = intake_.set_unit(meter, cell(row, unit_)); !known) {
          intake_.refuse(row.number, known.error().message, row.text, &meter);
          continue;
        }
      }
      take(row, i, *instant);
    }
  }

  [[nodiscard]] std::optional<std::size_t> meter_named(std::string_view name) {
    for (const std::size_t guess : {last_meter_ + 1, last_meter_, std::size_t{0}}) {
      if (guess >= meters_.size() || !is_first_of_name_[guess]) continue;
      if (meters_[guess].rows.name != name) continue;
      last_meter_ = guess;
      return guess;
    }
    const auto found = by_name_.find(utf8_of(name));
    if (found == by_name_.end()) return {};
    last_meter_ = found->second;
    return found->second;
  }

  void take(const TableRow& row, std::size_t index, Instant instant) {
    csv::IntakeMeter& meter = intake_.meter(index);
    const std::string_view text = cell(row, value_[index]);
    csv::Row reading{.line = row.number,
                     .stamp = instant,
                     .value = kAbsent,
                     .conversion = meter.conversion,
                     .text = row.text};
    if (!is_blank(text)) {
      const auto value = parse_cell(text, shape_.decimal);
      const bool is_usable = value && std::abs(*value) <= csv::kValueMax;
      if (!is_usable) {
        return intake_.refuse(
            row.number,
            "meter " + in_quotes(meter.rows.name) + ": " + cell_problem(text, shape_.decimal),
            row.text, &meter);
      }
      reading.value = *value;
    }
    intake_.take(meter, reading);
  }

  RowSource& rows_;
  std::string name_;
  const TableShape& shape_;
  std::span<const TableMeter> meters_;
  const metering::LocalCalendar& calendar_;
  csv::ReadingIntake& intake_;
  std::vector<std::string> header_;
  std::vector<std::size_t> value_;  ///< One per meter.
  std::size_t time_ = kNone;
  std::size_t clock_ = kNone;
  std::size_t meter_ = kNone;
  std::size_t unit_ = kNone;
  std::vector<bool> is_placed_;  ///< Whether a block had the meter's column so far.
  std::map<std::string, std::size_t, std::less<>> by_name_;  ///< The first meter of each name.
  std::vector<std::size_t> next_of_name_;  ///< The next meter of the same name, or none.
  std::vector<bool> is_first_of_name_;
  std::size_t last_meter_ = 0;
  std::vector<ClockReader> clocks_;  ///< One for the table, or one per meter of a long table.
  bool is_below_header_ = false;
  std::size_t last_cells_ = 0;
  std::size_t last_decimals_ = 0;
  Order order_ = Order::unknown;
  KeptRows kept_;
  ClockFacts facts_;
};

}  // namespace

std::optional<std::size_t> find_column(std::span<const std::string> header,
                                       std::string_view column) {
  const auto named = std::find(header.begin(), header.end(), column);
  if (named != header.end() && !column.empty()) {
    return static_cast<std::size_t>(named - header.begin());
  }
  return numbered(column);
}

char likely_separator(std::string_view line) {
  char likely = ',';
  std::ptrdiff_t most = 0;
  for (const char sign : {'\t', ';', ',', '|'}) {
    const auto count = std::count(line.begin(), line.end(), sign);
    if (count <= most) continue;
    most = count;
    likely = sign;
  }
  return likely;
}

Result<csv::ReadingsReport> read_table(RowSource& rows, std::string_view name,
                                       const TableShape& shape, std::span<const TableMeter> meters,
                                       const metering::LocalCalendar& calendar,
                                       const csv::ReadingsSink& sink, ClockFacts* facts) {
  csv::ReadingIntake intake{intake_options(meters), sink};
  return read_table(rows, name, shape, meters, calendar, intake, facts).map([&] {
    return intake.finish();
  });
}

csv::ReadingsOptions intake_options(std::span<const TableMeter> meters) {
  csv::ReadingsOptions options;
  for (const TableMeter& meter : meters) options.meters.push_back(meter.rows);
  return options;
}

Result<void> read_table(RowSource& rows, std::string_view name, const TableShape& shape,
                        std::span<const TableMeter> meters, const metering::LocalCalendar& calendar,
                        csv::ReadingIntake& intake, ClockFacts* facts) {
  const metering::LocalCalendar* clock = &calendar;
  std::optional<metering::LocalCalendar> own;
  if (!shape.timezone.empty()) {
    own = TRY(metering::LocalCalendar::open(shape.timezone));
    clock = &*own;
  }
  TableReader reader{rows, name, shape, meters, *clock, intake};
  auto read = reader.run();
  if (facts != nullptr) *facts = reader.facts();
  return read;
}

}  // namespace recald::table
