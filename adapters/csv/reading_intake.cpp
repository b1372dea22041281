#include "adapters/csv/reading_intake.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "adapters/csv/fields.hpp"
#include "core/metering/registers/interval_book.hpp"

namespace recald::csv {
namespace {

using metering::Instant;
using metering::Reading;
using std::chrono::seconds;

constexpr std::size_t kHeadRows = 64;  // an interval is inferred from these
constexpr std::size_t kRefusedShown = 3;
constexpr seconds kIntervalMin{60};
constexpr seconds kIntervalMax{3600};
constexpr seconds kOffsetGrid{900};  // the offsets of all zones since 1971 are multiples of it

std::string in_words(seconds span) {
  constexpr std::int64_t kDay = 86'400;
  if (span.count() >= 2 * kDay) return std::to_string(span.count() / kDay) + " days";
  if (span.count() == kDay) return "day";
  return span.count() % 60 == 0 ? std::to_string(span.count() / 60) + " minutes"
                                : std::to_string(span.count()) + " seconds";
}

template <class Key>
Key commonest(const std::map<Key, int>& counts) {
  const auto most =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most->first;
}

/// The commonest step between neighbouring stamps, the smaller of equals. Nothing for fewer than
/// two stamps.
std::optional<seconds> commonest_step(std::vector<Instant> stamps) {
  std::sort(stamps.begin(), stamps.end());
  std::map<seconds, int> counts;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i] > stamps[i - 1]) ++counts[stamps[i] - stamps[i - 1]];
  }
  if (counts.empty()) return {};
  return commonest(counts);
}

std::vector<Instant> stamps_of(const IntakeMeter& meter) {
  std::vector<Instant> stamps;
  for (const auto& head : meter.head) stamps.push_back(head.row.stamp);
  return stamps;
}

}  // namespace

