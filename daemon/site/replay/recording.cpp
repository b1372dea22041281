#include "daemon/site/replay/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <map>
#include <set>

#include "adapters/table/files/open_rows.hpp"
#include "adapters/table/loads/meter_parts.hpp"
#include "core/absent.hpp"
#include "core/metering/months/series_doubts.hpp"
#include "daemon/site/replay/clock_doubts.hpp"
#include "daemon/site/replay/overlap_merge.hpp"
#include "daemon/site/replay/register_evidence.hpp"

namespace recald::daemon {
namespace {

using metering::ClosedMonth;
using metering::Instant;
using metering::TimeSpan;

metering::ResetTimes resets_of(const MeterConfig& config, const metering::LocalCalendar& site) {
  if (!config.counter) return {};
  const auto own = config.reset_zone.empty()
                       ? site
                       : metering::LocalCalendar::open(config.reset_zone).value_or(site);
  return metering::reset_times(config.counter->resets, own);
}

csv::MeterRows rows_of(const MeterConfig& config, const metering::LocalCalendar& calendar) {
  return {.name = config.name_in_file,
          .utility = config.meter.utility,
          .stamps = config.stamps,
          .interval = config.interval,
          .units = config.units,
          .multiplier = config.multiplier,
          .counter = config.counter,
          .resets = resets_of(config, calendar),
          .grid_tolerance = config.grid_tolerance};
}

/// Meters that are read together from the same files.
struct FileGroup {
  std::vector<std::filesystem::path> files;  ///< In order of time.
  std::optional<table::TableShape> shape;    ///< Absent: recald's own CSV.
  std::vector<std::size_t> meters;
};

/// Ordered by first mention.
std::vector<FileGroup> group_by_files(const SiteConfig& site) {
  std::vector<FileGroup> groups;
  for (std::size_t i = 0; i < site.meters.size(); ++i) {
    const MeterConfig& config = site.meters[i];
    if (config.source != MeterSource::csv) continue;
    std::optional<table::TableShape> shape;
    if (config.table) shape = config.table->shape;
    const auto known = std::ranges::find_if(groups, [&](const FileGroup& group) {
      return group.files == config.files && group.shape == shape;
    });
    if (known != groups.end()) {
      known->meters.push_back(i);
    } else {
      groups.push_back({config.files, std::move(shape), {i}});
    }
  }
  return groups;
}

/// Reads one file of a group into an intake.
class GroupReader {
 public:
  GroupReader(const SiteConfig& site, const FileGroup& group,
              const metering::LocalCalendar& calendar)
      : group_(group), calendar_(calendar), parts_{meters_of(site, group, calendar)} {}

  [[nodiscard]] csv::ReadingsOptions options() const {
    return table::intake_options(parts_.parts());
  }
  [[nodiscard]] table::MeterParts& parts() { return parts_; }

  /// @param notes  What the file's container says about its readings.
  Result<void> read(const std::filesystem::path& file, csv::ReadingIntake& intake,
                    std::vector<std::string>& notes) const {
    if (!group_.shape) return csv::read_readings(file, options(), intake);
    table::ClockFacts facts;
    TRY(table::read_table(file, *group_.shape, parts_.parts(), calendar_, intake, &facts));
    for (const std::string& note : facts.notes) {
      notes.push_back(fmt::format("{}: {}.", file.filename().string(), note));
    }
    const std::string& zone = group_.shape->timezone;
    const auto own =
        zone.empty() ? calendar_ : metering::LocalCalendar::open(zone).value_or(calendar_);
    if (const auto other = other_clock(facts, own)) {
      notes.push_back(
          fmt::format("{}: {}; its clock changes fit {}. If that is its clock, give 'timezone' in "
                      "its [[meter]].",
                      file.filename().string(), other->because, fmt::join(other->zones, ", ")));
    }
    return {};
  }

