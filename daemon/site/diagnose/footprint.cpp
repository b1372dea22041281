#include "daemon/site/diagnose/footprint.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "adapters/csv/readings_csv.hpp"

namespace recald::daemon {
namespace {

using std::chrono::seconds;
constexpr seconds kOneHour{3600};
// What readings do with a repeated interval; a footprint that has one is refused.
constexpr std::string_view kWayOfReadings = "; the first value stays";

Result<void> require_names_apart(const csv::ReadingsOptions& options, const std::string& name) {
  for (auto meter = options.meters.begin(); meter != options.meters.end(); ++meter) {
    if (std::find_if(options.meters.begin(), meter, [&](const csv::MeterRows& other) {
          return other.name == meter->name;
        }) == meter) {
      continue;
    }
    return failure(ErrorCode::invalid_value,
                   fmt::format("two meters of the site's model are called '{}' in their files, so "
                               "{} cannot tell them apart; rename one and set its name_in_file",
                               meter->name, name));
  }
  return {};
}

csv::ReadingsOptions file_options(const SiteConfig& config, const diagnosis::SiteProblem& site) {
  csv::ReadingsOptions options;
  options.add_unlisted_meters = true;  // so that they are reported
  for (const diagnosis::MeterData& meter : site.meters) {
    const MeterConfig& known = config.meters[*config.meter_index(meter.id)];
    options.meters.push_back({.name = known.name_in_file,
                              .utility = known.meter.utility,
                              .stamps = known.stamps,
                              .interval = {},
                              .units = known.units,
                              .multiplier = 1.0,
                              .counter = {}});
  }
  return options;
}

/// What makes the file no footprint of this site; nothing where all is well.
Result<void> check(const csv::ReadingsReport& report, const csv::ReadingsOptions& options,
                   const std::string& name) {
  if (report.meters.size() > options.meters.size()) {
    std::vector<std::string> known;
    for (const csv::MeterRows& meter : options.meters) known.push_back(meter.name);
    return failure(
        ErrorCode::invalid_value,
        fmt::format("{} tells of meter '{}', which the site's model does not have; it "
                    "has {}",
                    name, report.meters[options.meters.size()].shown.name, fmt::join(known, ", ")));
  }
  if (report.issues.total > 0) {
    const csv::LineIssue& first = report.issues.listed.front();
    std::string_view reason = first.reason;
    if (reason.ends_with(kWayOfReadings)) reason.remove_suffix(kWayOfReadings.size());
    return failure(ErrorCode::malformed, fmt::format("{}:{}: {}", name, first.line, reason));
  }
  if (report.readings == 0) {
    return failure(ErrorCode::not_enough_data, fmt::format("{} has no row", name));
  }
  return {};
}

/// An hour known in part would count what is not known as not moved.
Result<void> require_whole_hours(const FootprintHours& hours, const diagnosis::SiteProblem& site,
                                 const csv::ReadingsOptions& options, const std::string& name) {
  const auto whole_s = static_cast<double>(kOneHour.count());
  for (Eigen::Index meter = 0; meter < hours.covered_s().cols(); ++meter) {
    for (Eigen::Index i = 0; i < hours.covered_s().rows(); ++i) {
      const double covered_s = hours.covered_s()(i, meter);
      if (covered_s == 0.0 || covered_s == whole_s) continue;
      return failure(
          ErrorCode::malformed,
          fmt::format(
              "{}: meter '{}' has rows for {:.0f} of the 60 minutes from {}; give each hour "
              "whole, with 0 where nothing changes, or not at all",
              name, options.meters[static_cast<std::size_t>(meter)].name, covered_s / 60.0,
              metering::to_string(site.drivers->hours[static_cast<std::size_t>(i)].start)));
    }
  }
  return {};
}

}  // namespace

FootprintHours::FootprintHours(const diagnosis::SiteProblem& site)
    : drivers_(*site.drivers),
      hours_kW_(Eigen::ArrayXXd::Zero(static_cast<Eigen::Index>(drivers_.hours.size()),
                                      static_cast<Eigen::Index>(site.meters.size()))),
      covered_s_(Eigen::ArrayXXd::Zero(hours_kW_.rows(), hours_kW_.cols())) {}

void FootprintHours::add(Eigen::Index meter, metering::Instant start, seconds length,
                         double mean_kW) {
  const metering::Instant end = start + length;
  auto hour =
      std::ranges::upper_bound(drivers_.hours, start - kOneHour, {}, &model::DriverHour::start);
  for (; hour != drivers_.hours.end() && hour->start < end; ++hour) {
    const seconds overlap = std::min(end, hour->start + kOneHour) - std::max(start, hour->start);
    const auto row = hour - drivers_.hours.begin();
    const auto overlap_s = static_cast<double>(overlap.count());
    hours_kW_(row, meter) += mean_kW * overlap_s / static_cast<double>(kOneHour.count());
    covered_s_(row, meter) += overlap_s;
    meets_site_ = true;
  }
}

Result<Eigen::ArrayXXd> read_footprint(const std::filesystem::path& file, const SiteConfig& config,
                                       const diagnosis::SiteProblem& site) {
  const csv::ReadingsOptions options = file_options(config, site);
  const std::string name = file.filename().string();
  TRY(require_names_apart(options, name));
  FootprintHours hours(site);
  std::vector<seconds> intervals(options.meters.size());
  std::optional<metering::Reading> blank;
  const csv::ReadingsSink sink{.on_meter =
                                   [&](const csv::MeterInFile& shown) {
                                     if (shown.meter < intervals.size())
                                       intervals[shown.meter] = shown.interval;
                                   },
                               .on_reading =
                                   [&](const metering::Reading& reading) {
                                     if (reading.meter >= intervals.size()) return;
                                     if (std::isnan(reading.mean_kW)) {
                                       if (!blank) blank = reading;
                                       return;
                                     }
                                     hours.add(reading.meter, reading.start,
                                               intervals[reading.meter], reading.mean_kW);
                                   }};
  const auto report = TRY(csv::read_readings(file, options, sink));
  TRY(check(report, options, name));
  if (blank) {
    return failure(
        ErrorCode::malformed,
        fmt::format("{}: meter '{}' has no value at {}; write 0 where nothing changes", name,
                    options.meters[blank->meter].name, metering::to_string(blank->start)));
  }
  TRY(require_whole_hours(hours, site, options, name));
  if (!hours.meets_site()) {
    return failure(ErrorCode::not_enough_data,
                   fmt::format("{} tells of no hour within the months of the site's [period] that "
                               "have weather and meters",
                               name));
  }
  return hours.hours_kW();
}

}  // namespace recald::daemon
