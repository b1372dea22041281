#include "adapters/table/sniff.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <set>

#include "adapters/csv/fields.hpp"
#include "adapters/table/cells/cell_number.hpp"
#include "adapters/table/cells/decimal_sign.hpp"
#include "adapters/table/cells/words.hpp"
#include "adapters/table/clock_labels.hpp"
#include "adapters/table/flags.hpp"
#include "adapters/table/header_rows.hpp"
#include "adapters/table/meter_columns.hpp"
#include "adapters/table/read_table.hpp"
#include "adapters/table/same_load.hpp"
#include "adapters/table/time_column.hpp"
#include "core/text/ascii.hpp"
#include "core/text/printable.hpp"

namespace recald::table {
namespace {

using metering::Instant;
using std::chrono::seconds;

constexpr std::size_t kNowhere = static_cast<std::size_t>(-1);
constexpr std::array kDateFormats{TimeFormat::year_first, TimeFormat::day_first,
                                  TimeFormat::month_first};

std::string row_words(const KeptRow& row) { return "row " + std::to_string(row.number); }

/// Builds up the guess step by step.
class TableSniffer {
 public:
  TableSniffer(std::span<const KeptRow> rows, const TableHints& hints) : hints_(hints) {
    for (const KeptRow& row : rows) {
      const bool is_filled = std::any_of(row.cells.begin(), row.cells.end(),
                                         [](const std::string& cell) { return !cell.empty(); });
      if (is_filled) rows_.push_back(&row);
      width_ = std::max(width_, row.cells.size());
    }
  }

  Result<TableGuess> run() {
    if (rows_.empty()) return failure(ErrorCode::malformed, "it is empty");
    const auto told = TRY(told_time_column());
    const auto times = find_time_column(rows_, width_, told);
    if (!times) return failure(ErrorCode::malformed, no_times());
    times_ = *times;
    kinds_ = kinds_of(data(), width_);
    header_ = find_header_rows(rows_, times_, kinds_);
    guess_.shape.time_column = column_text(times_.column);
    find_clock();
    TRY(find_time_format());
    find_meters();
    TRY(take_told_columns());
    TRY(find_decimal());
    find_flags();
    TRY(list_values());
    leave_out_same_loads();
    return std::move(guess_);
  }

 private:
  static Error no_such_column(std::string_view column) {
    return {ErrorCode::malformed, "it has no column " + csv::in_quotes(column) +
                                      "; name one as its header has it, or as \"#3\""};
  }

  /// Before it is known where the header is. @return nothing where nobody says so
  [[nodiscard]] Result<std::optional<std::size_t>> told_time_column() const {
    const std::string& column = hints_.time_column;
    if (column.empty()) return std::optional<std::size_t>{};
    for (const KeptRow* row : rows_) {
      if (const auto found = find_column(row->cells, column)) return found;
    }
    return tl::unexpected(no_such_column(column));
  }

  /// By the header, as a site file names it.
  [[nodiscard]] Result<std::size_t> told_column(const std::string& column) const {
    for (std::size_t i = 0; i < width_; ++i) {
      if (column_text(i) == column || full_text(i) == column) return i;
    }
    if (const auto numbered = find_column({}, column); numbered && *numbered < width_) {
      return *numbered;
    }
    return tl::unexpected(no_such_column(column));
  }

  Result<void> take_told_columns() {
    if (!hints_.columns.empty()) {
      values_.clear();
      for (const std::string& column : hints_.columns) {
        values_.push_back(TRY(told_column(column)));
        why_[values_.back()].clear();
      }
      for (std::size_t i = 0; i < width_; ++i) {
        const bool is_told = std::ranges::find(values_, i) != values_.end();
        if (!is_told && why_[i].empty()) why_[i] = "left out, as told";
      }
    }
    if (hints_.meter_column.empty()) return {};
    meter_ = TRY(told_column(hints_.meter_column));
    std::erase(values_, meter_);
    guess_.shape.meter_column = column_text(meter_);
    return {};
  }