 private:
  static std::vector<table::TableMeter> meters_of(const SiteConfig& site, const FileGroup& group,
                                                  const metering::LocalCalendar& calendar) {
    std::vector<table::TableMeter> meters;
    for (const std::size_t i : group.meters) {
      const MeterConfig& config = site.meters[i];
      table::TableMeter meter{.rows = rows_of(config, calendar),
                              .column = {},
                              .unit = {},
                              .further_names = config.further_names};
      if (config.table) {
        meter.column = config.table->column;
        meter.unit = config.table->unit;
        meter.further_columns = config.table->further_columns;
      }
      meters.push_back(std::move(meter));
    }
    return meters;
  }

  const FileGroup& group_;
  const metering::LocalCalendar& calendar_;
  table::MeterParts parts_;
};

/// @param recording  Receives the notes and issues of the files.
Result<void> read_group(const SiteConfig& site, const FileGroup& group,
                        const metering::LocalCalendar& calendar, const csv::ReadingsSink& sink,
                        Recording& recording) {
  GroupReader reader{site, group, calendar};
  const csv::ReadingsSink of_parts = reader.parts().sink(sink);
  OverlapMerge merge{reader.parts().parts().size(), of_parts};
  csv::ReadingsSink merged = of_parts;
  const bool may_overlap = group.files.size() > 1;
  if (may_overlap) {
    merged.on_reading = [&](const metering::Reading& reading) { merge.take(reading); };
  }
  csv::ReadingIntake intake{reader.options(), merged};
  for (const std::filesystem::path& file : group.files) {
    TRY(reader.read(file, intake, recording.notes));
    auto issues = TRY(intake.end_file(file.string()));
    merge.end_file();
    recording.files.push_back({file, std::move(issues.issues), std::move(issues.others)});
  }
  csv::ReadingsReport of_intake = intake.finish();
  merge.finish();
  if (merge.corrected() > 0) {
    recording.notes.push_back(fmt::format(
        "{}: of {} intervals that several files have, {} have another value in a later one, which "
        "counts; the order of the files in the site file decides which is later.",
        files_words(group.files), merge.repeated(), merge.corrected()));
  }
  csv::ReadingsReport report = TRY(reader.parts().finish(std::move(of_intake)));
  recording.files.back().issues.append(std::move(report.issues));
  recording.readings += report.readings;
  for (std::size_t k = 0; k < group.meters.size(); ++k) {
    recording.meters[group.meters[k]].rows = std::move(report.meters[k]);
  }
  return {};
}

/// Zeros of a counter are measured, and those that the site file describes are known.
bool expects_zero_runs(const MeterRecord& record) {
  return record.meter.is_counted || record.meter.zero_run_max.has_value();
}

/// What one meter's closed months show besides their figures.
class SlotRecord {
 public:
  void take(const ClosedMonth& closed, MeterRecord& record) {
    const metering::Month month = closed.figure.month;
    record.hours[month] = model::hourly_loads(closed.slots);
    episodes_[month] = metering::find_episodes(closed.slots);
    zero_runs_[month] = metering::find_believed_zero_runs(closed.slots);
    doubts_.take(closed.slots);
  }

  /// @param figures  Of the months that were taken.
  /// @param until    End of the site's record: what has not been read yet is not a gap.
  void describe(const std::vector<metering::MonthlyFigure>& figures,
                const metering::LocalCalendar& calendar, MeterRecord& record,
                Instant until = Instant::max()) const {
    const auto zero_runs = expects_zero_runs(record) ? std::vector<TimeSpan>{} : joined_zero_runs();
    record.findings = metering::describe_data(
        record.meter.id, episodes_until(until, record.meter.interval), zero_runs, figures,
        record.level_changes, record.counts, calendar, record.meter.rated_kW.has_value());
    auto doubts = doubts_.describe(record.meter.id);
    record.series_doubts.clear();
    for (const metering::DataFinding& doubt : doubts) {
      record.series_doubts.push_back(doubt.sentence);
    }
    std::ranges::move(doubts, std::back_inserter(record.findings));
  }

