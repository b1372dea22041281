#include "daemon/site/model/site_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/display/id_words.hpp"
#include "core/display/warning.hpp"

namespace recald::daemon {
namespace {

using assessment::MonthRole;
using metering::Month;

/// A month whose weather is not known as a whole.
struct PoorMonth {
  Month month;
  double coverage;
};

/// " Sensor 'roof' was silent from …"; empty where there is nothing to say.
std::string silence_in(const SiteWeather& weather, Month month) {
  const auto silence = weather.silence.find(month);
  return silence == weather.silence.end() ? "" : " " + silence->second;
}

/// One warning of all such months. @param of  Months of all periods.
display::Warning poor_weather(const SiteWeather& weather, const std::vector<PoorMonth>& poor,
                              std::size_t of, const char* one, const char* many,
                              std::string details) {
  const auto words = [&](const PoorMonth& one_month) {
    return std::pair{
        display::month_words(metering::to_string(one_month.month)),
        fmt::format("{:.0f} % of its {}", 100.0 * one_month.coverage,
                    display::input_words(least_known_variable(weather, one_month.month)))};
  };
  const auto worst = std::ranges::min_element(poor, {}, &PoorMonth::coverage);
  const auto [month, known] = words(*worst);
  for (const PoorMonth& one_month : poor) {
    const auto [name, share] = words(one_month);
    if (poor.size() > 1) details += fmt::format(" {}: {}.", name, share);
    details += silence_in(weather, one_month.month);
  }
  if (details.starts_with(' ')) details.erase(0, 1);
  return {.sentence = poor.size() == 1
                          ? fmt::format("{} {}: only {} was measured.", month, one, known)
                          : fmt::format("{} of {} months {}, the worst {}: only {} was measured.",
                                        poor.size(), of, many, month, known),
          .details = std::move(details),
          .share = static_cast<double>(poor.size()) / static_cast<double>(of)};
}

}  // namespace

std::vector<Month> SiteMonths::in_order() const {
  std::vector<Month> months = all;
  std::ranges::sort(months);
  const auto repeated = std::ranges::unique(months);
  months.erase(repeated.begin(), repeated.end());
  return months;
}

SiteMonths choose_months(const PeriodConfig& period, const SiteWeather& weather,
                         display::Warnings& warnings) {
  SiteMonths months;
  std::vector<PoorMonth> left_out;
  std::vector<PoorMonth> patchy;
  std::size_t count = 0;
  const auto take = [&](const metering::MonthRange& range, MonthRole role) {
    for (Month month = range.first; month <= range.last; month = metering::next_month(month)) {
      ++count;
      const double coverage = weather_coverage(weather, month);
      const weather::WeatherGrade grade = weather::grade_of(coverage);
      if (grade == weather::WeatherGrade::unknown) {
        left_out.push_back({month, coverage});
        continue;
      }
      if (grade == weather::WeatherGrade::patchy) patchy.push_back({month, coverage});
      months.all.push_back(month);
      months.roles.push_back(role);
      if (role == MonthRole::calibration) months.calibration.push_back(month);
    }
  };
  take(period.calibration, MonthRole::calibration);
  if (period.validation) take(*period.validation, MonthRole::validation);
  if (!left_out.empty()) {
    warnings.push_back(poor_weather(weather, left_out, count, "is left out", "are left out", ""));
  }
  if (!patchy.empty()) {
    warnings.push_back(poor_weather(weather, patchy, count, "has gaps in its weather",
                                    "have gaps in their weather",
                                    "The rest is typical of the month."));
  }
  return months;
}

std::optional<std::size_t> profile_meter(const SiteConfig& site) {
  const auto rank = [&](const MeterConfig& config) {
    if (config.meter.utility != metering::Utility::electricity) return 0;
    const auto counts = [&](model::EndUse use) {
      return !config.end_uses || (*config.end_uses)[use] > 0.0;
    };
    if (!counts(model::EndUse::lighting) && !counts(model::EndUse::plugs)) return 1;
    return site.model->has_output(config.meter.id) ? 3 : 2;
  };
  const auto best = std::ranges::max_element(site.meters, {}, rank);  // the first of equals
  if (best == site.meters.end() || rank(*best) == 0) return std::nullopt;
  return static_cast<std::size_t>(best - site.meters.begin());
}

Result<const MeterRecord*> electricity_meter(const SiteConfig& site, const Recording& recording) {
  if (const auto meter = profile_meter(site)) return &recording.meters[*meter];
  return failure(ErrorCode::not_enough_data,
                 "the model takes lights and plugs from an electricity meter, and the site has "
                 "none; add a [[meter]] with utility = \"electricity\"");
}

std::vector<model::HourlyLoad> loads_of(const MeterRecord& record,
                                        const std::vector<Month>& months) {
  std::vector<model::HourlyLoad> loads;
  for (const Month month : months) {
    const auto found = record.hours.find(month);
    if (found == record.hours.end()) continue;
    loads.insert(loads.end(), found->second.begin(), found->second.end());
  }
  return loads;
}

Result<std::vector<Parameter>> site_parameters(const SiteConfig& site) {
  std::vector<Parameter> chosen;
  for (const ParameterConfig& config : site.model->parameters) {
    const auto definition = TRY(model::find_parameter(config.name));
    auto parameter = TRY(model::make_parameter(*definition, *site.building, config.prior));
    parameter.source = config.source;
    chosen.push_back(std::move(parameter));
  }
  return chosen;
}

namespace {

/// Refuses two meters that both stand for all of a utility: the model would count it twice.
Result<void> require_once(const SiteConfig& site, const std::vector<model::MeterMap>& maps) {
  for (std::size_t i = 0; i < maps.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const std::string& one = site.model->outputs[j];
      const std::string& other = site.model->outputs[i];
      const auto utility = [&](const std::string& id) {
        return site.meters[*site.meter_index(id)].meter.utility;
      };
      if (maps[i] != maps[j] || utility(one) != utility(other)) continue;
      return failure(
          ErrorCode::invalid_value,
          fmt::format("the outputs '{0}' and '{1}' both stand for all {2} of the building, so it "
                      "would count twice; if each meters a part of it, add a [[meter]] with sum_of "
                      "= [\"{0}\", \"{1}\"] and put that among the outputs, or say by 'end_uses' "
                      "what each of them meters",
                      one, other, metering::to_string(utility(one))));
    }
  }
  return {};
}

}  // namespace

Result<std::vector<model::MeterMap>> meter_maps(const SiteConfig& site) {
  std::vector<model::MeterMap> maps;
  for (const std::string& id : site.model->outputs) {
    const MeterConfig& config = site.meters[*site.meter_index(id)];
    if (config.end_uses) {
      maps.push_back(*config.end_uses);
      continue;
    }
    const auto map = model::default_meter_map(config.meter.utility);
    if (!map)
      return failure(map.error().code, fmt::format("meter '{}': {}", id, map.error().message));
    maps.push_back(*map);
  }
  TRY(require_once(site, maps));
  return maps;
}

}  // namespace recald::daemon
