#include "daemon/diagnose/footprint.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "adapters/csv/readings_csv.hpp"

namespace recald::daemon {
namespace {

using std::chrono::seconds;
constexpr seconds kHour{3600};

csv::ReadingsOptions file_options(const SiteConfig& config, const diagnosis::SiteProblem& site) {
  csv::ReadingsOptions options;
  options.add_unlisted_meters = true;  // to be told of them
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
    return failure(ErrorCode::malformed, fmt::format("{}:{}: {}", name, first.line, first.reason));
  }
  if (report.readings == 0) {
    return failure(ErrorCode::not_enough_data, fmt::format("{} has no row", name));
  }
  return {};
}

}  // namespace

FootprintHours::FootprintHours(const diagnosis::SiteProblem& site)
    : drivers_(*site.drivers),
      hours_kW_(Eigen::ArrayXXd::Zero(static_cast<Eigen::Index>(drivers_.hours.size()),
                                      static_cast<Eigen::Index>(site.meters.size()))) {}

void FootprintHours::add(Eigen::Index meter, metering::Instant start, seconds length,
                         double mean_kW) {
  const metering::Instant end = start + length;
  auto hour =
      std::ranges::upper_bound(drivers_.hours, start - kHour, {}, &model::DriverHour::start);
  for (; hour != drivers_.hours.end() && hour->start < end; ++hour) {
    const seconds overlap = std::min(end, hour->start + kHour) - std::max(start, hour->start);
    hours_kW_(hour - drivers_.hours.begin(), meter) +=
        mean_kW * static_cast<double>(overlap.count()) / static_cast<double>(kHour.count());
    meets_site_ = true;
  }
}

Result<Eigen::ArrayXXd> read_footprint(const std::filesystem::path& file, const SiteConfig& config,
                                       const diagnosis::SiteProblem& site) {
  const csv::ReadingsOptions options = file_options(config, site);
  FootprintHours hours(site);
  std::vector<seconds> intervals(options.meters.size());
  const csv::ReadingsSink sink{.on_meter =
                                   [&](const csv::MeterInFile& shown) {
                                     if (shown.meter < intervals.size())
                                       intervals[shown.meter] = shown.interval;
                                   },
                               .on_reading =
                                   [&](const metering::Reading& reading) {
                                     if (reading.meter >= intervals.size()) return;
                                     hours.add(reading.meter, reading.start,
                                               intervals[reading.meter], reading.mean_kW);
                                   }};
  const auto report = csv::read_readings(file, options, sink);
  if (!report) return tl::unexpected(report.error());
  const std::string name = file.filename().string();
  if (auto fine = check(*report, options, name); !fine) return tl::unexpected(fine.error());
  if (!hours.meets_site()) {
    return failure(ErrorCode::not_enough_data,
                   fmt::format("{} tells of no hour within the months of the site's [period] that "
                               "have weather and meters",
                               name));
  }
  return hours.hours_kW();
}

}  // namespace recald::daemon