 private:
  [[nodiscard]] std::vector<metering::Episode> joined_episodes() const {
    std::vector<metering::Episode> all;
    for (const auto& [month, episodes] : episodes_) {
      all.insert(all.end(), episodes.begin(), episodes.end());
    }
    return metering::join_episodes(std::move(all));
  }

  [[nodiscard]] std::vector<metering::Episode> episodes_until(Instant until,
                                                              std::chrono::seconds interval) const {
    std::vector<metering::Episode> episodes = joined_episodes();
    std::erase_if(episodes, [&](const metering::Episode& one) { return one.span.begin >= until; });
    for (metering::Episode& one : episodes) {
      if (one.span.end <= until) continue;
      one.span.end = until;
      one.slots =
          static_cast<int>((one.span.length() + interval - std::chrono::seconds{1}) / interval);
    }
    return episodes;
  }

  [[nodiscard]] std::vector<TimeSpan> joined_zero_runs() const {
    std::vector<TimeSpan> all;
    for (const auto& [month, runs] : zero_runs_) {
      for (const TimeSpan& run : runs) {
        if (!all.empty() && all.back().end == run.begin) {
          all.back().end = run.end;
        } else {
          all.push_back(run);
        }
      }
    }
    return all;
  }

  std::map<metering::Month, std::vector<metering::Episode>> episodes_;
  std::map<metering::Month, std::vector<TimeSpan>> zero_runs_;
  metering::SeriesDoubts doubts_;
};

void find_changes(MeterRecord& record) {
  record.level_changes = metering::find_level_changes(
      record.meter.id, record.figures, metering::level_change_options(record.meter.utility));
}

/// Collects the results of closed months.
class Recorder {
 public:
  Recorder(const SiteConfig& site, Recording& recording)
      : recording_(recording), slots_(site.meters.size()) {
    for (const MeterConfig& config : site.meters) {
      recording_.meters.push_back({.meter = config.meter});
    }
  }

  void take(const ClosedMonth& closed) {
    MeterRecord& record = recording_.meters[closed.meter];
    const auto place = std::ranges::lower_bound(record.figures, closed.figure.month, {},
                                                &metering::MonthlyFigure::month);
    if (place != record.figures.end() && place->month == closed.figure.month) {
      *place = closed.figure;
    } else {
      record.figures.insert(place, closed.figure);
    }
    slots_[closed.meter].take(closed, record);
  }

  /// @param until  End of the last reading of any meter.
  void describe(const metering::MonthCloser& closer, const metering::LocalCalendar& calendar,
                Instant until) {
    for (std::size_t i = 0; i < recording_.meters.size(); ++i) {
      MeterRecord& record = recording_.meters[i];
      record.counts = closer.counts(static_cast<std::uint32_t>(i));
      record.meter = closer.meters()[i];
      find_changes(record);
      slots_[i].describe(record.figures, calendar, record, until);
    }
  }

 private:
  Recording& recording_;
  std::vector<SlotRecord> slots_;
};

/// Adds up readings of several meters in the same interval. Meters are read one after the other, so
/// a sum is known only when all have been read.
class Sum {
 public:
  Sum(std::size_t meter, const SiteConfig& site) : meter_(meter) {
    for (const SumPart& part : site.meters[meter].sum_of) {
      signs_[*site.meter_index(part.meter)] = part.sign;
    }
  }

  [[nodiscard]] std::size_t meter() const { return meter_; }

  /// As elsewhere, the first reading of a part in an interval counts.
  void take(std::size_t meter, const metering::Reading& reading) {
    const auto sign = signs_.find(meter);
    if (sign == signs_.end()) return;
    Interval& interval = intervals_[reading.start];
    if (!interval.parts.insert(meter).second) return;
    interval.sum_kW += sign->second * reading.mean_kW;
    if (reading.validity == metering::Validity::scaled) {
      interval.validity = reading.validity;
    } else if (reading.validity != metering::Validity::ok) {
      interval.is_known = false;
    }
  }

