#include "tests/blind/population/twin_gauge.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "daemon/commands/open_site.hpp"
#include "daemon/site/diagnose/footprint.hpp"
#include "daemon/site/model/diagnosis_input.hpp"

namespace recald::blind {

Result<TwinGauge> TwinGauge::open(const std::filesystem::path& site_file) {
  std::ostringstream out;
  std::ostringstream err;
  const auto site = daemon::open_modelled_site(site_file, {out, err, false}, ModelKind::hourly);
  if (!site) return failure(ErrorCode::invalid_value, err.str());
  auto problem = daemon::make_site_problem(site->site.config, site->site.calendar, site->recording,
                                           site->weather);
  if (!problem) return tl::unexpected(problem.error());
  auto twin = std::make_unique<diagnosis::SiteProblem>(std::move(*problem));
  auto gauge = diagnosis::FootprintGauge::calibrate(*twin);
  if (!gauge) return tl::unexpected(gauge.error());
  return TwinGauge(std::move(twin), std::move(*gauge));
}

Result<diagnosis::Detectability> TwinGauge::measure(
    const std::vector<std::vector<double>>& footprint_kW,
    const std::vector<simulators::MeterPlate>& plates,
    const simulators::Recording& recording) const {
  return gauge_.measure(hours_kW(footprint_kW, plates, recording));
}

// s_1' M s_2 = m' M m - h' M h with the mean m and half the difference h.
Result<double> TwinGauge::repeatable(const std::vector<std::vector<double>>& one_kW,
                                     const std::vector<std::vector<double>>& other_kW,
                                     const std::vector<simulators::MeterPlate>& plates,
                                     const simulators::Recording& recording) const {
  const Eigen::ArrayXXd one = hours_kW(one_kW, plates, recording);
  const Eigen::ArrayXXd other = hours_kW(other_kW, plates, recording);
  const auto common = gauge_.measure(0.5 * (one + other));
  if (!common) return tl::unexpected(common.error());
  const auto jitter = gauge_.measure(0.5 * (one - other));
  if (!jitter) return tl::unexpected(jitter.error());
  const double common_d = common->d_star;
  const double jitter_d = jitter->d_star;
  return std::sqrt(std::max(common_d * common_d - jitter_d * jitter_d, 0.0));
}

Eigen::ArrayXXd TwinGauge::hours_kW(const std::vector<std::vector<double>>& footprint_kW,
                                    const std::vector<simulators::MeterPlate>& plates,
                                    const simulators::Recording& recording) const {
  daemon::FootprintHours hours(*twin_);
  for (std::size_t k = 0; k < plates.size(); ++k) {
    const auto meter = std::ranges::find(twin_->meters, plates[k].id, &diagnosis::MeterData::id);
    if (meter == twin_->meters.end()) continue;
    for (std::size_t slot = 0; slot < footprint_kW[k].size(); ++slot) {
      hours.add(meter - twin_->meters.begin(), recording.start_of(slot), simulators::kInterval,
                footprint_kW[k][slot]);
    }
  }
  return hours.hours_kW();
}

}  // namespace recald::blind
