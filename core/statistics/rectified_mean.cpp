#include "core/statistics/rectified_mean.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace recald {
namespace {

constexpr double kLeast = -4.0;  // of z/s, where the mean is 7e-6 s

double density(double u) {
  constexpr double kInverseRootTwoPi = 0.3989422804014327;
  return kInverseRootTwoPi * std::exp(-0.5 * u * u);
}

double probability(double u) { return 0.5 * std::erfc(-u / std::numbers::sqrt2); }

}  // namespace

double rectified_mean(double z, double s) {
  assert(s > 0.0);
  const double u = z / s;
  return s * density(u) + z * probability(u);
}

double rectified_slope(double z, double s) {
  assert(s > 0.0);
  return probability(z / s);
}

double rectified_inverse(double y, double s) {
  double low = kLeast * s;
  double high = std::max(y, low);  // the mean is at least z
  if (rectified_mean(low, s) >= y) return low;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (rectified_mean(middle, s) < y ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace recald