  /// Passes on the sums in order of time. An interval is blank if a part is missing or invalid. If
  /// a counter knows a part's total but not its shape, the same holds for the sum.
  void hand_out(const std::function<void(const metering::Reading&)>& sink) const {
    for (const auto& [start, interval] : intervals_) {
      if (interval.parts.size() == signs_.size() && interval.is_known) {
        sink({.start = start, .mean_kW = interval.sum_kW, .validity = interval.validity});
      } else {
        sink({.start = start, .mean_kW = kAbsent});
      }
    }
  }

  /// The grid that all parts share. @pre they are in files with rows of each
  /// @return the grid, or a sentence about two parts that differ
  [[nodiscard]] Result<csv::MeterInFile> grid(const SiteConfig& site,
                                              const Recording& recording) const {
    const std::size_t first = signs_.begin()->first;
    const auto& as_first = recording.meters[first].in_file;
    for (const auto& [part, sign] : signs_) {
      const auto& shown = recording.meters[part].in_file;
      if (shown->interval == as_first->interval && shown->phase == as_first->phase) continue;
      return failure(
          ErrorCode::invalid_value,
          fmt::format("meter '{}' cannot be summed: '{}' reads every {} s and '{}' every "
                      "{} s; bring the files to one interval",
                      site.meters[meter_].meter.id, site.meters[first].meter.id,
                      as_first->interval.count(), site.meters[part].meter.id,
                      shown->interval.count()));
    }
    return *as_first;
  }

