#include "core/model/prior_from_draws.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace recald {
namespace {

/// A parameter that is known exactly keeps this share of its prior's spread, so that a
/// hypercube can vary it.
constexpr double kLeastShareOfPriorSd = 1e-3;
constexpr int kMomentRounds = 30;
struct DrawMoments {
  double mean;
  double sd;
};

DrawMoments moments_of_draws(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0.0;
  for (const double value : values) mean += value / n;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / n)};
}

}  // namespace

Prior prior_from_draws(const Prior& original, std::span<const double> draws) {
  const bool of_logarithm = std::holds_alternative<LogNormalPrior>(original.distribution());
  std::vector<double> values{draws.begin(), draws.end()};
  if (of_logarithm) {
    for (double& value : values) value = std::log(value);
  }
  const double widest = std::sqrt(original.variance());
  DrawMoments target = moments_of_draws(values);
  const double least = kLeastShareOfPriorSd * (of_logarithm ? 1.0 : widest);
  target.sd = std::max(target.sd, least);
  if (of_logarithm) {
    return LogNormalPrior{std::exp(target.mean), target.sd, original.min(), original.max()};
  }
  // If the support truncates the normal, its moments differ from those of the draws: shift and
  // widen it until they agree closely.
  TruncatedNormalPrior normal{target.mean, target.sd, original.min(), original.max()};
  for (int round = 0; round < kMomentRounds; ++round) {
    const auto cut = Prior::make(normal);
    if (!cut) break;
    TruncatedNormalPrior next = normal;
    next.location += target.mean - cut->mean();
    next.sd = std::min(next.sd * target.sd / std::sqrt(cut->variance()), 3.0 * widest);
    if (!Prior::make(next)) break;
    normal = next;
  }
  return normal;
}

}  // namespace recald