  [[nodiscard]] std::span<const KeptRow* const> data() const {
    return std::span{rows_}.subspan(times_.first_row);
  }

  /// Names the cell that is most like a time.
  [[nodiscard]] std::string no_times() const {
    std::string words =
        "no column has dates and times in most of its rows; recald looks for such as "
        "2024-03-31 14:15, 31/03/2024 14:15 or 03/31/2024 2:15 PM";
    const KeptRow& row = *rows_[rows_.size() / 2];
    const auto likeness = [](const std::string& cell) {
      return std::count_if(cell.begin(), cell.end(),
                           [](char c) {
                             return (c >= '0' && c <= '9') || c == ':' || c == '-' || c == '/';
                           }) *
             (cell.size() < 60 && !is_number(cell) ? 1 : 0);
    };
    const auto most = std::max_element(
        row.cells.begin(), row.cells.end(),
        [&](const std::string& a, const std::string& b) { return likeness(a) < likeness(b); });
    if (most == row.cells.end() || likeness(*most) < 4) return words;
    return words + "; nearest to one is " + csv::in_quotes(*most) + " in " + row_words(row);
  }

  [[nodiscard]] std::string_view header_text(std::size_t column) const {
    return column < header_.names.size() ? std::string_view{header_.names[column]} : "";
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

  /// All that the header says of a column, or how a message names it.
  [[nodiscard]] const std::string& full_text(std::size_t column) const {
    return header_.texts[column];
  }
  [[nodiscard]] Meanings meanings_at(std::size_t column) const {
    return meanings_of(full_text(column));
  }

  /// Starts are better than what says neither, and that better than ends.
  [[nodiscard]] int side_of(std::size_t column) const {
    const Meanings meanings = meanings_at(column);
    if (meanings.has(Meaning::from)) return meanings.has(Meaning::to) ? 1 : 0;
    return meanings.has(Meaning::to) ? 2 : 1;
  }

  void set_stamps(csv::Stamps stamps, std::string because) {
    if (guess_.stamps) return;
    guess_.stamps = stamps;
    guess_.stamps_because = std::move(because);
  }

  /// If the stamps are only dates, finds the column with the times.
  void find_clock() {
    const bool is_date_only =
        !times_.is_counted && std::none_of(data().begin(), data().end(), [&](const KeptRow* row) {
          for (const TimeFormat format : kDateFormats) {
            const auto stamp = parse_stamp(cell_of(*row, times_.column), format);
            if (stamp) return stamp->has_time && stamp->clock != floor_day(stamp->clock);
          }
          return false;
        });
    if (is_date_only) {
      for (const int side : {side_of(times_.column), 0, 1, 2}) {
        if (clock_ == kNowhere) clock_ = clock_column(side);
      }
      if (clock_ == kNowhere) find_labels();
      if (clock_ != kNowhere) guess_.shape.clock_column = column_text(clock_);
    }
    say_stamps();
  }

  [[nodiscard]] std::size_t clock_column(int side) const {
    for (std::size_t column = 0; column < width_; ++column) {
      const ColumnKinds& kinds = kinds_[column];
      if (column == times_.column || !kinds.is_mostly(kinds.times_of_day)) continue;
      if (side_of(column) != side) continue;
      // 14.15 may be a number and 0015 anything, unless the header says a time.
      const Meanings meanings = meanings_at(column);
      const bool is_called_so =
          meanings.has_any({Meaning::clock, Meaning::time}) && !meanings.has(Meaning::use);
      const bool has_four_figures =
          std::all_of(kinds.texts.begin(), kinds.texts.end(),
                      [](const std::string& text) { return text.size() == 4; });
      const bool may_be_time = is_called_so && (!kinds.is_whole || has_four_figures);
      if (kinds.is_mostly(kinds.numbers) && !may_be_time) continue;
      return column;
    }
    return kNowhere;
  }

  static Instant floor_day(Instant t) { return std::chrono::floor<std::chrono::days>(t); }

  /// Numbers of hours or intervals: from 0 or 1 to the end of a day, and again.
  void find_labels() {
    for (std::size_t column = 0; column < width_; ++column) {
      if (column == times_.column) continue;
      std::set<int> labels;
      std::size_t labelled = 0;
      std::size_t turns = 0;  // within a date
      int last = -1;
      std::string_view date;
      bool rises = false;
      for (const KeptRow* row : data()) {
        const auto label = parse_label(cell_of(*row, column));
        if (!label) continue;
        ++labelled;
        labels.insert(*label);
        const bool is_same_date = cell_of(*row, times_.column) == date;
        if (is_same_date && *label != last) {
          if (last >= 0 && rises != (*label > last)) ++turns;
          rises = *label > last;
        }
        last = *label;
        date = cell_of(*row, times_.column);
      }
      if (!kinds_[column].is_mostly(labelled) || labels.size() < 23) continue;
      const bool is_complete =
          *labels.rbegin() - *labels.begin() + 1 == static_cast<int>(labels.size());
      // Once a day the count begins again, and then it may be another way round.
      if (!is_complete || *labels.begin() > 1 || 10 * turns > labelled) continue;
      if (take_labels(column, *labels.begin(), *labels.rbegin())) return;
    }
  }

  bool take_labels(std::size_t column, int first, int last) {
    if (first == 0) {
      if (last > 23) return false;
      clock_ = column;  // hours of a clock
      return true;
    }
    for (const int usual : {24, 48, 96, 144, 288}) {
      const int change = usual / 24;
      if (last < usual - change || last > usual + change) continue;
      clock_ = column;
      guess_.shape.clock_format = ClockFormat::interval_number;
      guess_.shape.interval = *interval_of_labels(usual);
      guess_.labels_a_day = usual;
      return true;
    }
    return false;
  }

  /// What is certain about starts and ends: ranges, numbered intervals, words of the header.
  void say_stamps() {
    if (guess_.labels_a_day > 0) {
      set_stamps(csv::Stamps::start, "a number stands for its whole interval");
      return;
    }
    if (clock_ != kNowhere) find_midnight_as_24();
    const std::size_t last = clock_ == kNowhere ? times_.column : clock_;
    const bool is_range = std::any_of(data().begin(), data().end(), [&](const KeptRow* row) {
      const std::string_view cell = cell_of(*row, last);
      if (clock_ != kNowhere) {
        const auto clock = parse_clock(cell);
        return clock && clock->is_range;
      }
      return std::any_of(kDateFormats.begin(), kDateFormats.end(), [&](TimeFormat format) {
        const auto stamp = parse_stamp(cell, format);
        return stamp && stamp->is_range;
      });
    });
    if (is_range) set_stamps(csv::Stamps::start, "each says from when to when");
    if (side_of(last) == 0) set_stamps(csv::Stamps::start, "by the column's name");
    if (side_of(last) == 2) set_stamps(csv::Stamps::end, "by the column's name");
  }

  /// Times of day that end at 24:00 may be the hours of the day, whatever the clock does.
  void find_midnight_as_24() {
    std::set<seconds> times;
    for (const KeptRow* row : data()) {
      const auto clock = parse_clock(cell_of(*row, clock_));
      if (clock && !clock->is_hour && !clock->is_range) times.insert(clock->time);
    }
    constexpr seconds kEnd{86'400};
    if (times.size() < 23 || !times.contains(kEnd)) return;
    const seconds step = kEnd - *std::prev(times.end(), 2);
    if (kEnd % step != seconds{0} || !interval_of_labels(static_cast<int>(kEnd / step))) return;
    guess_.shape.interval = step;
    guess_.labels_a_day = static_cast<int>(kEnd / step);
  }

  struct FormatTrial {
    std::size_t wrong = 0;
    std::size_t jumps = 0;  ///< Steps of more than a day and a half.
    const KeptRow* first_wrong = nullptr;
    std::size_t with_offset = 0;
    std::size_t read = 0;
    std::set<seconds> offsets;
  };

  [[nodiscard]] FormatTrial trial_of(TimeFormat format) const {
    FormatTrial trial;
    std::optional<Instant> last;
    for (const KeptRow* row : data().first(dated_rows())) {
      const std::string_view cell = cell_of(*row, times_.column);
      if (cell.empty()) continue;
      const auto stamp = parse_stamp(cell, format);
      if (!stamp) {
        ++trial.wrong;
        if (trial.first_wrong == nullptr) trial.first_wrong = row;
        continue;
      }
      ++trial.read;
      if (stamp->utc_offset) {
        ++trial.with_offset;
        trial.offsets.insert(*stamp->utc_offset);
      }
      constexpr seconds kJump{36 * 3600};
      if (last && (stamp->clock - *last > kJump || *last - stamp->clock > kJump)) ++trial.jumps;
      last = stamp->clock;
    }
    return trial;
  }

  /// Rows of data up to the last with a date: sums and remarks may stand below.
  [[nodiscard]] std::size_t dated_rows() const {
    std::size_t count = data().size();
    while (count > 0 && !is_date(cell_of(*data()[count - 1], times_.column))) --count;
    return count;
  }

  Result<void> find_time_format() {
    if (times_.is_counted) return take_counted();
    std::array<FormatTrial, 3> trials;
    for (std::size_t i = 0; i < 3; ++i) trials[i] = trial_of(kDateFormats[i]);
    const auto told = std::ranges::find(kDateFormats, hints_.dates.value_or(TimeFormat::unix));
    const auto best = told != kDateFormats.end()
                          ? static_cast<std::size_t>(told - kDateFormats.begin())
                          : static_cast<std::size_t>(
                                std::min_element(trials.begin(), trials.end(),
                                                 [](const FormatTrial& a, const FormatTrial& b) {
                                                   return a.wrong != b.wrong ? a.wrong < b.wrong
                                                                             : a.jumps < b.jumps;
                                                 }) -
                                trials.begin());
    const FormatTrial& trial = trials[best];
    const std::string example = csv::in_quotes(cell_of(*data().front(), times_.column));
    if (100 * trial.wrong > trial.wrong + trial.read) {
      const std::string odd = csv::in_quotes(cell_of(*trial.first_wrong, times_.column));
      return failure(ErrorCode::malformed,
                     "its dates change their format: " + row_words(*data().front()) + " has " +
                         example + ", " + row_words(*trial.first_wrong) + " has " + odd);
    }
    constexpr std::size_t kOffsetsMax = 4;  // of one place, whatever its rules
    if (trial.offsets.size() > kOffsetsMax) {
      return failure(ErrorCode::malformed,
                     "its times such as " + example +
                         " would have many offsets from UTC; if they are written from - to, put "
                         "blanks around the hyphen");
    }
    guess_.shape.time_format = kDateFormats[best];
    guess_.has_offsets = trial.with_offset == trial.read;
    if (told != kDateFormats.end()) {
      guess_.time_format_because = "as told";
    } else {
      explain(trials, best, example);
    }
    return {};
  }

  Result<void> take_counted() {
    guess_.shape.time_format = times_.format;
    const bool is_excel = times_.format == TimeFormat::excel;
    guess_.time_format_because =
        is_excel ? "days as a spreadsheet counts them" : "seconds since 1970, in UTC";
    guess_.has_offsets = !is_excel;
    const std::string name = folded(full_text(times_.column));
    if (!is_excel && name.find(" local ") != std::string::npos) {
      return failure(ErrorCode::malformed,
                     "column " + csv::in_quotes(full_text(times_.column)) +
                         " counts seconds of a local clock, which recald does not read; export "
                         "seconds in UTC, or dates and times");
    }
    return {};
  }

  void explain(const std::array<FormatTrial, 3>& trials, std::size_t best,
               const std::string& example) {
    guess_.time_format_because = "such as " + example;
    if (best == 0) return;
    const FormatTrial& other = trials[3 - best];
    if (other.first_wrong != nullptr) {
      guess_.time_format_because = csv::in_quotes(cell_of(*other.first_wrong, times_.column)) +
                                   " in " + row_words(*other.first_wrong) + " decides";
    } else if (other.jumps > trials[best].jumps) {
      guess_.time_format_because += ", the other way round its days would not follow each other";
    } else {
      guess_.is_time_format_open = true;
      guess_.time_format_because +=
          ", but it may be " + std::string{to_string(kDateFormats[3 - best])} +
          "; a day after the 12th of a month, or a second day, would decide";
    }
  }

  [[nodiscard]] std::string_view text_below(std::size_t column) const {
    return header_.units == nullptr ? std::string_view{} : cell_of(*header_.units, column);
  }

  /// Whether rows come with the time of an earlier one, as those of several meters do.
  [[nodiscard]] bool do_times_repeat() const {
    std::set<std::pair<std::string_view, std::string_view>> different;
    std::size_t count = 0;
    for (const KeptRow* row : data()) {
      const std::string_view clock =
          clock_ == kNowhere ? std::string_view{} : cell_of(*row, clock_);
      different.emplace(cell_of(*row, times_.column), clock);
      ++count;
    }
    return 10 * different.size() < 9 * count;
  }

  /// Of two columns of numbers, one called "meter" may have the numbers 1, 2 and 3 of meters.
  void take_short_numbers(std::vector<std::size_t>& names) {
    if (values_.size() != 2) return;
    for (const std::size_t column : values_) {
      const ColumnKinds& kinds = kinds_[column];
      const Meanings meanings = meanings_at(column);
      const bool is_called_so = meanings.has_any({Meaning::meter, Meaning::identifier}) &&
                                !meanings.has(Meaning::use) &&
                                split_unit(full_text(column)).unit.empty();
      const bool are_ids =
          std::all_of(kinds.texts.begin(), kinds.texts.end(),
                      [](const std::string& text) { return csv::is_digits(text); });
      if (is_called_so && are_ids && kinds.repeats() && do_times_repeat()) names.push_back(column);
    }
    for (const std::size_t column : names) std::erase(values_, column);
  }

  /// A long table has one column of numbers, and a column that names each row's meter.
  void find_meters() {
    std::vector<std::size_t> names;
    const bool is_long = do_times_repeat();
    why_.assign(width_, "");
    for (std::size_t column = 0; column < width_; ++column) {
      const ColumnKinds& kinds = kinds_[column];
      if (column == times_.column || column == clock_ || kinds.filled == 0) continue;
      if (is_column_of_units(full_text(column), kinds)) {
        unit_ = column;
        continue;
      }
      const Meanings meanings = meanings_at(column);
      const bool is_called_so = meanings.has_any({Meaning::meter, Meaning::identifier}) &&
                                split_unit(full_text(column)).unit.empty();
      if (kinds.is_mostly(kinds.numbers)) {
        why_[column] = why_no_meter(full_text(column), text_below(column), kinds);
        if (why_[column].empty()) values_.push_back(column);
        if (why_[column] == "an identifier" && is_called_so) numbered_.push_back(column);
        continue;
      }
      if (!kinds.is_mostly(kinds.words) || is_column_of_times(kinds_[column])) continue;
      const bool may_name =
          kinds.repeats() && !meanings.has(Meaning::status) && !says_quality(column);
      if (may_name && (is_called_so || (is_long && kinds.texts.size() > 1)))
        names.push_back(column);
    }
    if (names.empty()) names = numbered_;
    if (names.empty()) take_short_numbers(names);
    if (names.empty() || values_.size() != 1) {
      unit_of_all_ = unit_;
      if (unit_ != kNowhere) guess_.unit_column = column_text(unit_);
      unit_ = kNowhere;
      return;
    }
    const auto rank = [&](std::size_t column) {
      const Meanings meanings = meanings_at(column);
      return (kinds_[column].texts.size() > 1 ? 0 : 4) + (meanings.has(Meaning::meter) ? 0 : 1) +
             (meanings.has(Meaning::tariff) ? 2 : 0);
    };
    meter_ = *std::min_element(names.begin(), names.end(),
                               [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
    guess_.shape.meter_column = column_text(meter_);
    if (unit_ != kNowhere) guess_.shape.unit_column = column_text(unit_);
  }

  /// Whether the texts of a column say how its values came about.
  [[nodiscard]] bool says_quality(std::size_t column) const {
    const std::set<std::string>& texts = kinds_[column].texts;
    return are_flags(std::vector<std::string_view>{texts.begin(), texts.end()});
  }

  /// Finds a column of few short texts that says how good each value is.
  void find_flags() {
    constexpr std::size_t kFlagLength = 24;
    for (std::size_t column = 0; column < width_; ++column) {
      const ColumnKinds& kinds = kinds_[column];
      const bool is_other = column == times_.column || column == clock_ || column == meter_ ||
                            column == unit_ || column == unit_of_all_ ||
                            std::ranges::find(values_, column) != values_.end();
      const bool are_short =
          kinds.texts.size() <= kFlagsMax &&
          std::ranges::all_of(kinds.texts, [](const auto& t) { return t.size() <= kFlagLength; });
      if (is_other || kinds.filled == 0 || kinds.words == 0 || !are_short) continue;
      if (!is_flag_header(header_text(column)) && !says_quality(column)) continue;
      guess_.shape.flag_column = guess_.flag_column = column_text(column);
      flag_ = column;
      return;
    }
  }

  Result<void> find_decimal() {
    if (hints_.decimal) {
      guess_.shape.decimal = *hints_.decimal;
      guess_.decimal_because = "as told";
      return {};
    }
    std::vector<std::size_t> others;
    for (std::size_t column = 0; column < width_; ++column) {
      if (!why_[column].empty()) others.push_back(column);
    }
    const auto sign = TRY(guess_decimal(data(), values_, others));
    guess_.shape.decimal = sign.decimal;
    guess_.decimal_because = sign.because;
    return {};
  }

  Result<void> list_values() {
    above_ = unit_above(std::span{rows_}.first(header_.above));
    for (std::size_t column = 0; column < width_; ++column) {
      if (column == times_.column || column == clock_ || column == meter_ || column == unit_ ||
          column == flag_) {
        continue;
      }
      const std::string text = column_text(column);
      if (std::find(values_.begin(), values_.end(), column) != values_.end()) {
        add_value(column, text);
      } else if (!why_[column].empty()) {
        guess_.ignored.push_back(printable(text) + " (" + why_[column] + ")");
      } else if (kinds_[column].filled > 0 && column != unit_of_all_) {
        const bool is_mixed = kinds_[column].numbers > 0;
        const bool are_times = is_column_of_times(kinds_[column]);
        guess_.ignored.push_back(printable(text) + (are_times  ? " (times)"
                                                    : is_mixed ? " (numbers among text)"
                                                               : " (text)"));
      } else if (!header_text(column).empty() && column != unit_of_all_) {
        guess_.ignored.push_back(printable(text) + " (empty)");
      }
    }
    if (!guess_.values.empty()) return {};
    return failure(ErrorCode::malformed, no_numbers());
  }

  [[nodiscard]] std::string no_numbers() const {
    std::string words = "beside the times in " + csv::in_quotes(guess_.shape.time_column) +
                        " no column has numbers of a meter";
    std::size_t shown = 0;
    for (std::size_t column = 0; column < width_ && shown < 6; ++column) {
      if (column == times_.column || column == clock_) continue;
      const auto filled = std::find_if(data().begin(), data().end(), [&](const KeptRow* row) {
        return !cell_of(*row, column).empty();
      });
      if (filled == data().end()) continue;
      words += (shown++ == 0 ? "; there are " : ", ") + csv::in_quotes(column_text(column)) + " (" +
               (why_[column].empty() ? "text" : why_[column]) + ", such as " +
               csv::in_quotes(cell_of(**filled, column).substr(0, 40)) + " in " +
               row_words(**filled) + ")";
    }
    return words;
  }

  /// "main_W", unless other columns are of the north, the east or the south.
  [[nodiscard]] bool is_in_watts(std::size_t column) const {
    const auto ends_in = [&](std::size_t of, std::string_view letters) {
      const std::string& text = full_text(of);
      constexpr std::string_view kBefore = "_. ";
      return text.size() > 2 && kBefore.find(text[text.size() - 2]) != std::string_view::npos &&
             letters.find(text.back()) != std::string_view::npos;
    };
    if (!ends_in(column, "W")) return false;
    // "Wing W" is a side of the building.
    const std::string& text = full_text(column);
    const std::string name = folded(std::string_view{text}.substr(0, text.size() - 2));
    for (const std::string_view side :
         {"wing ", "building ", "block ", "side ", "tower ", "fluegel ", "gebaeude ", "haus ",
          "trakt ", "aile ", "batiment ", "ala ", "edificio ", "vleugel ", "gebouw "}) {
      if (name.ends_with(side)) return false;
    }
    for (std::size_t other = 0; other < width_; ++other) {
      if (ends_in(other, "NESO")) return false;
    }
    return true;
  }

  /// The unit of "Active import (kW)", if a column has that and nothing else.
  [[nodiscard]] std::string unit_in_type(std::size_t column) const {
    const ColumnKinds& kinds = kinds_[column];
    if (!kinds.is_mostly(kinds.words) || kinds.texts.size() != 1) return "";
    const NameAndUnit parts = split_unit(*kinds.texts.begin());
    return parts.is_unit_in_brackets ? parts.unit : "";
  }

  void add_value(std::size_t column, const std::string& text) {
    const NameAndUnit parts = split_unit(full_text(column));
    GuessedColumn value{parts.name, text, parts.unit, "as the header says"};
    const auto say = [&](std::string unit, std::string because) {
      if (unit.empty()) return;
      value.unit = std::move(unit);
      value.unit_because = std::move(because);
    };
    if (header_.units != nullptr) {
      say(split_unit(text_below(column)).unit, "as " + row_words(*header_.units) + " says");
    }
    const ColumnKinds& kinds = kinds_[column];
    if (2 * kinds.with_unit >= kinds.numbers && kinds.with_unit > 0) {
      const auto most =
          std::max_element(kinds.units.begin(), kinds.units.end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
      say(most->first, "as its cells say");
    }
    if (value.unit.empty() && unit_of_all_ != kNowhere && kinds_[unit_of_all_].texts.size() == 1) {
      say(*kinds_[unit_of_all_].texts.begin(),
          "as column " + csv::in_quotes(column_text(unit_of_all_)) + " says");
    }
    if (value.unit.empty()) {
      for (std::size_t other = 0; other < width_; ++other) {
        const std::string unit = unit_in_type(other);
        if (unit.empty()) continue;
        say(unit, "as column " + csv::in_quotes(column_text(other)) + " says");
        break;
      }
    }
    if (value.unit.empty() && is_in_watts(column)) {
      value.name.resize(value.name.size() - 2);
      say("W", "as the header says");
    }
    if (value.unit.empty()) {
      say(above_.unit, "as row " + std::to_string(above_.row) + " says");
    }
    if (value.unit.empty()) value.unit_because.clear();
    guess_.values.push_back(std::move(value));
  }

  /// The commonest step between the times of rows.
  [[nodiscard]] seconds usual_step() const {
    std::set<Instant> times;
    for (const KeptRow* row : data()) {
      const auto stamp = parse_stamp(cell_of(*row, times_.column), guess_.shape.time_format);
      if (!stamp) continue;
      Instant time = stamp->clock;
      if (clock_ != kNowhere) {
        const auto clock = parse_clock(cell_of(*row, clock_));
        if (!clock) continue;
        time += clock->time;
      }
      times.insert(time);
    }
    if (guess_.shape.interval.count() > 0) return guess_.shape.interval;
    std::map<seconds, int> steps;
    for (auto at = times.begin(); at != times.end() && std::next(at) != times.end(); ++at) {
      ++steps[*std::next(at) - *at];
    }
    const auto most =
        std::max_element(steps.begin(), steps.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == steps.end() ? seconds{0} : most->first;
  }

  /// kW beside kWh of one load would count it twice.
  void leave_out_same_loads() {
    if (guess_.values.size() < 2 || meter_ != kNowhere) return;
    std::vector<LoadColumn> loads;
    for (std::size_t i = 0; i < values_.size(); ++i) {
      LoadColumn load{guess_.values[i].name, guess_.values[i].unit, {}};
      for (const KeptRow* row : data()) {
        const NumberAndUnit parts = split_number(cell_of(*row, values_[i]));
        load.values.push_back(parse_cell(parts.number, guess_.shape.decimal).value_or(NAN));
      }
      loads.push_back(std::move(load));
    }
    const seconds step = usual_step();
    std::vector<GuessedColumn> kept;
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const auto same = same_load_of(loads, i, step);
      if (!same) {
        kept.push_back(guess_.values[i]);
        continue;
      }
      const std::string of = csv::in_quotes(guess_.values[same->as].column);
      guess_.ignored.push_back(printable(guess_.values[i].column) + " (the load of " + of + ")");
      if (same->agrees) continue;
      guess_.notes.push_back(csv::in_quotes(guess_.values[i].column) + " is named as the load of " +
                             of + ", which is taken, but is not its mean: see " +
                             row_words(*data()[same->row]) + ".");
    }
    guess_.values = std::move(kept);
  }

  std::vector<const KeptRow*> rows_;  ///< Rows that are not blank.
  std::size_t width_ = 0;
  TimeColumn times_;
  HeaderRows header_;
  UnitAbove above_;
  std::size_t clock_ = kNowhere;
  std::size_t meter_ = kNowhere;
  std::size_t unit_ = kNowhere;         ///< Of a long table.
  std::size_t unit_of_all_ = kNowhere;  ///< Of any other table.
  std::size_t flag_ = kNowhere;
  std::vector<ColumnKinds> kinds_;
  std::vector<std::string> why_;  ///< Of columns of numbers: why they are no meter's.
  std::vector<std::size_t> values_;
  std::vector<std::size_t> numbered_;  ///< Columns of identifiers that may name meters.
  const TableHints& hints_;
  TableGuess guess_;
};

/// How often a sign stands outside quotes.
std::ptrdiff_t signs_outside_quotes(std::string_view line, char sign) {
  std::ptrdiff_t count = 0;
  bool is_inside = false;
  for (const char c : line) {
    if (c == '"') is_inside = !is_inside;
    if (c == sign && !is_inside) ++count;
  }
  return count;
}

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

Result<TableGuess> guess_table(std::span<const KeptRow> rows, const TableHints& hints) {
  return TableSniffer{rows, hints}.run();
}

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
  constexpr std::string_view kDirective = "sep=";
  if (!lines.empty() && lines.front().size() == kDirective.size() + 1 &&
      to_lower(lines.front()).substr(0, kDirective.size()) == kDirective) {
    return lines.front().back();
  }
  // If several signs fit equally well, the one that is rarer in text wins: "1,5;2,5" is two
  // numbers. The lines above a table do not count: of the others a half has to be alike.
  for (const double share : {0.7, 0.4}) {
    for (const char sign : {'\t', ';', '|', ','}) {
      std::map<std::ptrdiff_t, std::size_t> counts;
      std::size_t filled = 0;
      for (const std::string& line : lines) {
        if (csv::trimmed(line).empty()) continue;
        ++filled;
        const auto count = signs_outside_quotes(line, sign);
        if (count > 0) ++counts[count];
      }
      for (const auto& [count, times] : counts) {
        if (static_cast<double>(times) >= share * static_cast<double>(filled)) return sign;
      }
    }
  }
  return ',';
}

}  // namespace recald::table
