#include "core/population/learned_prior.hpp"

#include <algorithm>
#include <cmath>

namespace recald::population {
namespace {

constexpr double kTail = 0.05;
constexpr int kSteps = 60;  // of iterations that gain a digit in a few

/// The predictive in the parameter's own unit.
struct Predictive {
  double q05;
  double q50;
  double q95;
  double variance;
};

Predictive predictive_of(const Population& population, const Prior& own) {
  const auto value = [&](double probability) {
    return own.at_score(population.quantile(probability)).value;
  };
  constexpr int kValues = 400;
  double sum = 0.0;
  double squares = 0.0;
  const double middle = value(0.5);
  for (int i = 0; i < kValues; ++i) {
    const double distance = value((i + 0.5) / kValues) - middle;
    sum += distance;
    squares += distance * distance;
  }
  const double mean = sum / kValues;
  return {value(kTail), middle, value(1.0 - kTail), squares / kValues - mean * mean};
}

/// The triangle of this mode whose tails beyond q05 and q95 hold 5 % each. With r its base, the
/// lower tail is x^2 / (r (x + mode - q05)) of it, x = q05 - min; the upper one likewise.
TriangularPrior with_tails(const Predictive& of, double mode) {
  const auto tail = [](double base, double from_mode) {
    const double half = 0.5 * kTail * base;
    return half + std::sqrt(half * half + 2.0 * half * from_mode);
  };
  const double below = mode - of.q05;
  const double above = of.q95 - mode;
  double base = of.q95 - of.q05;
  for (int i = 0; i < kSteps; ++i) {
    base = of.q95 - of.q05 + tail(base, below) + tail(base, above);
  }
  return {of.q05 - tail(base, below), mode, of.q95 + tail(base, above)};
}

TriangularPrior between_ends(TriangularPrior prior, const Prior& own) {
  prior.min = std::max(prior.min, own.min());
  prior.max = std::min(prior.max, own.max());
  return prior;
}

}  // namespace

Prior learned_prior(const Population& population, const Prior& own) {
  const Predictive wanted = predictive_of(population, own);
  // The further up the mode, the less lies below the median.
  double low = wanted.q05;
  double high = wanted.q95;
  for (int i = 0; i < kSteps; ++i) {
    const double mode = 0.5 * (low + high);
    const Prior tried(between_ends(with_tails(wanted, mode), own));
    (tried.cumulative(wanted.q50) > 0.5 ? low : high) = mode;
  }
  TriangularPrior learned = between_ends(with_tails(wanted, 0.5 * (low + high)), own);
  for (int i = 0; i < kSteps && Prior(learned).variance() < wanted.variance; ++i) {
    constexpr double kWider = 0.05;
    learned.min -= kWider * (learned.mode - learned.min);
    learned.max += kWider * (learned.max - learned.mode);
    learned = between_ends(learned, own);
  }
  return Prior(learned).variance() < wanted.variance ? own : Prior(learned);
}

}  // namespace recald::population
