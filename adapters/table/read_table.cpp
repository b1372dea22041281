#include "adapters/table/read_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string>

#include "adapters/csv/fields.hpp"
#include "adapters/csv/reading_intake.hpp"
#include "adapters/table/cells/cell_number.hpp"
#include "adapters/table/cells/column_kinds.hpp"
#include "adapters/table/clock_labels.hpp"
#include "adapters/table/delimited.hpp"
#include "adapters/table/header_rows.hpp"
#include "core/absent.hpp"
#include "core/text/nearest.hpp"
#include "core/text/utf8.hpp"

namespace recald::table {
namespace {

using metering::Instant;
using std::chrono::seconds;

constexpr std::uint64_t kHeaderRowsMax = 200;  // the header must be within these
constexpr std::size_t kColumnsShown = 12;
constexpr std::size_t kOrderRows = 64;        // these show whether the file runs from old to new
constexpr std::size_t kWaitingMax = 100'000;  // rows, for one that decides what a time means
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
    if (is_above_data_ && above_ > 0) {
      intake_.refuse(last_above_, "no row has a time in column " + in_quotes(shape_.time_column),
                     "");
    }
    if (order_ == Order::unknown) find_order();
    hand_on_kept();
    take_waiting(true);
    // A column may be in a block further down, but in one it must be.
    for (std::size_t i = 0; i < meters_.size(); ++i) {
      if (!is_placed_[i]) return no_column(header_, meters_[i].column);
    }
    return {};
  }

  [[nodiscard]] const ClockFacts& facts() const { return facts_; }

 private:
  using Names = std::vector<std::string_view>;

  /// The columns that are found by their names: those that every row needs …
  [[nodiscard]] Names needed_columns() const {
    Names names{shape_.time_column, shape_.clock_column, shape_.meter_column, shape_.unit_column,
                shape_.flag_column};
    std::erase_if(names, [](std::string_view name) { return name.empty() || numbered(name); });
    return names;
  }

  /// … and those of values, of which some may stand in another block further down.
  [[nodiscard]] Names value_columns() const {
    Names names;
    for (const TableMeter& meter : meters_) names.push_back(meter.column);
    std::erase_if(names, [](std::string_view name) { return name.empty() || numbered(name); });
    return names;
  }

  /// Moves to the row below the header: the first that has the names. If columns are only numbered,
  /// the rows above the first time are the header.
  Result<void> find_header() {
    is_above_data_ = true;
    const Names needed = needed_columns();
    const Names values = value_columns();
    Names names = needed;
    names.insert(names.end(), values.begin(), values.end());
    if (names.empty()) return resolve({});
    TableRow row;
    std::vector<std::string> nearest;
    std::string_view missing_there = names.front();
    std::ptrdiff_t most = 0;
    for (std::uint64_t i = 0; i < kHeaderRowsMax && rows_.next(row); ++i) {
      std::vector<std::string> header;
      for (const std::string_view cell : row.cells) header.push_back(utf8_of(cell));
      const auto has = [&](std::string_view name) { return find_column(header, name).has_value(); };
      const bool has_values = values.empty() || std::ranges::any_of(values, has);
      if (has_values && std::ranges::all_of(needed, has)) {
        marked_by_ = names.front();
        return resolve(std::move(header));
      }
      const auto found = std::ranges::count_if(names, has);
      if (found < most || (found == most && header.size() <= nearest.size())) continue;
      most = found;
      missing_there = *std::ranges::find_if_not(names, has);
      nearest = std::move(header);
    }
    if (rows_.error()) return failed_source();
    if (nearest.empty()) return failure(ErrorCode::malformed, in_quotes(name_) + " is empty");
    return no_column(nearest, missing_there);
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
    skipped_until_.assign(clocks, Instant::min());
    return {};
  }

