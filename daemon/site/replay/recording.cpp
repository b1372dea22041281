#include "daemon/site/replay/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace recald::daemon {
namespace {

using metering::ClosedMonth;
using metering::Instant;
using metering::TimeSpan;

/// Files in order of first mention, each with the meters that it holds.
std::vector<std::pair<std::filesystem::path, std::vector<std::size_t>>> group_by_file(
    const SiteConfig& site) {
  std::vector<std::pair<std::filesystem::path, std::vector<std::size_t>>> groups;
  for (std::size_t i = 0; i < site.meters.size(); ++i) {
    if (site.meters[i].is_stored()) continue;
    const auto& file = site.meters[i].file;
    const auto known =
        std::ranges::find(groups, file, [](const auto& group) { return group.first; });
    if (known != groups.end()) {
      known->second.push_back(i);
    } else {
      groups.push_back({file, {i}});
    }
  }
  return groups;
}

csv::ReadingsOptions file_options(const SiteConfig& site, const std::vector<std::size_t>& meters) {
  csv::ReadingsOptions options;
  for (const std::size_t i : meters) {
    const MeterConfig& config = site.meters[i];
    options.meters.push_back({.name = config.name_in_file,
                              .utility = config.meter.utility,
                              .stamps = config.stamps,
                              .interval = config.interval,
                              .units = config.units,
                              .multiplier = config.multiplier,
                              .counter = config.counter});
  }
  return options;
}

/// Collects what closed months leave behind.
class Recorder {
 public:
  Recorder(const SiteConfig& site, Recording& recording)
      : recording_(recording), episodes_(site.meters.size()), zero_runs_(site.meters.size()) {
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
    record.hours[closed.figure.month] = profile::hourly_loads(closed.slots);
    episodes_[closed.meter][closed.figure.month] = metering::find_episodes(closed.slots);
    zero_runs_[closed.meter][closed.figure.month] = metering::find_believed_zero_runs(closed.slots);
  }

  void describe(const metering::MonthCloser& closer, const metering::LocalCalendar& calendar) {
    for (std::size_t i = 0; i < recording_.meters.size(); ++i) {
      MeterRecord& record = recording_.meters[i];
      record.counts = closer.counts(static_cast<std::uint32_t>(i));
      record.meter = closer.meters()[i];
      record.level_changes = metering::find_level_changes(
          record.meter.id, record.figures, metering::level_change_options(record.meter.utility));
      record.findings =
          metering::describe_data(record.meter.id, joined_episodes(i), joined_zero_runs(i),
                                  record.figures, record.level_changes, record.counts, calendar);
    }
  }

 private:
  [[nodiscard]] std::vector<metering::Episode> joined_episodes(std::size_t meter) const {
    std::vector<metering::Episode> all;
    for (const auto& [month, episodes] : episodes_[meter]) {
      all.insert(all.end(), episodes.begin(), episodes.end());
    }
    return metering::join_episodes(std::move(all));
  }

  [[nodiscard]] std::vector<TimeSpan> joined_zero_runs(std::size_t meter) const {
    std::vector<TimeSpan> all;
    for (const auto& [month, runs] : zero_runs_[meter]) {
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

  Recording& recording_;
  std::vector<std::map<metering::Month, std::vector<metering::Episode>>> episodes_;
  std::vector<std::map<metering::Month, std::vector<TimeSpan>>> zero_runs_;
};

TimeSpan asked_span(const ReplayOptions& options, const metering::LocalCalendar& calendar) {
  TimeSpan span{Instant::min(), Instant::max()};
  if (options.from) span.begin = calendar.day_span(*options.from).begin;
  if (options.to) span.end = calendar.day_span(*options.to).end;
  return span;
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
  assert((live != nullptr || !has_stored_meters(site)) &&
         "stored meters need a store to read from");
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
  const auto take = [&](std::size_t meter, const metering::Reading& reading) {
    if (!asked.contains(reading.start)) return;
    metering::Reading placed = reading;
    placed.meter = static_cast<std::uint32_t>(meter);
    clock.advance_to(placed.start + closer.meters()[placed.meter].interval);
    closer.add(placed);
  };

  for (const auto& [file, indices] : group_by_file(site)) {
    const csv::ReadingsSink sink{
        .on_meter =
            [&](const csv::MeterInFile& shown) {
              const std::size_t i = indices[shown.meter];
              closer.set_grid(static_cast<std::uint32_t>(i), shown.interval, shown.phase);
              recording.meters[i].in_file = shown;
            },
        .on_reading =
            [&](const metering::Reading& reading) { take(indices[reading.meter], reading); }};
    auto report = csv::read_readings(file, file_options(site, indices), sink);
    if (!report) return tl::unexpected(report.error());
    recording.readings += report->readings;
    for (std::size_t k = 0; k < indices.size(); ++k) {
      recording.meters[indices[k]].rows = report->meters[k];
    }
    recording.files.push_back({file, std::move(report->issues)});
  }
  for (std::size_t i = 0; i < site.meters.size(); ++i) {
    const MeterConfig& config = site.meters[i];
    if (!config.is_stored()) continue;
    const auto count =
        live->for_each(config, [&](const metering::Reading& reading) { take(i, reading); });
    if (!count) return tl::unexpected(count.error());
    recording.readings += *count;
  }
  // One that was added today says nothing yet; that must not stop what the others tell.
  if (has_stored_meters(site) && recording.readings == 0) {
    return failure(ErrorCode::not_enough_data,
                   fmt::format("the store has no reading of any meter of {} yet", site.id));
  }
  closer.finish();
  recorder.describe(closer, calendar);

  for (std::size_t i = 0; i < recording.meters.size(); ++i) {
    if (recording.meters[i].in_file || site.meters[i].is_stored()) continue;
    return failure(ErrorCode::not_enough_data,
                   fmt::format("{} has no usable row of meter '{}'; check the meter column, or set "
                               "name_in_file",
                               site.meters[i].file.string(), site.meters[i].name_in_file));
  }
  return recording;
}

}  // namespace recald::daemon
