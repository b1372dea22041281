#include "core/statistics/expected_maximum.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace recald {
namespace {

// From the largest mean, in sd: the maximum is never lower, and of some thousands never higher. The
// integrand is smooth and flat at both ends, where the trapezoidal rule is exact to many digits.
constexpr double kBelow = 5.0;
constexpr double kAbove = 7.0;
constexpr int kSteps = 48;

}  // namespace

double expected_maximum(std::span<const double> means, double sd) {
  assert(!means.empty() && sd >= 0.0);
  const double largest = *std::ranges::max_element(means);
  if (sd == 0.0) return largest;
  const double low = largest - kBelow * sd;
  const double step = (kBelow + kAbove) * sd / kSteps;
  double integral = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = low + i * step;
    double all_below = 1.0;
    for (const double mean : means) {
      const double u = (x - mean) / sd;
      if (u < kAbove) all_below *= 0.5 * std::erfc(-u / std::numbers::sqrt2);
      if (all_below < 1e-12) break;
    }
    integral += (i == 0 || i == kSteps ? 0.5 : 1.0) * all_below;
  }
  return low + (kBelow + kAbove) * sd - step * integral;
}

}  // namespace recald
