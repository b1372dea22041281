#include "core/assessment/fit_metrics.hpp"

#include <cassert>
#include <cmath>

#include "core/text/number_text.hpp"

namespace recald::assessment {
namespace {

struct Sums {
  double measured = 0.0;
  double excess = 0.0;  // simulated - measured
  double squares = 0.0;
  int n = 0;
};

Result<Sums> sum_up(std::span<const double> measured, std::span<const double> simulated) {
  Sums sums;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (std::isnan(measured[i])) continue;
    if (!std::isfinite(simulated[i])) {
      return failure(ErrorCode::not_finite, "the simulated value of point " +
                                                std::to_string(i + 1) +
                                                " is not finite, so the fit cannot be judged");
    }
    const double excess = simulated[i] - measured[i];
    sums.measured += measured[i];
    sums.excess += excess;
    sums.squares += excess * excess;
    ++sums.n;
  }
  return sums;
}

}  // namespace

Result<FitMetrics> fit_metrics(std::span<const double> measured,
                               std::span<const double> simulated) {
  assert(measured.size() == simulated.size());
  const auto sums = TRY(sum_up(measured, simulated));
  if (sums.n < 2) {
    return failure(ErrorCode::not_enough_data,
                   "NMBE and CV(RMSE) need at least two measured points, but there are " +
                       std::to_string(sums.n));
  }
  const double mean = sums.measured / sums.n;
  if (!(mean > 0.0)) {
    return failure(ErrorCode::invalid_value,
                   "NMBE and CV(RMSE) are relative to the measured mean, which is " +
                       number_text(mean) + " and not positive; check the meter's sign and unit");
  }
  const double degrees_of_freedom = sums.n - 1;  // n - p, p = 1
  const double nmbe = sums.excess / (degrees_of_freedom * mean);
  return FitMetrics{.nmbe_sim_minus_meas = nmbe,
                    .nmbe_g14 = -nmbe,
                    .cvrmse = std::sqrt(sums.squares / degrees_of_freedom) / mean,
                    .n = sums.n};
}

GuidelineVerdict guideline14_verdict(const FitMetrics& metrics, const GuidelineLimits& limits) {
  const double bias = std::abs(metrics.nmbe_sim_minus_meas);
  const bool bias_holds = bias <= limits.nmbe;
  const bool scatter_holds = metrics.cvrmse <= limits.cvrmse;
  const auto against = [](bool holds, double limit) {
    return (holds ? " (limit " : ", above the limit of ") + percent_text(limit) +
           (holds ? ")" : "");
  };
  std::string why = "|NMBE| is " + percent_text(bias) + against(bias_holds, limits.nmbe) +
                    " and CV(RMSE) is " + percent_text(metrics.cvrmse) +
                    against(scatter_holds, limits.cvrmse) + ", by the " + limits.grain +
                    " tolerances of ASHRAE Guideline 14 on " + std::to_string(metrics.n) +
                    " points.";
  return {bias_holds && scatter_holds, std::move(why)};
}

}  // namespace recald::assessment