  /// Finds the columns in the header above the rows that follow. Those of some meters may stand in
  /// another block.
  Result<void> place_columns(std::vector<std::string> header) {
    header_ = std::move(header);
    mark_ = find_column(header_, marked_by_).value_or(kNone);
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
          std::pair{&shape_.meter_column, &meter_}, std::pair{&shape_.unit_column, &unit_},
          std::pair{&shape_.flag_column, &flag_}}) {
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
    if (is_header_again(row)) return take_header_again(row);
    if (is_above_data_) {
      // Between header and data stand units or more names; with numbered columns all names do.
      if (above_ < kHeaderRowsMax && is_more_header(row)) {
        ++above_;
        last_above_ = row.number;
        return;
      }
      is_above_data_ = false;
    }
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
    if (waiting_.size() == 0 && (is_quiet() || !end_in_doubt(row))) return take_now(row);
    waiting_.add(row);
    take_waiting(false);
  }

  void take_now(const TableRow& row) {
    if (meter_ == kNone) return read_wide(row);
    read_long(row);
  }

  /// Whether no clock is changed within a day of the last row's time.
  [[nodiscard]] bool is_quiet() {
    constexpr std::chrono::days kNear{1};
    constexpr std::chrono::days kFar{3};
    if (shape_.clock_format != ClockFormat::time || quiet_.contains(last_)) return true;
    if (last_ == Instant{}) return false;
    if (calendar_.utc_offset(last_ - kFar) != calendar_.utc_offset(last_ + kFar)) return false;
    quiet_ = {last_ - kFar + kNear, last_ + kFar - kNear};
    return true;
  }

  struct EndInDoubt {
    std::size_t clock;
    ClockReader::EndAtChange end;
  };

  /// What a row's time may mean, if what its clock shows next must tell.
  [[nodiscard]] std::optional<EndInDoubt> end_in_doubt(const TableRow& row) {
    const auto clock = clock_index(row);
    const auto shown = clock ? clock_of(row, true) : std::nullopt;
    if (!shown) return {};
    const auto end = clocks_[*clock].end_at_change(*shown);
    return end ? std::optional{EndInDoubt{*clock, *end}} : std::nullopt;
  }

  [[nodiscard]] std::optional<std::size_t> clock_index(const TableRow& row) {
    return meter_ == kNone ? std::optional<std::size_t>{0} : meter_named(cell(row, meter_));
  }

  /// Takes the rows that wait, as far as those behind them decide what their times mean.
  void take_waiting(bool is_whole) {
    for (; waiting_at_ < waiting_.size(); ++waiting_at_) {
      const auto doubt = end_in_doubt(waiting_.row(waiting_at_));
      if (doubt) {
        const auto next = shown_next(*doubt, has_value(waiting_.row(waiting_at_)));
        const bool is_too_long = waiting_.size() - waiting_at_ > kWaitingMax;
        if (!next && !is_whole && !is_too_long) return;
        if (next && doubt->end.is_followed_by(*next)) end_ = doubt;
      }
      take_now(waiting_.row(waiting_at_));
      end_.reset();
      looked_at_ = waiting_at_ + 2;
    }
    waiting_ = {};
    waiting_at_ = 0;
    looked_at_ = 1;
  }

  /// What a clock shows behind the first row that waits. Some write the hour that the clock skips,
  /// without values: those rows say nothing.
  [[nodiscard]] std::optional<Instant> shown_next(const EndInDoubt& doubt, bool is_filled) {
    for (; looked_at_ < waiting_.size(); ++looked_at_) {
      const TableRow& row = waiting_.row(looked_at_);
      if (clock_index(row) != doubt.clock) continue;
      const auto shown = clock_of(row, true);
      if (!shown) continue;
      const bool is_skipped =
          doubt.end.jump.count() > 0 && *shown <= doubt.end.clock + doubt.end.jump;
      if (!is_skipped || !is_filled || has_value(row)) return shown;
    }
    return {};
  }

  /// The row's time as its clock shows it, whatever its zone.
  /// @param is_naive  Nothing of one that says its offset.
  [[nodiscard]] std::optional<Instant> clock_of(const TableRow& row, bool is_naive = false) const {
    auto written = parse_stamp(cell(row, time_), shape_.time_format);
    if (!written || (clock_ != kNone && !add_clock(row, *written).empty())) return {};
    if (is_naive && written->utc_offset) return {};
    return written->clock;
  }

  /// Adds the time of the clock column to a date, as if no day were longer than others.
  /// @return why it cannot be added, or nothing
  [[nodiscard]] std::string add_clock(const TableRow& row, WrittenTime& written) const {
    const std::string_view text = cell(row, clock_);
    if (shape_.clock_format == ClockFormat::time) {
      const auto clock = parse_clock(text);
      if (!clock) return "time " + in_quotes(text) + " is not hh:mm";
      written.clock += clock->time;
      if (clock->utc_offset) written.utc_offset = clock->utc_offset;
      written.is_zone_named = written.is_zone_named || clock->is_zone_named;
      return "";
    }
    const seconds length = interval_of_clock();
    const auto number = label_of(text, length);
    if (!number || *number < 1) {
      return in_quotes(text) + " in column " + in_quotes(shape_.clock_column) +
             " is no number of an hour or interval from 1 on";
    }
    written.clock += (*number - 1) * length;
    return "";
  }

  [[nodiscard]] seconds interval_of_clock() const {
    return shape_.interval.count() > 0 ? shape_.interval : seconds{3600};
  }

  /// The instant of the n-th interval of a day, which may have 23 or 25 hours.
  /// @param as_if_usual  As if each had 24.
  [[nodiscard]] std::optional<Instant> counted_instant(Instant as_if_usual) {
    const seconds length = interval_of_clock();
    // The last numbers of a day of 25 hours look like the first of the next day.
    const Instant date = counted_date_;
    if (date != date_span_date_) {
      date_span_ = calendar_.day_span(metering::Day{std::chrono::floor<std::chrono::days>(date)});
      date_span_date_ = date;
    }
    const Instant at = date_span_.begin + (as_if_usual - date);
    return at + length <= date_span_.end ? std::optional{at} : std::nullopt;
  }

  [[nodiscard]] static std::string_view cell(const TableRow& row, std::size_t column) {
    return column < row.cells.size() ? row.cells[column] : std::string_view{};
  }

  [[nodiscard]] bool is_header_again(const TableRow& row) const {
    return mark_ < header_.size() && cell(row, mark_) == header_[mark_];
  }

  /// The header of another block, which may have other columns, or of one with none of ours.
  void take_header_again(const TableRow& row) {
    std::vector<std::string> header;
    for (const std::string_view one : row.cells) header.push_back(utf8_of(one));
    if (header == header_) return;
    ++facts_.further_headers;
    take_waiting(true);
    if (order_ != Order::old_to_new) {
      find_order();
      hand_on_kept();
      order_ = Order::unknown;
    }
    is_above_data_ = true;
    above_ = 0;
    if (!place_columns(std::move(header))) value_.assign(meters_.size(), kNone);
  }

  /// Whether a row has no time, and no number in any meter's column. Without a header, what stands
  /// above the first time is one, whatever it has.
  [[nodiscard]] bool is_more_header(const TableRow& row) const {
    if (is_stamp(cell(row, time_), shape_.time_format)) return false;
    return header_.empty() || std::none_of(value_.begin(), value_.end(), [&](std::size_t column) {
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
    counted_date_ = written->clock;
    if (clock_ != kNone) {
      if (const std::string why = add_clock(row, *written); !why.empty()) return refuse(why);
    }
    if (written->utc_offset) {
      const Instant instant = written->clock - *written->utc_offset;
      last_ = instant;
      if (!written->is_zone_named || fits_zone(instant, *written->utc_offset)) return instant;
      return refuse("timestamp " + in_quotes(text) + ": the letters of its zone stand for " +
                    offset_text(*written->utc_offset) + ", far from " + calendar_.zone_name() +
                    "; give 'timezone' if they mean another, and take them out of the file");
    }
    ++facts_.naive;
    if (clock_ != kNone && shape_.clock_format == ClockFormat::interval_number) {
      const auto counted = counted_instant(written->clock);
      if (counted) return counted;
      return refuse("number " + in_quotes(cell(row, clock_)) + " is more than the intervals of " +
                    in_quotes(text) + " in " + calendar_.zone_name());
    }
    if (end_ && end_->clock == clock) {
      clocks_[clock].pass(end_->end);
      skipped_until_[clock] = end_->end.clock + end_->end.jump;
      return end_->end.instant;
    }
    const bool is_in_skipped = written->clock <= skipped_until_[clock] &&
                               clocks_[clock].ends_in_skipped_hour(written->clock);
    if (is_in_skipped && !has_value(row)) return std::nullopt;
    const auto instant = clocks_[clock].instant_of(written->clock);
    if (clocks_[clock].came_again()) note_clock_put_back(written->clock);
    if (clocks_[clock].hour() != ClockReader::Hour::usual || !is_quiet()) {
      count_change(row, clocks_[clock], written->clock);
    }
    last_ = instant.value_or(last_);
    if (instant) return instant;
    ++facts_.skipped;
    return refuse("timestamp " + in_quotes(text) + " does not exist in " + calendar_.zone_name() +
                  ", whose clock jumps over it; if the meter's clock is never changed, give its "
                  "own zone as 'timezone', such as \"Etc/GMT-1\"");
  }

  void note_clock_put_back(Instant shown) {
    const metering::Day day{std::chrono::floor<std::chrono::days>(shown)};
    if (facts_.put_back.size() < ClockFacts::kPutBackMax || facts_.put_back.contains(day)) {
      facts_.put_back.try_emplace(day, shown);
    }
    ++facts_.repeated;
  }

  /// Whether any meter's cell in it satisfies a condition of its number.
  template <class Condition>
  [[nodiscard]] bool has_number(const TableRow& row, Condition condition) const {
    return std::ranges::any_of(value_, [&](std::size_t column) {
      const std::string_view text = cell(row, column);
      auto number = parse_cell(text, shape_.decimal);
      if (!number) number = parse_cell(split_number(text).number, shape_.decimal);
      return number && condition(*number);
    });
  }
  [[nodiscard]] bool has_value(const TableRow& row) const {
    return has_number(row, [](double number) { return number != 0.0; });
  }

  void count_change(const TableRow& row, const ClockReader& reader, Instant clock) {
    const ClockReader::Hour hour = reader.hour();
    const bool is_end = reader.ends_in_skipped_hour(clock);
    if (hour == ClockReader::Hour::usual && !is_end) return;
    const bool is_there = has_number(row, [](double) { return true; });
    if ((hour == ClockReader::Hour::skipped || is_end) && !is_there) return;
    ClockChange& change =
        facts_.changes[metering::Day{std::chrono::floor<std::chrono::days>(clock)}];
    const auto add = [&](ClockChange::Counts& counts) {
      if (hour == ClockReader::Hour::skipped) ++counts.skipped;
      if (is_end) ++counts.skipped_ends;
      if (hour == ClockReader::Hour::first) ++counts.first;
      if (hour == ClockReader::Hour::second) ++counts.second;
    };
    add(change.rows);
    if (has_value(row)) add(change.values);
  }

  /// The same letters stand for zones on several continents.
  [[nodiscard]] bool fits_zone(Instant instant, seconds offset) const {
    constexpr seconds kFar{4 * 3600};
    if (calendar_.zone_name() == "Etc/UTC") return true;  // nobody told the building's
    const seconds apart = calendar_.utc_offset(instant) - offset;
    return apart <= kFar && apart >= -kFar;
  }

  [[nodiscard]] static std::string offset_text(seconds offset) {
    const auto whole_minutes = std::abs(offset.count()) / 60;
    const auto two = [](std::int64_t n) { return (n < 10 ? "0" : "") + std::to_string(n); };
    return std::string{"UTC"} + (offset.count() < 0 ? "-" : "+") + two(whole_minutes / 60) + ":" +
           two(whole_minutes % 60);
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
        if (const auto known = intake_.set_unit(meter, utf8_of(cell(row, unit_))); !known) {
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
    if (flag_ != kNone && is_blank(text)) count_flag(cell(row, flag_), "");
    if (is_blank(text)) {
      if (!text.empty()) facts_.add_word(text);
    } else if (flag_ == kNone || take_flag(row, text, reading)) {
      auto value = parse_cell(text, shape_.decimal);
      if (!value) value = with_unit(text, meter, reading);
      if (!value || std::abs(*value) > csv::kValueMax) {
        return intake_.refuse(
            row.number,
            "meter " + in_quotes(meter.rows.name) + ": " + cell_problem(text, shape_.decimal),
            row.text, &meter);
      }
      reading.value = *value;
    }
    intake_.take(meter, reading);
  }

  /// The number of "12.3 kWh", whose unit then is the reading's.
  std::optional<double> with_unit(std::string_view text, const csv::IntakeMeter& meter,
                                  csv::Row& reading) {
    const NumberAndUnit parts = split_number(text);
    if (parts.unit.empty() || parts.number.empty()) return {};
    const auto value = parse_cell(parts.number, shape_.decimal);
    if (!value) return {};
    if (parts.unit != cell_unit_ || cell_utility_ != meter.rows.utility) {
      const auto known = metering::find_unit(parts.unit, meter.rows.utility, meter.rows.units);
      if (!known) return {};
      cell_unit_ = parts.unit;
      cell_utility_ = meter.rows.utility;
      cell_conversion_ = *known;
    }
    reading.conversion = cell_conversion_;
    return value;
  }

  /// @return whether the value counts
  bool take_flag(const TableRow& row, std::string_view text, csv::Row& reading) {
    const std::string_view flag = cell(row, flag_);
    count_flag(flag, text);
    if (std::ranges::find(shape_.missing_flags, flag) != shape_.missing_flags.end()) return false;
    if (std::ranges::find(shape_.estimated_flags, flag) == shape_.estimated_flags.end())
      return true;
    // Its sum may be right, its shape is the estimate's.
    reading.validity = metering::Validity::scaled;
    reading.reasons = metering::Reason::estimated;
    return true;
  }

  void count_flag(std::string_view flag, std::string_view text) {
    auto known = std::ranges::find(facts_.flags, flag, &FlagCount::flag);
    if (known == facts_.flags.end()) {
      if (facts_.flags.size() == kFlagsMax) return;
      facts_.flags.push_back({.flag = std::string{flag}});
      known = facts_.flags.end() - 1;
    }
    ++known->rows;
    if (text.find_first_not_of("0.,") == std::string_view::npos) ++known->empty;
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
  std::size_t flag_ = kNone;
  std::vector<bool> is_placed_;  ///< Whether a block had the meter's column so far.
  std::map<std::string, std::size_t, std::less<>> by_name_;  ///< The first meter of each name.
  std::vector<std::size_t> next_of_name_;  ///< The next meter of the same name, or none.
  std::vector<bool> is_first_of_name_;
  std::size_t last_meter_ = 0;
  std::vector<ClockReader> clocks_;     ///< One for the table, or one per meter of a long table.
  std::vector<Instant> skipped_until_;  ///< Where an hour that it skips is written.
  bool is_above_data_ = false;
  std::uint64_t above_ = 0;  ///< Rows between header and data so far.
  std::uint64_t last_above_ = 0;
  std::string marked_by_;
  std::size_t mark_ = kNone;  ///< The column whose name shows that the header comes again.
  Instant counted_date_{};
  Instant date_span_date_ = Instant::min();
  metering::TimeSpan date_span_{};
  std::string cell_unit_;  ///< The unit that a cell had last, and its meaning.
  metering::Utility cell_utility_ = metering::Utility::electricity;
  metering::UnitConversion cell_conversion_{};
  std::size_t last_cells_ = 0;
  std::size_t last_decimals_ = 0;
  Order order_ = Order::unknown;
  KeptRows kept_;
  Instant last_{};              ///< Of the last row.
  metering::TimeSpan quiet_{};  ///< Where no clock is changed.
  KeptRows waiting_;            ///< From one whose time is in doubt on.
  std::size_t waiting_at_ = 0;
  std::size_t looked_at_ = 1;      ///< The first that waits and was not looked at for its time.
  std::optional<EndInDoubt> end_;  ///< That of the row being taken, once it is no doubt.
  ClockFacts facts_;
};

}  // namespace

std::optional<std::size_t> find_column(std::span<const std::string> header,
                                       std::string_view column) {
  if (column.empty()) return {};
  auto named = std::find(header.begin(), header.end(), column);
  if (named == header.end() && !numbered(column)) {
    // Line breaks and blanks of other widths are no part of a name.
    named = std::find_if(
        header.begin(), header.end(),
        [wanted = squeezed(column)](const auto& text) { return squeezed(text) == wanted; });
  }
  if (named != header.end()) return static_cast<std::size_t>(named - header.begin());
  return numbered(column);
}

std::optional<std::size_t> find_time_in_header(std::span<const std::string> header,
                                               const TableShape& shape) {
  const auto time = find_column(header, shape.time_column);
  if (!time || numbered(shape.time_column)) return time;
  if (!shape.clock_column.empty() && !find_column(header, shape.clock_column)) return {};
  const bool has_dates =
      std::ranges::any_of(header, [](const std::string& cell) { return is_date(cell); });
  return has_dates ? std::nullopt : time;
}

char likely_separator(std::string_view line) {
  char likely = ',';
  std::ptrdiff_t most = 0;
  for (const char sign : {'\t', ';', ',', '|'}) {
    std::ptrdiff_t count = 0;
    bool is_inside = false;
    for (const char c : line) {
      if (c == '"') is_inside = !is_inside;
      if (c == sign && !is_inside) ++count;
    }
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
