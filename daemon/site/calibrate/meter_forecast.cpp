#include "daemon/site/calibrate/meter_forecast.hpp"

#include <fmt/format.h>

#include <utility>

#include "core/absent.hpp"
#include "core/assessment/given_data.hpp"
#include "core/assessment/metered_outputs.hpp"
#include "core/display/id_words.hpp"
#include "core/display/warning.hpp"
#include "daemon/site/calibrate/yardstick.hpp"
#include "daemon/site/model/site_parts.hpp"

namespace recald::daemon {
namespace {

using metering::Month;

/// Daily averages of every meter.
std::vector<assessment::OutputCalibration> daily_outputs(const SiteConfig& site,
                                                         const Recording& recording,
                                                         const std::vector<Month>& months) {
  std::vector<assessment::OutputCalibration> outputs;
  for (std::size_t meter = 0; meter < site.meters.size(); ++meter) {
    const MeterRecord& record = recording.meters[meter];
    const metering::Meter& described = site.meters[meter].meter;
    outputs.push_back(assessment::daily_output(
        {described.id, meter, described.utility, record.figures, record.level_changes}, months));
    outputs.back().calibrated = false;
  }
  return outputs;
}

}  // namespace

Result<SiteCalibration> forecast_meters(const SiteConfig& site,
                                        const metering::LocalCalendar& calendar,
                                        const Recording& recording, const SiteWeather& weather,
                                        std::string because) {
  SiteCalibration result;
  result.units = site.units;
  result.not_calibrated_because = std::move(because);
  const SiteMonths months = choose_months(*site.period, weather, result.warnings);
  if (months.calibration.empty()) {
    return failure(ErrorCode::not_enough_data,
                   fmt::format("the weather has no temperature in any month from {} to {}; give a "
                               "file that covers them, or change [period]",
                               metering::to_string(site.period->calibration.first),
                               metering::to_string(site.period->calibration.last)));
  }
  take_months(months, result);
  result.outputs = daily_outputs(site, recording, months.all);

  const auto forecasts = yardsticks_of(site, calendar, recording, weather, result);
  std::vector<assessment::OutputCalibration> known;
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    assessment::OutputCalibration& output = result.outputs[k];
    if (!forecasts[k]) {
      result.warnings.push_back({fmt::format(
          "{} has no forecast: too few of its days are usable in the calibration months.",
          display::meter_label(output.meter_id))});
      continue;
    }
    assessment::OutputAssessment& assessed = output.assessment;
    assessed.simulated.assign(result.months.size(), kAbsent);
    assessed.model_weight = 0.0;
    assessed.forecast = assessment::assess_forecasts(output.measured, result.roles, *forecasts[k],
                                                     result.month_days);
    assessed.yardstick = assessed.forecast;
    known.push_back(std::move(output));
  }
  if (known.empty()) {
    return failure(ErrorCode::not_enough_data,
                   "no meter has enough usable days in the calibration months to be regressed on "
                   "temperature; see `recald replay` for what its readings lack");
  }
  result.outputs = std::move(known);
  for (const auto* notes : {&recording.notes, &weather.notes}) {
    display::add_notes(*notes, result.warnings);
  }
  return result;
}

}  // namespace recald::daemon
