#include "adapters/table/clock_labels.hpp"

#include <algorithm>

#include "adapters/csv/fields.hpp"
#include "adapters/table/cells/cell_number.hpp"
#include "adapters/table/cells/stamp_parts.hpp"
#include "adapters/table/delimited.hpp"
#include "adapters/table/read_table.hpp"
#include "core/text/utf8.hpp"

namespace recald::table {
namespace {

using metering::Day;
using metering::Instant;
using std::chrono::days;
using std::chrono::seconds;
using std::chrono::sys_days;

}  // namespace

/// Labels of one kind of a day: those that it lacks, or that it has twice.
struct LabelledDays::Range {
  int first;
  int count;

  [[nodiscard]] bool contains(int label) const { return label >= first && label < first + count; }
};

/// A day that is not 24 hours long.
struct LabelledDays::Change {
  int usual;      ///< Labels of other days.
  int extra;      ///< Intervals that it has more than those; negative: less.
  Range by_hour;  ///< Labels that are missing or come twice if each names a clock hour.
  Range by_end;   ///< If each is the time at which its interval ends.
};

std::optional<int> parse_label(std::string_view text) {
  if (text.size() > 16) return {};
  Scanner scan{text};
  if (scan.word().size() > 8) return {};
  scan.skip(" ._#:");
  const auto number = scan.number(3);
  if (!number || *number > kLabelsMax) return {};
  if (scan.take('.') || scan.take(',')) scan.skip("0");  // 7.0, as some write whole numbers
  if (scan.is_done()) return number;
  return {};
}

namespace {

/// "7:00" to "25:00", the end of a day of 25 hours.
std::optional<seconds> parse_label_time(std::string_view text) {
  Scanner scan{text};
  const auto hours = scan.number(2);
  constexpr int kHoursMax = 25;  // of a day
  if (!hours || *hours > kHoursMax || !scan.take(':')) return {};
  const auto minutes = scan.number(2);
  if (!minutes || *minutes > 59) return {};
  if (scan.take(':')) scan.skip("0");
  const seconds time{3600 * *hours + 60 * *minutes};
  return scan.is_done() && time <= std::chrono::hours{kHoursMax} ? std::optional{time}
                                                                 : std::nullopt;
}

}  // namespace

std::optional<int> label_of(std::string_view text, seconds interval) {
  if (const auto clock = parse_clock(text); clock && !clock->is_hour) {
    return static_cast<int>(clock->time / interval);
  }
  if (const auto time = parse_label_time(text)) return static_cast<int>(*time / interval);
  return parse_label(text);
}

std::optional<seconds> time_of_clock_cell(std::string_view text, const TableShape& shape) {
  if (shape.clock_format == ClockFormat::time) return parse_time_of_day(text);
  const seconds length = shape.interval > seconds{0} ? shape.interval : seconds{3600};
  const auto number = label_of(text, length);
  return number && *number > 0 ? std::optional{(*number - 1) * length} : std::nullopt;
}

std::optional<seconds> interval_of_labels(int labels) {
  for (const int usual : {24, 48, 96, 144, 288}) {
    if (labels == usual) return seconds{86'400 / usual};
  }
  return {};
}

void LabelledDays::take(sys_days date, int label, bool is_empty) {
  if (label < 1 || label > kLabelsMax) return;
  Labels& labels = dates_[date];
  const auto at = static_cast<std::size_t>(label);
  if (labels.rows[at] < 0xFFFF) ++labels.rows[at];
  if (!is_empty) labels.filled.set(at);
}

int LabelledDays::usual_labels() const {
  std::map<int, int> counts;
  for (const auto& [date, labels] : dates_) {
    const auto last = std::find_if(labels.rows.rbegin(), labels.rows.rend(),
                                   [](std::uint16_t rows) { return rows > 0; });
    ++counts[static_cast<int>(labels.rows.rend() - last) - 1];
  }
  const auto most =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? 0 : most->first;
}

std::optional<ClockFormat> LabelledDays::format_on(const Labels& labels,
                                                   const Change& change) const {
  const auto rows = [&](int label) { return labels.rows[static_cast<std::size_t>(label)]; };
  const auto is_filled = [&](int label) {
    return labels.filled.test(static_cast<std::size_t>(label));
  };
  const int shift = std::abs(change.extra);
  const Range last{change.usual - shift + 1, shift};
  if (change.extra > 0 && rows(change.usual + 1) > 0) return ClockFormat::interval_number;
  // What sets a label apart: it is missing or empty, or has twice the rows of the day's last one.
  std::size_t found = 0;
  bool lacks_rows = false;  // then blanks and zeros say nothing
  for (int label = 1; label <= change.usual; ++label) lacks_rows = lacks_rows || rows(label) == 0;
  const auto is_apart = [&](int label) {
    return change.extra < 0 ? rows(label) == 0 || (!lacks_rows && !is_filled(label))
                            : rows(label) >= 2 * std::max<int>(1, rows(change.usual));
  };
  const auto is_just = [&](const Range& range) {
    for (int label = 1; label <= change.usual; ++label) {
      const bool may_be =
          change.by_hour.contains(label) || change.by_end.contains(label) || last.contains(label);
      if (may_be && is_apart(label) != range.contains(label)) return false;
    }
    return true;
  };
  std::optional<ClockFormat> format;
  const auto vote = [&](const Range& range, ClockFormat so) {
    if (!is_just(range)) return;
    ++found;
    format = so;
  };
  vote(change.by_hour, ClockFormat::hour_ending);
  vote(change.by_end, ClockFormat::time);
  if (change.extra < 0) vote(last, ClockFormat::interval_number);
  return found == 1 ? format : std::nullopt;
}

ClockLabels LabelledDays::decide(const metering::LocalCalendar& calendar,
                                 ClockFormat without_change) const {
  const int usual = usual_labels();
  const auto interval = interval_of_labels(usual);
  if (!interval) return {{}, "most days count to " + std::to_string(usual)};
  ClockLabels decided;
  std::string open;
  for (const auto& [date, labels] : dates_) {
    const metering::TimeSpan span = calendar.day_span(Day{date});
    const auto extra = static_cast<int>((span.length() - days{1}) / *interval);
    if (extra == 0) continue;
    Instant at = span.begin;
    const seconds before = calendar.utc_offset(at);
    while (at < span.end && calendar.utc_offset(at) == before) at += *interval;
    const seconds shown = at + calendar.utc_offset(at) - Instant{date};  // after the change
    const auto first = static_cast<int>(std::min(shown, at + before - Instant{date}) / *interval);
    const int shift = std::abs(extra);
    const auto format = format_on(labels, {usual, extra, {first + 1, shift}, {first, shift}});
    const std::string day = metering::to_string(Day{date}) + ", a day of " +
                            std::to_string(span.length() / std::chrono::hours{1}) + " hours";
    if (!format) {
      open = day;
    } else if (decided.format && decided.format != format) {
      return {{}, decided.because + " and " + day + ", contradict each other"};
    } else {
      decided = {format, day};
    }
  }
  if (decided.format) {
    decided.because = "as on " + decided.because;
    return decided;
  }
  if (!open.empty()) return {{}, "its labels on " + open + ", do not show what they count"};
  return {without_change, "no day of 23 or 25 hours is in it; on others it makes no difference"};
}

Result<ClockLabels> read_clock_labels(RowSource& rows, const TableShape& shape,
                                      std::span<const std::string> values,
                                      const metering::LocalCalendar& calendar,
                                      ClockFormat without_change) {
  std::vector<std::string> header;
  std::optional<std::size_t> time_at;
  std::optional<std::size_t> clock_at;
  std::vector<std::size_t> values_at;
  LabelledDays labelled;
  for (TableRow row; rows.next(row);) {
    if (!time_at || !clock_at || values_at.size() < values.size()) {
      header.clear();
      values_at.clear();
      for (const std::string_view cell : row.cells) header.push_back(utf8_of(cell));
      time_at = find_time_in_header(header, shape);
      clock_at = find_column(header, shape.clock_column);
      for (const std::string& value : values) {
        if (const auto at = find_column(header, value)) values_at.push_back(*at);
      }
      continue;
    }
    if (*time_at >= row.cells.size() || *clock_at >= row.cells.size()) continue;
    const auto stamp = parse_stamp(row.cells[*time_at], shape.time_format);
    if (const auto time = parse_time_of_day(row.cells[*clock_at]);
        time && shape.interval > seconds{0} && *time % shape.interval != seconds{0}) {
      return ClockLabels{
          ClockFormat::time,
          "times such as " + csv::in_quotes(row.cells[*clock_at]) + " are no whole intervals"};
    }
    const auto label = label_of(row.cells[*clock_at], shape.interval);
    if (!stamp || !label) continue;
    const bool is_empty = std::all_of(values_at.begin(), values_at.end(), [&](std::size_t at) {
      return at >= row.cells.size() || is_blank(row.cells[at]) ||
             parse_cell(row.cells[at], shape.decimal) == 0.0;
    });
    labelled.take(std::chrono::floor<days>(stamp->clock), *label, is_empty);
  }
  if (rows.error()) return tl::unexpected(*rows.error());
  ClockLabels decided = labelled.decide(calendar, without_change);
  if (decided.format) return decided;
  // Times that end at 24:00 on days of any length are a clock's; an hour may have been added up.
  if (without_change == ClockFormat::time) {
    return ClockLabels{ClockFormat::time, "its days end at 24:00, however long they are"};
  }
  return failure(ErrorCode::malformed,
                 "column " + csv::in_quotes(shape.clock_column) +
                     " counts hours or intervals, but " + decided.because + " in " +
                     calendar.zone_name() +
                     "; say whether a label is the clock hour that ends (clock_format = "
                     "\"hour_ending\") or the n-th interval of the day (\"interval_number\")");
}

}  // namespace recald::table
