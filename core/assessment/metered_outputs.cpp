#include "core/assessment/metered_outputs.hpp"

#include <algorithm>

#include "core/absent.hpp"

namespace recald::assessment {
namespace {

using metering::Month;
using metering::MonthlyFigure;

/// nullptr where the month's figure is missing or must not be calibrated against.
const MonthlyFigure* usable_figure(const MeteredMonths& metered, Month month) {
  const auto found = std::ranges::find(metered.figures, month, &MonthlyFigure::month);
  if (found == metered.figures.end() || !found->usable) return nullptr;
  return metering::is_rescaled(metered.changes, month) ? nullptr : &*found;
}

}  // namespace

OutputCalibration daily_output(const MeteredMonths& metered, const std::vector<Month>& months) {
  OutputCalibration output{.name = metered.id + "_daily_kWh",
                           .meter_id = metered.id,
                           .unit = "kWh/day",
                           .utility = metered.utility,
                           .meter = metered.meter};
  for (const Month month : months) {
    const MonthlyFigure* figure = usable_figure(metered, month);
    output.measured.push_back(figure ? figure->daily_average_kWh : kAbsent);
    output.extra_variances.push_back(figure ? figure->daily_average_variance_kWh2 : 0.0);
  }
  return output;
}

OutputCalibration peak_output(const MeteredMonths& metered, const std::vector<Month>& months) {
  OutputCalibration output{.name = metered.id + "_peak_kW",
                           .meter_id = metered.id,
                           .unit = "kW",
                           .utility = metered.utility,
                           .meter = metered.meter};
  for (const Month month : months) {
    const MonthlyFigure* figure = usable_figure(metered, month);
    output.measured.push_back(figure && figure->peak ? figure->peak->kW : kAbsent);
    output.extra_variances.push_back(0.0);
  }
  return output;
}

}  // namespace recald::assessment
