#include "daemon/site/diagnose/held_figures.hpp"

#include <utility>

#include "daemon/site/calibrate/site_calibration.hpp"

namespace recald::daemon {

diagnosis::MonthlyFigures held_figures(const SiteConfig& site, const Recording& recording,
                                       const diagnosis::SiteProblem& problem) {
  using diagnosis::Role;
  diagnosis::MonthlyFigures measured;
  for (assessment::OutputCalibration& output :
       collect_outputs(site, recording, problem.drivers->months)) {
    measured.outputs.push_back(std::move(output.name));
    measured.values.push_back(std::move(output.measured));
  }
  for (std::size_t i = 0; i < problem.month_roles.size(); ++i) {
    const Role role = problem.month_roles[i];
    if (role == Role::fit || role == Role::select) measured.fitted.push_back(i);
    if (role == Role::show) measured.shown.push_back(i);
  }
  return measured;
}

}  // namespace recald::daemon
