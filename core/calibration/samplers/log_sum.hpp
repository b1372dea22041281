/// Sums of numbers given by their logarithms.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace recald::calibration {

/// log(exp(a) + exp(b)) without overflow; minus infinity stands for zero.
[[nodiscard]] inline double log_sum(double a, double b) {
  const double larger = std::max(a, b);
  if (std::isinf(larger)) return larger;
  return larger + std::log1p(std::exp(std::min(a, b) - larger));
}

/// log of the sum of exp over all of `logs`, a vector or an expression; not empty.
template <class Derived>
[[nodiscard]] double log_sum(const Eigen::DenseBase<Derived>& logs) {
  const double largest = logs.maxCoeff();
  if (std::isinf(largest)) return largest;
  return largest + std::log((logs.derived().array() - largest).exp().sum());
}

}  // namespace recald::calibration
