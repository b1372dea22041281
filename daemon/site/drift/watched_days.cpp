#include "daemon/site/drift/watched_days.hpp"

#include <algorithm>

#include "core/assessment/assessed_calibration.hpp"
#include "core/diagnosis/evidence/site_problem.hpp"
#include "core/drift/watch/watched_days.hpp"
#include "daemon/site/model/diagnosis_input.hpp"

namespace recald::daemon {
Result<std::vector<std::vector<drift::WatchedDay>>> watched_days(
    const ModelledSite& modelled, const std::vector<FollowedMeter>& meters,
    const std::vector<std::string>& months, int learning_months) {
  const auto last =
      TRY(metering::parse_month(months[static_cast<std::size_t>(learning_months) - 1]));
  const auto problem = TRY(make_site_problem(modelled.site.config, modelled.site.calendar,
                                             modelled.recording, modelled.weather, last));
  diagnosis::Predictor predictor{problem};
  predictor.parts_kW(prior_modes(problem.parameters));

  const drift::DayFrame frame = drift::frame_of(*problem.drivers, months);
  std::vector<std::vector<drift::WatchedDay>> all;
  for (const FollowedMeter& meter : meters) {
    const auto found = std::ranges::find(problem.meters, meter.meter, &diagnosis::MeterData::id);
    if (found == problem.meters.end()) {
      all.emplace_back();
      continue;
    }
    const auto column = found - problem.meters.begin();
    all.push_back(drift::days_of(frame, meter.measured, problem.measured_kW.col(column),
                                 predictor.hours_kW().col(column)));
  }
  return all;
}

}  // namespace recald::daemon
