/// Order statistics.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace recald {

/// Linear interpolation between order statistics (type 7 of Hyndman and Fan, 1996, R's default).
/// @param sorted  Ascending, not empty. @pre 0 <= probability <= 1
[[nodiscard]] double quantile_of_sorted(std::span<const double> sorted, double probability);

[[nodiscard]] inline double quantile_of_sorted(const Eigen::VectorXd& sorted, double probability) {
  const std::span<const double> values{sorted.data(), static_cast<std::size_t>(sorted.size())};
  return quantile_of_sorted(values, probability);
}

/// The middle value; of an even number, the mean of the two in the middle. @pre not empty
[[nodiscard]] double median(std::vector<double> values);

}  // namespace recald