ReadingIntake::ReadingIntake(const ReadingsOptions& options, const ReadingsSink& sink)
    : sink_{sink} {
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

void ReadingIntake::take_first(IntakeMeter& meter, const Row& row) {
  if (meter.refused) return;
  if (meter.rows.counter) return keep_sample(meter, row);
  meter.head.push_back({row, excerpt(row.text)});
  if (meter.head.size() == kHeadRows) begin_meter(meter);
}

/// The first rows show the interval; from here on rows go straight to the sink.
void ReadingIntake::begin_meter(IntakeMeter& meter) {
  if (!find_grid(meter)) {
    meter.refused = true;
  } else {
    set_scale(meter);
    meter.grid_known = true;
    if (sink_.on_meter) sink_.on_meter(meter.report.shown);
    for (auto& [row, text] : meter.head) {
      row.text = text;
      hand_on(meter, row);
    }
  }
  meter.head = {};
}

bool ReadingIntake::find_grid(IntakeMeter& meter) {
  MeterInFile& shown = meter.report.shown;
  shown.interval_inferred = !meter.rows.interval;
  const auto interval =
      meter.rows.interval ? meter.rows.interval : commonest_step(stamps_of(meter));
  const auto& [row, text] = meter.head.front();
  if (!interval) {
    refuse(row.line,
           "meter " + in_quotes(shown.name) +
               " has one time stamp only, so its interval cannot be seen; declare it",
           text, &meter);
    return false;
  }
  if (*interval < kIntervalMin || *interval > kIntervalMax ||
      kIntervalMax % *interval != seconds{0}) {
    refuse(row.line,
           "meter " + in_quotes(shown.name) + " comes every " + in_words(*interval) +
               (*interval > kIntervalMax
                    ? "; recald needs values of an hour or less: ask for the load profile"
                    : "; supported are whole minutes that divide an hour"),
           text, &meter);
    return false;
  }
  shown.interval = *interval;
  std::map<seconds, int> phases;
  for (const auto& head : meter.head) ++phases[head.row.stamp.time_since_epoch() % *interval];
  shown.phase = commonest(phases);
  // A phase that no zone offset explains means a wrong clock; the rows are then refused one by one.
  if (shown.phase % kOffsetGrid != seconds{0}) shown.phase = seconds{0};
  return true;
}

void ReadingIntake::set_scale(IntakeMeter& meter) {
  meter.kW_per_unit = meter.conversion.mean_kW(meter.rows.multiplier, meter.report.shown.interval);
}

/// Handles a row that is not simply the next interval. False: refused.
bool ReadingIntake::check_order(IntakeMeter& meter, const Row& row, Instant start) {
  const MeterInFile& shown = meter.report.shown;
  if (start < Instant{} + std::chrono::days{366} ||
      start + shown.interval > metering::kLatestInstant) {
    refuse(row.line, "the interval lies outside " + std::string{metering::kKnownYears}, row.text,
           &meter);
    return false;
  }
  if ((start.time_since_epoch() - shown.phase) % shown.interval != seconds{0}) {
    ++meter.report.off_grid;
    refuse(row.line,
           "meter " + in_quotes(shown.name) + ": " + metering::to_string(start) +
               " is no start of an interval of " + in_words(shown.interval),
           row.text, &meter);
    return false;
  }
  if (meter.last && start == *meter.last) {
    ++meter.report.duplicates;
    refuse(row.line,
           "meter " + in_quotes(shown.name) + ": interval " + metering::to_string(start) +
               " comes twice; the first value stays",
           row.text);
  } else if (meter.newest && start < *meter.newest) {
    ++meter.report.unsorted;
    refuse(row.line,
           "meter " + in_quotes(shown.name) + ": " + metering::to_string(start) +
               " comes after a later interval; the file is not in order of time",
           row.text);
  }
  if (!meter.earliest || start < *meter.earliest) meter.earliest = start;
  return true;
}

void ReadingIntake::keep_sample(IntakeMeter& meter, const Row& row) {
  if (row.conversion.is_rate) {
    refuse(row.line,
           "meter " + in_quotes(meter.rows.name) + " is a counter, but " + in_quotes(meter.unit) +
               " is a power",
           row.text, &meter);
    return;
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
    const std::uint64_t readings = meter.report.readings - meter.readings_before;
    const bool is_first = meter.readings_before == 0;
    const bool follows = 2 * meter.follows >= readings || readings < kHeadRows;
    if (!is_first && !follows) {
      return failure(ErrorCode::malformed,
                     in_quotes(name) + ": meter " + in_quotes(meter.rows.name) +
                         " does not come every " + in_words(meter.report.shown.interval) +
                         " as in the file before; give it a [[meter]] of its own, or bring the "
                         "files to one interval");
    }
    meter.readings_before = meter.report.readings;
    meter.follows = 0;
    // Another file may begin before this one ends.
    meter.newest_of_all = std::max(meter.newest_of_all, std::exchange(meter.newest, {}));
    meter.last.reset();
  }
  LineIssues none;
  none.listed_max = report_.issues.listed_max;
  return FileReport{std::exchange(report_.issues, std::move(none)),
                    std::exchange(report_.others, {})};
}

ReadingsReport ReadingIntake::finish() {
  for (IntakeMeter& meter : meters_) {
    if (!meter.grid_known && !meter.refused && !meter.head.empty()) {
      if (meter.rows.counter) {
        finish_counter(meter);
      } else {
        begin_meter(meter);
      }
    }
    if (const auto newest = std::max(meter.newest, meter.newest_of_all)) {
      meter.report.span =
          metering::TimeSpan{*meter.earliest, *newest + meter.report.shown.interval};
    }
    report_.readings += meter.report.readings;
    report_.meters.push_back(std::move(meter.report));
  }
  return std::move(report_);
}

void ReadingIntake::finish_counter(IntakeMeter& meter) {
  if (!find_grid(meter)) return;
  MeterInFile& shown = meter.report.shown;
  shown.phase = seconds{0};
  if (sink_.on_meter) sink_.on_meter(shown);
  for (const Reading& reading : metering::readings_from_register(
           shown.meter, meter.samples, shown.interval, *meter.rows.counter)) {
    ++meter.report.readings;
    if (std::isnan(reading.mean_kW)) ++meter.report.blanks;
    if (!meter.earliest) meter.earliest = reading.start;
    meter.newest = reading.start;
    if (sink_.on_reading) sink_.on_reading(reading);
  }
}

}  // namespace recald::csv