 private:
  struct Interval {
    std::set<std::size_t> parts;
    double sum_kW = 0.0;
    bool is_known = true;
    metering::Validity validity = metering::Validity::ok;
  };
  std::size_t meter_;
  std::map<std::size_t, double> signs_;  ///< By meter index of the site.
  std::map<Instant, Interval> intervals_;
};

std::vector<Sum> sums_of_files(const SiteConfig& site) {
  std::vector<Sum> sums;
  for (std::size_t i = 0; i < site.meters.size(); ++i) {
    const MeterConfig& config = site.meters[i];
    const bool is_of_files = config.source == MeterSource::sum && !site.comes_from_store(config);
    if (is_of_files) sums.emplace_back(i, site);
  }
  return sums;
}

/// Reads a meter, or a sum of meters, from the store. @return the number of readings of its meters.
Result<std::uint64_t> for_each_stored(const SiteConfig& site, std::size_t meter,
                                      const TimeSpan& span, LiveReadings& live,
                                      const ReadingSink& sink) {
  if (site.meters[meter].is_stored()) return live.for_each(site.meters[meter], span, sink);
  Sum sum{meter, site};
  for (const SumPart& part : site.meters[meter].sum_of) {
    const std::size_t index = *site.meter_index(part.meter);
    const auto count =
        live.for_each(site.meters[index], span,
                      [&](const metering::Reading& reading) { sum.take(index, reading); });
    if (!count) return count;
  }
  sum.hand_out(sink);
  return std::uint64_t{0};
}

/// @pre all files were read
Result<void> add_sums(const std::vector<Sum>& sums, const SiteConfig& site,
                      const Recording& recording, metering::MonthCloser& closer,
                      const std::function<void(std::size_t, const metering::Reading&)>& take) {
  for (const Sum& sum : sums) {
    const auto grid = TRY(sum.grid(site, recording));
    closer.set_grid(static_cast<std::uint32_t>(sum.meter()), grid.interval, grid.phase);
    sum.hand_out([&](const metering::Reading& reading) { take(sum.meter(), reading); });
  }
  return {};
}

/// Why there are no rows: the refused ones, or else what the file contains instead.
std::string refusal_words(const MeterRecord& record, const FileIssues& file) {
  const bool is_its_own = !record.rows.first_refused.empty();
  const auto& lines = is_its_own ? record.rows.first_refused : file.issues.listed;
  const std::uint64_t total = is_its_own ? record.rows.refused : file.issues.total;
  if (lines.empty()) {
    return file.others.empty() ? "" : "; " + file.others.words();
  }
  std::string words =
      fmt::format("; {} {} refused:", total, total == 1 ? "line was" : "lines were");
  for (std::size_t i = 0; i < std::min<std::size_t>(3, lines.size()); ++i) {
    words += fmt::format("{} line {} \"{}\": {}", i == 0 ? "" : ";", lines[i].line, lines[i].text,
                         lines[i].reason);
  }
  return words;
}

/// Requires rows of each meter that the site expects in a file.
Result<void> require_rows(const SiteConfig& site, const Recording& recording) {
  for (std::size_t i = 0; i < recording.meters.size(); ++i) {
    const MeterConfig& config = site.meters[i];
    if (recording.meters[i].in_file || config.source != MeterSource::csv) continue;
    const auto file = std::ranges::find(recording.files, config.files.front(), &FileIssues::file);
    const std::string names =
        config.files.size() == 1 ? config.files.front().string() : files_words(config.files);
    return failure(ErrorCode::not_enough_data,
                   fmt::format("{} has no usable row of meter '{}'{}", names, config.name_in_file,
                               refusal_words(recording.meters[i], *file)));
  }
  return {};
}

void add_warning(MeterRecord& record, std::string sentence, const TimeSpan& span = {}) {
  record.findings.push_back(
      {record.meter.id, std::move(sentence), span, 0, metering::DataFinding::Grade::warning});
}

/// Amounts that never fall are probably the readings of a cumulative register.
void doubt_amounts(const RegisterEvidence& evidence, const MeterConfig& config,
                   const metering::LocalCalendar& calendar, MeterRecord& record) {
  if (record.meter.is_counted || !record.in_file) return;
  const auto unit = metering::find_unit(record.in_file->unit, record.meter.utility, config.units);
  if (unit && unit->is_rate) return;
  const RegisterVerdict verdict = evidence.verdict(calendar);
  if (!verdict.is_register) return;
  const std::string_view resets = verdict.resets == metering::Resets::daily ? ", resets = \"day\""
                                  : verdict.resets == metering::Resets::monthly
                                      ? ", resets = \"month\""
                                      : "";
  record.doubt = fmt::format(
      "The values {}, as those of a cumulative register; if it is one, add rated_kW = {} and "
      "counter = {{ unit = \"kWh\"{} }}{} to its [[meter]].",
      verdict.runs_back ? "move far in small steps" : "hardly ever fall", verdict.rated_kW, resets,
      verdict.runs_back ? " and negative_is_valid = true" : "");
  add_warning(record, record.doubt);
}

/// What a register did besides counting. A bounce has cost nothing.
void describe_register(const metering::LocalCalendar& calendar, MeterRecord& record) {
  using metering::CounterEvent;
  using metering::StampsBeside;
  if (record.rows.stamps_beside == StampsBeside::as_grid) {
    record.findings.push_back(
        {record.meter.id,
         "Its stamps lie some seconds beside its intervals, but its energy rises with these: "
         "readings count at the full interval.",
         {},
         0});
  } else if (record.rows.stamps_beside == StampsBeside::unclear) {
    add_warning(record,
                "Its stamps lie some seconds beside its intervals, and its energy does not show "
                "whether it was read then or at the full interval; a peak may be off by that share "
                "of an interval.");
  }
  for (const metering::RegisterNote& note : record.rows.register_notes) {
    const auto& [event, before, after] = note;
    const std::string day = metering::to_string(calendar.local_time(after.time).date);
    const std::string from_to =
        fmt::format("from {:.1f} to {:.1f} kWh", before.value_kWh, after.value_kWh);
    const TimeSpan span{before.time, after.time};
    if (event == CounterEvent::reset) {
      add_warning(
          record,
          fmt::format("Its register fell on {} {} and went on from there: exchanged, or set "
                      "to zero. Nothing is counted across that.",
                      day, from_to),
          span);
    } else if (event == CounterEvent::jump) {
      add_warning(record,
                  fmt::format("Its register rose on {} {}, by more than its load can use, and went "
                              "on from there: exchanged. The rise is not counted.",
                              day, from_to),
                  span);
    } else if (event == CounterEvent::caught_up) {
      add_warning(record,
                  fmt::format("Its register stood still until {} and then rose at once {}: it had "
                              "counted meanwhile, so the rise is distributed over the standstill.",
                              day, from_to),
                  span);
    } else if (event == CounterEvent::no_total || event == CounterEvent::erratic) {
      add_warning(record,
                  fmt::format("Its register contradicts itself on {} ({}): it is no total, or "
                              "rated_kW is too low.",
                              day, from_to),
                  span);
    }
  }
}

/// What its rows show beside their values.
void describe_rows(MeterRecord& record) {
  if (!record.in_file) return;
  for (const std::string& sentence :
       csv::step_sentences(record.rows.steps, record.in_file->interval)) {
    add_warning(record, sentence);
  }
}

constexpr TimeSpan kAllTime{Instant{}, metering::kLatestInstant};

TimeSpan asked_span(const ReplayOptions& options, const metering::LocalCalendar& calendar) {
  TimeSpan span{Instant::min(), Instant::max()};
  if (options.from) span.begin = calendar.day_span(*options.from).begin;
  if (options.to) span.end = calendar.day_span(*options.to).end;
  return span;
}

/// The daemon closes the months of the parts, not of the sum, since peaks do not add up.
Result<std::vector<metering::MonthlyFigure>> months_of_sum(const SiteConfig& site,
                                                           std::size_t meter,
                                                           const metering::LocalCalendar& calendar,
                                                           LiveReadings& live) {
  std::map<metering::Month, metering::MonthlyFigure> latest;
  metering::MonthCloser closer{
      calendar, {site.meters[meter].meter}, site.closing, [&](ClosedMonth&& closed) {
        latest[closed.figure.month] = std::move(closed.figure);
      }};
  TRY(for_each_stored(site, meter, kAllTime, live, [&](metering::Reading reading) {
    reading.meter = 0;
    closer.add(reading);
  }));
  closer.finish();
  std::vector<metering::MonthlyFigure> figures;
  for (auto& [month, figure] : latest) figures.push_back(std::move(figure));
  return figures;
}

}  // namespace

bool is_site_different(const Recording& recording, metering::Month month) {
  return std::ranges::any_of(recording.meters, [&](const MeterRecord& record) {
    return metering::is_different(record.level_changes, month);
  });
}

bool has_stored_meters(const SiteConfig& site) {
  return std::ranges::any_of(site.meters, &MeterConfig::is_stored);
}

Result<Recording> replay_meters(const SiteConfig& site, const metering::LocalCalendar& calendar,
                                const ReplayOptions& options, VirtualClock& clock,
                                const OnMonthClosed& on_month_closed, LiveReadings* live) {
  Recording recording;
  Recorder recorder{site, recording};
  std::vector<metering::Meter> meters;
  for (const MeterConfig& config : site.meters) meters.push_back(config.meter);
  metering::MonthCloser closer{calendar, meters, site.closing, [&](ClosedMonth&& closed) {
                                 recorder.take(closed);
                                 if (!on_month_closed) return;
                                 on_month_closed(meters[closed.meter], closed.figure, clock.now());
                               }};
  const TimeSpan asked = asked_span(options, calendar);
  std::vector<Sum> sums = sums_of_files(site);
  Instant last_end = Instant::min();
  const auto take = [&](std::size_t meter, const metering::Reading& reading) {
    if (!asked.contains(reading.start)) return;
    metering::Reading placed = reading;
    placed.meter = static_cast<std::uint32_t>(meter);
    clock.advance_to(placed.start + closer.meters()[placed.meter].interval);
    if (!std::isnan(placed.mean_kW)) {
      last_end = std::max(last_end, placed.start + closer.meters()[placed.meter].interval);
    }
    closer.add(placed);
  };

  std::vector<RegisterEvidence> evidence(site.meters.size());
  for (const FileGroup& group : group_by_files(site)) {
    const std::vector<std::size_t>& indices = group.meters;
    const csv::ReadingsSink sink{
        .on_meter =
            [&](const csv::MeterInFile& shown) {
              const std::size_t i = indices[shown.meter];
              closer.set_grid(static_cast<std::uint32_t>(i), shown.interval, shown.phase);
              recording.meters[i].in_file = shown;
            },
        .on_reading =
            [&](const metering::Reading& reading) {
              take(indices[reading.meter], reading);
              const auto interval = closer.meters()[indices[reading.meter]].interval;
              evidence[indices[reading.meter]].take(reading.start,
                                                    reading.mean_kW * metering::in_hours(interval));
              for (Sum& sum : sums) sum.take(indices[reading.meter], reading);
            }};
    TRY(read_group(site, group, calendar, sink, recording));
  }
  TRY(require_rows(site, recording));
  for (std::size_t i = 0; i < site.meters.size(); ++i) {
    if (live == nullptr || !site.comes_from_store(site.meters[i])) continue;
    const auto count = TRY(for_each_stored(
        site, i, kAllTime, *live, [&](const metering::Reading& reading) { take(i, reading); }));
    recording.readings += count;
  }
  TRY(add_sums(sums, site, recording, closer, take));
  // A meter that was added today has no readings yet; the others must still be read.
  if (live != nullptr && recording.readings == 0) {
    return failure(ErrorCode::not_enough_data,
                   fmt::format("the store has no reading of any meter of {} yet", site.id));
  }
  closer.finish();
  recorder.describe(closer, calendar, last_end);
  for (std::size_t i = 0; i < evidence.size(); ++i) {
    doubt_amounts(evidence[i], site.meters[i], calendar, recording.meters[i]);
    describe_register(calendar, recording.meters[i]);
    describe_rows(recording.meters[i]);
  }
  return recording;
}

Result<void> take_closed_months(const SiteConfig& site, const metering::LocalCalendar& calendar,
                                LiveReadings& live, Recording& recording) {
  for (std::size_t i = 0; i < site.meters.size(); ++i) {
    const MeterConfig& config = site.meters[i];
    if (!site.comes_from_store(config)) continue;
    MeterRecord& record = recording.meters[i];
    if (config.source == MeterSource::sum) {
      record.figures = TRY(months_of_sum(site, i, calendar, live));
      find_changes(record);
      continue;
    }
    record.figures = TRY(live.months(config));
    find_changes(record);
    const auto waiting = TRY(live.waiting_months(config));
    if (waiting == 0) continue;
    recording.notes.push_back(fmt::format(
        "{} closed month{} of '{}' {} to be closed anew, after late readings or a change of the "
        "rules; until `recald run` has done so, the figures are those from before.",
        waiting, waiting == 1 ? "" : "s", config.meter.id, waiting == 1 ? "waits" : "wait"));
  }
  return {};
}

Result<void> take_hours(const SiteConfig& site, const metering::LocalCalendar& calendar,
                        const metering::MonthRange& months, LiveReadings& live,
                        Recording& recording) {
  metering::CloserOptions options = site.closing;
  options.period = months;
  const TimeSpan span = metering::span_judged_by(months, calendar);
  for (std::size_t i = 0; i < site.meters.size(); ++i) {
    const MeterConfig& config = site.meters[i];
    if (!site.comes_from_store(config)) continue;
    MeterRecord& record = recording.meters[i];
    SlotRecord slots;
    std::vector<metering::MonthlyFigure> figures;
    metering::MonthCloser closer{calendar, {config.meter}, options, [&](ClosedMonth&& closed) {
                                   const metering::Month month = closed.figure.month;
                                   if (month < months.first || months.last < month) return;
                                   slots.take(closed, record);
                                 }};
    const auto count = TRY(for_each_stored(site, i, span, live, [&](metering::Reading reading) {
      reading.meter = 0;
      closer.add(reading);
    }));
    recording.readings += count;
    closer.finish();
    record.counts = closer.counts(0);
    std::ranges::copy_if(record.figures, std::back_inserter(figures), [&](const auto& figure) {
      return months.first <= figure.month && figure.month <= months.last;
    });
    slots.describe(figures, calendar, record);
  }
  return {};
}

}  // namespace recald::daemon
