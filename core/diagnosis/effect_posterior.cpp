#include "core/diagnosis/effect_posterior.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/statistics/quantile.hpp"

namespace recald::diagnosis {
namespace {

constexpr double kScoreAt95 = 1.6448536269514722;  // standard normal quantile of 0.95

}  // namespace

std::vector<ParameterPosterior> posterior_of(const Addition& addition) {
  assert(!addition.draws.empty());
  std::vector<ParameterPosterior> list;
  for (std::size_t j = 0; j < addition.candidate.parameters.size(); ++j) {
    const EffectParameter& p = addition.candidate.parameters[j];
    std::vector<double> sorted;
    for (const std::vector<double>& draw : addition.draws) sorted.push_back(draw[j]);
    std::ranges::sort(sorted);
    list.push_back({.name = p.name,
                    .unit = p.unit,
                    .mode = addition.eta[j],
                    .sd = addition.eta_sd[j],
                    .q05 = quantile_of_sorted(sorted, 0.05),
                    .q50 = quantile_of_sorted(sorted, 0.5),
                    .q95 = quantile_of_sorted(sorted, 0.95)});
  }
  return list;
}

std::vector<ParameterPosterior> posterior_of(const Candidate& candidate, const JointFit& fit) {
  std::vector<ParameterPosterior> list;
  const auto first =
      fit.scores.size() - static_cast<Eigen::Index>(candidate.parameters.size());  // after theta
  for (std::size_t j = 0; j < candidate.parameters.size(); ++j) {
    const EffectParameter& p = candidate.parameters[j];
    const Eigen::Index at = first + static_cast<Eigen::Index>(j);
    const double score = fit.scores[at];
    const double spread = std::sqrt(std::max(fit.posterior.covariance(at, at), 0.0));
    const ScoredValue middle = p.prior.at_score(score);
    const double low = p.prior.at_score(score - kScoreAt95 * spread).value;
    const double high = p.prior.at_score(score + kScoreAt95 * spread).value;
    list.push_back({.name = p.name,
                    .unit = p.unit,
                    .mode = fit.eta[j],
                    .sd = std::abs(middle.derivative) * spread,
                    .q05 = low,
                    .q50 = middle.value,
                    .q95 = high});
  }
  return list;
}

metering::Day day_after(const SiteProblem& site, double days) {
  const std::chrono::sys_days first{site.drivers->hours.front().date};
  return metering::Day{first + std::chrono::days{static_cast<int>(std::lround(days))}};
}

}  // namespace recald::diagnosis
