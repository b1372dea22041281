#include "core/assessment/pooled_forecasts.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace recald::assessment {
namespace {

constexpr int kRounds = 200;
constexpr double kLeast = 1e-9;  // a weight of zero could not grow again

Forecast mixture(const Forecast& a, const Forecast& b, double weight) {
  Forecast both;
  const Eigen::Index n = a.means.size() + b.means.size();
  both.means.resize(n);
  both.means << a.means, b.means;
  both.sds.resize(n);
  both.sds << a.sds, b.sds;
  both.weights.resize(n);
  both.weights << weight * a.weights, (1.0 - weight) * b.weights;
  return both;
}

std::optional<Forecast> pooled(const std::optional<Forecast>& a, const std::optional<Forecast>& b,
                               double weight) {
  if (a && b) return mixture(*a, *b, weight);
  return a ? a : b;
}

}  // namespace

double stacking_weight(std::span<const double> log_a, std::span<const double> log_b) {
  assert(log_a.size() == log_b.size());
  double weight = 0.5;
  // Expectation and maximisation: who is likelier to have made each month, then the mean of that.
  for (int round = 0; round < kRounds && !log_a.empty(); ++round) {
    double of_a = 0.0;
    for (std::size_t i = 0; i < log_a.size(); ++i) {
      of_a += 1.0 / (1.0 + (1.0 - weight) / weight * std::exp(log_b[i] - log_a[i]));
    }
    weight = std::clamp(of_a / static_cast<double>(log_a.size()), kLeast, 1.0 - kLeast);
  }
  return weight;
}

OutputForecasts pool(const OutputForecasts& model, const OutputForecasts& days,
                     std::span<const double> measured, double& weight) {
  std::vector<double> log_model;
  std::vector<double> log_days;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (std::isnan(measured[i]) || !model.blocks[i] || !days.blocks[i]) continue;
    log_model.push_back(log_density(*model.blocks[i], measured[i]));
    log_days.push_back(log_density(*days.blocks[i], measured[i]));
  }
  weight = stacking_weight(log_model, log_days);
  OutputForecasts both = model;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    both.months[i] = pooled(model.months[i], days.months[i], weight);
    both.blocks[i] = pooled(model.blocks[i], days.blocks[i], weight);
  }
  both.unseen_mean = pooled(model.unseen_mean, days.unseen_mean, weight);
  return both;
}

}  // namespace recald::assessment
