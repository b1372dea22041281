#include "adapters/csv/reading_intake.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "adapters/csv/fields.hpp"
#include "core/metering/registers/late_stamps.hpp"
#include "core/metering/registers/rest.hpp"

namespace recald::csv {
namespace {

using metering::Instant;
using metering::kToleranceShare;
using metering::Reading;
using std::chrono::seconds;

constexpr std::size_t kHeadRows = 64;  // an interval is inferred from these
constexpr std::size_t kFewRows = 8;    // … if there are no fewer, or it is an ordinary one
constexpr std::size_t kFirstRows = 4;  // the step at the beginning, if they agree
constexpr std::size_t kRegisterRows = 4096;
constexpr std::size_t kRefusedShown = 3;
constexpr std::size_t kStepsShown = 20;
constexpr std::size_t kChangeRows = 8;   // show whether the step has changed
constexpr std::size_t kChangeAlike = 6;  // of the steps between them are alike then
constexpr std::size_t kChangeMin = 3;    // … or at the end of a file all, of so many
constexpr seconds kOffsetGrid{900};      // the offsets of all zones since 1971 are multiples of it
constexpr seconds kRegisterInterval{900};  // of registers that are logged now and then
constexpr seconds kSpreadMax{86'400};      // values of days are spread
constexpr seconds kClockChange{3600};

Instant stamp_of(const WaitingRow& waiting) { return waiting.row.stamp; }

template <class Rows, class Stamp>
std::vector<Instant> stamps_of(const Rows& rows, std::size_t count, Stamp stamp) {
  std::vector<Instant> stamps;
  for (std::size_t i = 0; i < std::min(count, rows.size()); ++i) stamps.push_back(stamp(rows[i]));
  return stamps;
}

seconds longest_step(const std::vector<RowStep>& steps) {
  return std::ranges::max(steps, {}, &RowStep::step).step;
}

/// By more than intervals of clocks that run fast or slow are.
bool is_longer(seconds step, seconds interval) { return 10 * step > 11 * interval; }

/// A value holds until the next, unless that is further off than two and a half steps.
bool reaches(seconds to_next, seconds step) { return 2 * to_next <= 5 * step; }

}  // namespace

ReadingIntake::ReadingIntake(const ReadingsOptions& options, const ReadingsSink& sink)
    : sink_{sink}, finds_tolerance_{options.finds_tolerance} {
  report_.issues.listed_max = options.issues_listed_max;
  for (const MeterRows& rows : options.meters) add_meter(rows);
}

std::uint32_t ReadingIntake::add_meter(const MeterRows& rows) {
  const auto index = static_cast<std::uint32_t>(meters_.size());
  IntakeMeter meter;
  meter.rows = rows;
  meter.report.shown.meter = index;
  meter.report.shown.name = rows.name;
  meters_.push_back(std::move(meter));
  return index;
}

Result<void> ReadingIntake::set_unit(IntakeMeter& meter, std::string_view unit) {
  const auto conversion = metering::find_unit(trimmed(unit), meter.rows.utility, meter.rows.units);
  if (!conversion) {
    return failure(conversion.error().code,
                   conversion.error().message + " (meter " + in_quotes(meter.rows.name) + ")");
  }
  meter.unit = unit;
  meter.conversion = *conversion;
  if (meter.report.shown.unit.empty()) meter.report.shown.unit = trimmed(unit);
  if (meter.grid_known) set_scale(meter);
  return {};
}

void ReadingIntake::refuse(std::uint64_t line, std::string_view reason, std::string_view text,
                           IntakeMeter* meter) {
  report_.issues.add(line, reason, text);
  if (meter == nullptr) return;
  ++meter->report.refused;
  if (meter->report.first_refused.size() == kRefusedShown) return;
  meter->report.first_refused.push_back({line, printable(reason), excerpt(text)});
}

void ReadingIntake::show_row(const IntakeMeter& meter, const Row& row) const {
  sink_.on_row({meter.report.shown.meter, row.stamp,
                row.value * row.conversion.factor * meter.rows.multiplier, row.conversion.is_rate});
}

void ReadingIntake::take_first(IntakeMeter& meter, const Row& row) {
  if (meter.refused) return;
  if (meter.rows.counter) return keep_sample(meter, row);
  meter.head.push_back({row, excerpt(row.text)});
  if (meter.head.size() < kHeadRows) return;
  const auto steps = steps_of(stamps_of(meter.head, kHeadRows, stamp_of));
  if (steps && is_longer(steps->commonest, kIntervalMax)) return drop_coarse_head(meter);
  begin_meter(meter);
}

/// Values of days may come before those of hours.
void ReadingIntake::drop_coarse_head(IntakeMeter& meter) {
  const auto steps = steps_of(stamps_of(meter.head, kHeadRows, stamp_of));
  note_step(meter, meter.head.front().row, steps->commonest);
  for (std::size_t i = 0; i < kHeadRows / 2; ++i) {
    meter.longer_head.push_back(meter.head[i].row);
    meter.longer_head.back().text = {};
  }
  meter.head.erase(meter.head.begin(), meter.head.begin() + kHeadRows / 2);
}

/// The first rows show the interval; from here on rows go straight to the sink.
void ReadingIntake::begin_meter(IntakeMeter& meter) {
  if (!find_grid(meter)) {
    meter.refused = true;
  } else {
    set_scale(meter);
    meter.grid_known = true;
    if (sink_.on_meter) sink_.on_meter(meter.report.shown);
    for (const Row& row : std::exchange(meter.longer_head, {})) {
      take_longer(meter, row, row.stamp);
      meter.last = meter.newest = row.stamp;
    }
    for (auto& [row, text] : std::exchange(meter.head, {})) {
      Row first = row;
      first.text = text;
      hand_on(meter, first);
    }
  }
  meter.head = {};
}

bool ReadingIntake::refuse_meter(IntakeMeter& meter, const std::string& why) {
  const auto& [row, text] = meter.head.front();
  refuse(row.line, "meter " + in_quotes(meter.report.shown.name) + " " + why, text, &meter);
  return false;
}

/// The interval that the distances between stamps show, or a refusal.
bool ReadingIntake::find_step(IntakeMeter& meter) {
  MeterInFile& shown = meter.report.shown;
  const auto steps = steps_of(stamps_of(meter.head, kHeadRows, stamp_of));
  if (meter.rows.interval) {
    shown.interval = *meter.rows.interval;
    const bool shows = steps && steps->is_regular() && meter.head.size() >= kFewRows;
    meter.step = shows ? steps->commonest : shown.interval;
    return true;
  }
  if (!steps) {
    return refuse_meter(meter,
                        "has one time stamp only, so its interval cannot be seen; declare it");
  }
  // A few rows show no more than their commonest step.
  const bool is_regular = steps->is_regular() || meter.head.size() < kFewRows;
  meter.is_irregular = !is_regular && meter.conversion.is_rate;
  meter.step = is_regular ? steps->commonest : steps->median;
  if (meter.head.size() < kFewRows && !is_interval(meter.step) &&
      !is_longer(meter.step, kIntervalMax)) {
    return refuse_meter(
        meter, "comes every " + in_words(meter.step) + ", in too few rows to average them");
  }
  if (is_longer(meter.step, kIntervalMax)) {
    return refuse_meter(
        meter, "comes every " + in_words(meter.step) + "; recald needs values of an hour or less");
  }
  if (!is_regular && !meter.is_irregular) {
    return refuse_meter(
        meter, "does not come at regular times, but every " + in_words(steps->median) +
                   " or so, and these are no powers; if its values are those of a cumulative "
                   "register, add rated_kW and counter = { unit = \"kWh\" } to its [[meter]]");
  }
  shown.interval = is_interval(meter.step) ? meter.step : *interval_for(meter.step);
  return true;
}

bool ReadingIntake::find_grid(IntakeMeter& meter) {
  MeterInFile& shown = meter.report.shown;
  shown.interval_inferred = !meter.rows.interval;
  meter.tolerance = meter.rows.grid_tolerance;
  find_tolerance(meter);
  for (WaitingRow& one : meter.head) one.row.stamp = on_grid(meter, one.row.stamp);
  if (!find_step(meter)) return false;
  std::map<seconds, int> phases;
  for (const WaitingRow& one : meter.head) {
    ++phases[one.row.stamp.time_since_epoch() % shown.interval];
  }
  shown.phase = std::max_element(phases.begin(), phases.end(), [](const auto& a, const auto& b) {
                  return a.second < b.second;
                })->first;
  // A phase that no zone offset explains means a wrong clock; the rows are then refused one by one.
  if (shown.phase % kOffsetGrid != seconds{0}) shown.phase = seconds{0};
  // The first rows may come at another step than most.
  const auto first = steps_of(stamps_of(meter.head, kFirstRows, stamp_of));
  if (first && !meter.is_irregular && first->share == 1.0) meter.step = first->commonest;
  note_step(meter, meter.head.front().row, meter.step);
  // Rows of days have no part in intervals of hours.
  const bool is_other = meter.step != shown.interval && !is_longer(meter.step, shown.interval);
  if (is_other || meter.is_irregular) use_means(meter);
  find_way(meter);
  return true;
}

/// Stamps a little beside the grid, as of loggers that write what they have read: a tolerance that
/// explains the first rows is tried on all.
void ReadingIntake::find_tolerance(IntakeMeter& meter) {
  const auto steps = steps_of(stamps_of(meter.head, kHeadRows, stamp_of));
  if (!steps) return;
  auto interval = meter.rows.interval;
  if (!interval)
    interval = is_interval(steps->commonest) ? steps->commonest : interval_for(steps->median);
  // A regular step of another length drifts off any grid.
  if (!interval || (steps->is_regular() && !is_interval(steps->commonest))) return;
  meter.report.shown.interval = *interval;
  if (!finds_tolerance_ || meter.tolerance > seconds{0}) return;
  seconds worst{0};
  for (const WaitingRow& one : meter.head) {
    worst = std::max(worst, std::chrono::abs(beside_grid(*interval, one.row.stamp)));
  }
  if (worst > seconds{0} && kToleranceShare * worst <= *interval) {
    meter.tolerance = *interval / kToleranceShare;
  }
}

/// By how much a stamp is late; negative: early.
seconds ReadingIntake::beside_grid(seconds interval, Instant stamp) {
  const seconds grid = std::min(interval, kOffsetGrid);
  const seconds late = stamp.time_since_epoch() % grid;
  return 2 * late > grid ? late - grid : late;
}

Instant ReadingIntake::on_grid(IntakeMeter& meter, Instant stamp) {
  if (meter.tolerance == seconds{0} || meter.report.shown.interval == seconds{0}) return stamp;
  const seconds late = beside_grid(meter.report.shown.interval, stamp);
  const seconds beside = std::chrono::abs(late);
  if (beside > meter.tolerance) return stamp;
  meter.report.beside_max = std::max(meter.report.beside_max, beside);
  return stamp - late;
}

void ReadingIntake::set_scale(IntakeMeter& meter) {
  meter.kW_per_unit = meter.conversion.mean_kW(meter.rows.multiplier, meter.report.shown.interval);
}

void ReadingIntake::use_means(IntakeMeter& meter) {
  const MeterInFile& shown = meter.report.shown;
  if (!meter.means) meter.means.emplace(shown.meter, shown.interval, shown.phase);
}

void ReadingIntake::find_way(IntakeMeter& meter) {
  meter.is_plain =
      !meter.means && meter.waiting.empty() && meter.step == meter.report.shown.interval;
}

/// Takes a row that is not simply the next interval. One at another step waits until those after it
/// show whether rows are missing or come at this step from now on.
void ReadingIntake::take_odd(IntakeMeter& meter, const Row& row, Instant stamp) {
  const auto wait = [&] {
    meter.waiting.push_back({row, excerpt(row.text)});
    meter.waiting.back().row.stamp = stamp;
    find_way(meter);
  };
  if (!meter.waiting.empty()) {
    if (stamp > stamp_of(meter.waiting.back())) {
      wait();
      if (meter.waiting.size() == kChangeRows) settle(meter);
      return;
    }
    settle(meter);
  }
  const bool is_later = meter.last && meter.last == meter.newest && stamp > *meter.last;
  if (is_later && !meter.is_irregular && stamp != *meter.last + meter.step) return wait();
  place(meter, row, stamp);
}

/// Decides about the rows that wait.
void ReadingIntake::settle(IntakeMeter& meter) {
  std::vector<WaitingRow> rows = std::exchange(meter.waiting, {});
  if (rows.empty()) return;
  const auto steps = steps_of(stamps_of(rows, rows.size(), stamp_of));
  const std::size_t between = rows.size() - 1;
  const std::size_t needed =
      rows.size() == kChangeRows ? kChangeAlike : std::max(kChangeMin, between);
  const bool is_new =
      steps && steps->commonest != meter.step && between >= needed &&
      steps->share * static_cast<double>(between) >= static_cast<double>(needed) - 0.5;
  if (is_new) {
    const Row& first = rows.front().row;
    begin_step(meter, first, steps->commonest, first.stamp == *meter.last + steps->commonest);
  }
  for (WaitingRow& one : rows) {
    one.row.text = one.text;
    place(meter, one.row, one.row.stamp);
  }
  find_way(meter);
}

/// @param is_of_held  The value before begins where its step does, if stamps are starts.
void ReadingIntake::begin_step(IntakeMeter& meter, const Row& row, seconds step, bool is_of_held) {
  const seconds interval = meter.report.shown.interval;
  const double shorter =
      metering::in_hours(meter.means ? meter.step : interval) / metering::in_hours(step);
  is_of_held = is_of_held && meter.rows.stamps == Stamps::start;
  meter.step = step;
  // The row before was taken for one of the longer step, which ended at its stamp.
  const bool is_interval_now = step == interval && !meter.means;
  if (is_of_held && is_interval_now && meter.longer && meter.longer->stamp == row.stamp - step) {
    const Row before = *std::exchange(meter.longer, std::nullopt);
    --meter.left_out;
    hold(meter, reading_of(meter, before, before.stamp));
    return note_step(meter, before, step);
  }
  end_longer(meter, row.stamp);
  note_step(meter, row, step);
  if (is_of_held && meter.held) {
    const Reading held = *std::exchange(meter.held, std::nullopt);
    meter.open = {held, step, meter.conversion.is_rate};
    if (is_longer(step, interval)) meter.open.reset();
  }
  if (meter.held) pass_on(meter, *std::exchange(meter.held, std::nullopt));
  if (is_of_held && meter.open) {
    meter.open->length = step;
    if (!meter.open->is_rate) meter.open->value.mean_kW *= shorter;
  }
  if (meter.means || (step != interval && !is_longer(step, interval))) use_means(meter);
}

void ReadingIntake::note_step(IntakeMeter& meter, const Row& row, seconds step) {
  std::vector<RowStep>& steps = meter.report.steps;
  if (steps.size() == kStepsShown || (!steps.empty() && steps.back().step == step)) return;
  steps.push_back({row.line, row.stamp, step});
}

/// Takes a row whose length is known.
void ReadingIntake::place(IntakeMeter& meter, const Row& row, Instant stamp) {
  // Another file may begin before the one in front of it ends.
  if (std::exchange(meter.begins_file, false) && meter.newest && stamp <= *meter.newest) {
    pass_on_all(meter);
    meter.last.reset();
    meter.newest.reset();
    if (std::exchange(meter.means, std::nullopt)) use_means(meter);
  }
  end_longer(meter, stamp);
  ++meter.placed;
  const bool follows =
      meter.last && stamp == *meter.last + meter.step && meter.last == meter.newest;
  if (follows) ++meter.follows;
  const bool is_left_out = is_longer(meter.step, meter.report.shown.interval);
  const Instant start = start_of(meter, stamp);
  if (!is_left_out) {
    if (!check_known_years(meter, row, start)) return;
    if (!meter.means && !check_grid(meter, row, start)) return;
    if (!follows) check_order(meter, row, start);
  }
  if (is_left_out) {
    take_longer(meter, row, stamp);
  } else if (meter.means) {
    add_to_means(meter, row, stamp);
  } else {
    hold(meter, reading_of(meter, row, start));
  }
  meter.last = stamp;
  if (!meter.newest || stamp > *meter.newest) meter.newest = stamp;
}

/// Takes a row of a step that is longer than the interval. The values of days count evenly over
/// their time: their sums are right, their shapes are not known.
void ReadingIntake::take_longer(IntakeMeter& meter, const Row& row, Instant stamp) {
  const seconds length = longest_step(meter.report.steps);
  if (length <= kIntervalMax || length > kSpreadMax || meter.means) return leave_out(meter, row);
  ++meter.left_out;
  if (meter.rows.stamps == Stamps::end) {
    const seconds since = meter.last ? stamp - *meter.last : length;
    const bool follows = std::chrono::abs(since - length) <= kClockChange;
    return spread(meter, row, {stamp - (follows ? since : length), stamp});
  }
  end_longer(meter, stamp);
  meter.longer = row;
  meter.longer->text = {};
}

/// Of starts, the next row ends the time of the one before.
void ReadingIntake::end_longer(IntakeMeter& meter, Instant next) {
  if (!meter.longer) return;
  const Row row = *std::exchange(meter.longer, std::nullopt);
  const seconds length = longest_step(meter.report.steps);
  const seconds until = next - row.stamp;
  const bool follows = std::chrono::abs(until - length) <= kClockChange;
  spread(meter, row, {row.stamp, row.stamp + (follows ? until : length)});
}

void ReadingIntake::spread(IntakeMeter& meter, const Row& row, const metering::TimeSpan& span) {
  const MeterInFile& shown = meter.report.shown;
  const bool is_on_grid =
      (span.begin.time_since_epoch() - shown.phase) % shown.interval == seconds{0};
  if (!is_on_grid || !std::isfinite(row.value) || !check_known_years(meter, row, span.begin))
    return;
  if (meter.held) pass_on(meter, *std::exchange(meter.held, std::nullopt));
  const double mean_kW = row.conversion.mean_kW(row.value * meter.rows.multiplier, span.length());
  for (Instant t = span.begin; t + shown.interval <= span.end; t += shown.interval) {
    pass_on(meter, {shown.meter, t, mean_kW, metering::Validity::scaled,
                    metering::Reason::estimated, row.late});
  }
  const auto of_it =
      std::ranges::find(meter.report.steps, longest_step(meter.report.steps), &RowStep::step);
  ++of_it->spread;
}

void ReadingIntake::leave_out(IntakeMeter& meter, const Row& row) {
  ++meter.left_out;
  RowStep& step = meter.report.steps.back();
  if (step.left_out++ > 0) return;
  refuse(row.line,
         "meter " + in_quotes(meter.report.shown.name) + ": from here values come every " +
             in_words(step.step) + ", which is longer than " +
             (step.step > kIntervalMax ? "an hour" : "its interval") + "; they are left out",
         row.text, &meter);
}

void ReadingIntake::add_to_means(IntakeMeter& meter, const Row& row, Instant stamp) {
  if (meter.newest && stamp <= *meter.newest) return;  // reported as out of order
  Reading value = reading_of(meter, row, stamp);
  value.mean_kW = row.conversion.mean_kW(row.value * meter.rows.multiplier, meter.step);
  const bool is_rate = row.conversion.is_rate;
  if (meter.rows.stamps == Stamps::start) {
    close_open(meter, stamp);
    meter.open = {value, meter.step, is_rate};
    return;
  }
  const bool holds = is_rate && meter.last && reaches(stamp - *meter.last, meter.step);
  const Instant begin = holds ? *meter.last : stamp - meter.step;
  meter.means->take({begin, stamp}, value, [&](const Reading& one) { pass_on(meter, one); });
}

/// Ends the latest value's span. @param next  Stamp of the next one, if there is one.
void ReadingIntake::close_open(IntakeMeter& meter, std::optional<Instant> next) {
  if (!meter.open) return;
  const auto [value, length, is_rate] = *std::exchange(meter.open, std::nullopt);
  const bool holds = is_rate && next && reaches(*next - value.start, length);
  const Instant end = holds ? *next : value.start + length;
  meter.means->take({value.start, end}, value, [&](const Reading& one) { pass_on(meter, one); });
}

bool ReadingIntake::check_known_years(IntakeMeter& meter, const Row& row, Instant start) {
  const bool is_known = start >= Instant{} + std::chrono::days{366} &&
                        start + meter.report.shown.interval <= metering::kLatestInstant;
  if (!is_known) {
    refuse(row.line, "the interval lies outside " + std::string{metering::kKnownYears}, row.text,
           &meter);
  }
  return is_known;
}

bool ReadingIntake::check_grid(IntakeMeter& meter, const Row& row, Instant start) {
  const MeterInFile& shown = meter.report.shown;
  if ((start.time_since_epoch() - shown.phase) % shown.interval == seconds{0}) return true;
  ++meter.report.off_grid;
  const seconds beside = std::chrono::abs(beside_grid(shown.interval, start));
  const bool is_near = kToleranceShare * beside <= shown.interval && beside > meter.tolerance;
  refuse(
      row.line,
      "meter " + in_quotes(shown.name) + ": " + metering::to_string(start) +
          " is no start of an interval of " + in_words(shown.interval) +
          (is_near ? "; if its stamps are late or early by so little, write grid_tolerance = \"" +
                         std::to_string(beside.count()) + "s\" to its [[meter]]"
                   : ""),
      row.text, &meter);
  return false;
}

/// Reports a row that is not later than the one before.
void ReadingIntake::check_order(IntakeMeter& meter, const Row& row, Instant start) {
  if (!meter.last) return;
  const std::string name = "meter " + in_quotes(meter.report.shown.name) + ": ";
  if (start == start_of(meter, *meter.last)) {
    ++meter.report.duplicates;
    const Reading value = reading_of(meter, row, start);
    const bool has_both = meter.held && std::isfinite(value.mean_kW) &&
                          std::isfinite(meter.held->mean_kW) && meter.held->start == start;
    if (has_both && meter.held->mean_kW != value.mean_kW) ++meter.report.conflicts;
    refuse(row.line,
           name + "interval " + metering::to_string(start) + " comes twice; the first value stays",
           row.text);
  } else if (start < start_of(meter, *meter.newest)) {
    ++meter.report.unsorted;
    refuse(row.line,
           name + metering::to_string(start) +
               " comes after a later interval; the file is not in order of time",
           row.text);
  }
}

void ReadingIntake::keep_sample(IntakeMeter& meter, const Row& row) {
  if (row.conversion.is_rate) {
    refuse(row.line,
           "meter " + in_quotes(meter.rows.name) + " is a counter, but " + in_quotes(meter.unit) +
               " is a power",
           row.text, &meter);
    return;
  }
  // A sample without a value, such as "unavailable", may have been logged late; it says nothing.
  while (!meter.samples.empty() && row.stamp <= meter.samples.back().time &&
         std::isnan(meter.samples.back().value_kWh)) {
    meter.samples.pop_back();
  }
  if (!meter.samples.empty() && row.stamp <= meter.samples.back().time) {
    ++meter.report.unsorted;
    refuse(row.line,
           "meter " + in_quotes(meter.rows.name) +
               ": a counter's samples must be in order of time; this one is kept out",
           row.text, &meter);
    return;
  }
  if (meter.samples.size() < kHeadRows) meter.head.push_back({row, excerpt(row.text)});
  meter.samples.push_back({row.stamp, row.value * row.conversion.factor * meter.rows.multiplier});
}

Result<FileReport> ReadingIntake::end_file(std::string_view name) {
  for (IntakeMeter& meter : meters_) {
    settle(meter);
    const bool follows = 2 * meter.follows >= meter.placed || meter.placed < kHeadRows;
    const bool fits = 2 * meter.left_out <= meter.placed && (follows || meter.is_irregular);
    if (meter.has_earlier_file && !fits) {
      return failure(ErrorCode::malformed,
                     in_quotes(name) + ": meter " + in_quotes(meter.rows.name) +
                         " does not come every " + in_words(meter.report.shown.interval) +
                         " as in the file before; give it a [[meter]] of its own, or bring the "
                         "files to one interval");
    }
    meter.has_earlier_file = meter.has_earlier_file || meter.placed > 0;
    meter.placed = meter.follows = meter.left_out = 0;
    meter.begins_file = true;
  }
  LineIssues none;
  none.listed_max = report_.issues.listed_max;
  return FileReport{std::exchange(report_.issues, std::move(none)),
                    std::exchange(report_.others, {})};
}

/// Passes on the latest values, whose lengths the next one would show.
void ReadingIntake::pass_on_all(IntakeMeter& meter) {
  if (meter.longer) end_longer(meter, meter.longer->stamp + longest_step(meter.report.steps));
  if (meter.held) pass_on(meter, *std::exchange(meter.held, std::nullopt));
  close_open(meter, {});
  if (meter.means) meter.means->finish([&](const Reading& one) { pass_on(meter, one); });
}

/// Passes on what waits.
void ReadingIntake::end_meter(IntakeMeter& meter) {
  if (!meter.grid_known && !meter.refused && !meter.head.empty()) {
    if (meter.rows.counter) {
      finish_counter(meter);
    } else {
      begin_meter(meter);
    }
  }
  settle(meter);
  pass_on_all(meter);
}

ReadingsReport ReadingIntake::finish() {
  for (IntakeMeter& meter : meters_) {
    end_meter(meter);
    if (meter.first_start) {
      meter.report.span =
          metering::TimeSpan{*meter.first_start, *meter.last_start + meter.report.shown.interval};
    }
    report_.readings += meter.report.readings;
    report_.meters.push_back(std::move(meter.report));
  }
  return std::move(report_);
}

/// A register may be logged at any time; its interval is that of its rows, or one that they fill.
bool ReadingIntake::find_register_interval(IntakeMeter& meter) {
  MeterInFile& shown = meter.report.shown;
  shown.interval_inferred = !meter.rows.interval;
  if (meter.rows.interval) {
    shown.interval = *meter.rows.interval;
    return true;
  }
  const auto steps = steps_of(
      stamps_of(meter.samples, kRegisterRows, [](const auto& sample) { return sample.time; }));
  if (!steps) {
    return refuse_meter(meter,
                        "has one time stamp only, so its interval cannot be seen; declare it");
  }
  if (steps->is_regular() && is_interval(steps->commonest)) {
    shown.interval = steps->commonest;
    return true;
  }
  const seconds step =
      steps->is_regular() ? steps->commonest : std::max(steps->median, kRegisterInterval);
  const auto interval = interval_for(step);
  if (interval) {
    shown.interval = *interval;
    return true;
  }
  return refuse_meter(meter,
                      "comes every " + in_words(step) + "; recald needs values of an hour or less");
}

void ReadingIntake::finish_counter(IntakeMeter& meter) {
  if (!find_register_interval(meter)) return;
  const MeterInFile& shown = meter.report.shown;
  if (sink_.on_meter) sink_.on_meter(shown);
  metering::CounterSettings settings = *meter.rows.counter;
  settings.digit_kWh = meter.conversion.factor * meter.rows.multiplier;
  meter.report.stamps_beside = metering::judge_stamps(meter.samples, shown.interval);
  // A register that is read a little after midnight still shows the day before.
  if (settings.resets != metering::Resets::never ||
      meter.report.stamps_beside == metering::StampsBeside::as_grid) {
    metering::put_on_grid(meter.samples, shown.interval);
  }
  const auto samples = metering::with_rests(std::move(meter.samples));
  for (const Reading& reading :
       metering::readings_from_register(shown.meter, samples, shown.interval, settings,
                                        meter.rows.resets, &meter.report.register_notes)) {
    pass_on(meter, reading);
  }
}

}  // namespace recald::csv
