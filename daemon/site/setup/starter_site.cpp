#include "daemon/site/setup/starter_site.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

#include "adapters/epw/epw.hpp"
#include "daemon/site/setup/site_file.hpp"
#include "daemon/site/setup/starter_building.hpp"

namespace recald::daemon {
namespace {

using metering::Month;

constexpr double kOffsetsApart_h = 3.5;  // summer time, and zones that lie off their meridian

/// Months that all meters have from end to end.
Result<metering::MonthRange> shared_months(std::span<const SurveyedExport> exports,
                                           const metering::LocalCalendar& calendar) {
  std::optional<metering::MonthRange> shared;
  for (const SurveyedExport& one : exports) {
    for (const SurveyedMeter& meter : one.meters) {
      Month first = calendar.month_of(meter.span.begin);
      if (calendar.month_span(first).begin < meter.span.begin) first = metering::next_month(first);
      Month last = calendar.month_of(meter.span.end);
      if (calendar.month_span(last).end > meter.span.end) last = metering::previous_month(last);
      if (!shared) shared = metering::MonthRange{first, last};
      shared->first = std::max(shared->first, first);
      shared->last = std::min(shared->last, last);
    }
  }
  if (shared && shared->first <= shared->last) return *shared;
  return failure(ErrorCode::not_enough_data,
                 "the meters have no whole month in common, so a model cannot be calibrated; leave "
                 "--use out, or give exports of the same months");
}

/// One meter for each utility: a sum before its parts, otherwise the first.
std::vector<std::pair<std::string, metering::Utility>> modelled_meters(const SiteConfig& site) {
  std::set<std::string> parts;
  for (const MeterConfig& meter : site.meters) {
    for (const SumPart& part : meter.sum_of) parts.insert(part.meter);
  }
  std::vector<std::pair<std::string, metering::Utility>> chosen;
  for (const MeterConfig& config : site.meters) {
    const auto utility = config.meter.utility;
    const bool has_one =
        std::ranges::any_of(chosen, [&](const auto& other) { return other.second == utility; });
    if (has_one || parts.contains(config.meter.id)) continue;
    chosen.emplace_back(config.meter.id, utility);
  }
  return chosen;
}

}  // namespace

Result<std::string> with_starter(std::string text, const SiteConfig& drafted,
                                 std::span<const SurveyedExport> exports,
                                 const metering::LocalCalendar& calendar,
                                 const StarterRequest& request,
                                 const std::filesystem::path& folder) {
  if (request.epw.empty()) {
    if (request.use.empty()) return text;
    return failure(ErrorCode::invalid_value,
                   "a starter model needs the weather: give --epw with a file of the place");
  }
  const auto weather = TRY(epw::read_epw(request.epw));
  const epw::EpwLocation& place = weather.location;
  const double site_h =
      std::chrono::duration<double, std::ratio<3600>>{
          calendar.standard_offset(std::chrono::year{weather.year})}
          .count();
  if (std::abs(place.utc_offset_h - site_h) > kOffsetsApart_h) {
    return failure(
        ErrorCode::invalid_value,
        fmt::format("{} is weather of {}, {} (UTC{:+.0f} h), and the site's time zone is {}; "
                    "give weather of the place, or the site's --timezone",
                    request.epw.string(), place.city, place.country, place.utc_offset_h,
                    calendar.zone_name()));
  }
  const std::string where = fmt::format(
      "latitude_deg = {:.2f}   # of the EPW file: {}, {}\nlongitude_deg = {:.2f}\n"
      "altitude_m = {:.0f}\n",
      place.latitude_deg, place.city, place.country, place.longitude_deg, place.elevation_m);
  const auto end_of_site = text.find("\n[[meter]]");
  text.insert(end_of_site == std::string::npos ? text.size() : end_of_site, where);
  text += fmt::format("\n[weather]\nfile = {}{}\nformat = \"epw\"\n",
                      toml_text(relative_path(request.epw, folder)),
                      weather.typical ? "   # a typical year: give the weather of the months that "
                                        "were metered, or forecasts mean little"
                                      : "");
  if (request.use.empty()) return text;
  const auto zone = TRY(climate_zone_of(weather.series));
  const auto months = TRY(shared_months(exports, calendar));
  const auto model = TRY(starter_model({.use = request.use,
                                        .floor_area_m2 = request.floor_area_m2,
                                        .storeys = request.storeys,
                                        .built = request.built,
                                        .climate_zone = zone,
                                        .months = months,
                                        .meters = modelled_meters(drafted)}));
  return text + "\n" + model;
}

}  // namespace recald::daemon
