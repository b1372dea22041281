/// A quantity that is known by draws, such as what a measure saves, in the numbers that people take
/// along.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace recald::savings {

/// In the unit of the draws.
struct Estimate {
  double mean;
  double q05;
  double q50;
  double q95;
  double probability_of_saving;  ///< Probability that it is more than nothing.
};

/// @param draws  At least one, finite.
[[nodiscard]] Estimate estimate_of(const Eigen::VectorXd& draws);

/// The same in another unit. @pre factor > 0
[[nodiscard]] Estimate scaled(const Estimate& estimate, double factor);

/// Of a normal. @pre sd > 0
[[nodiscard]] Estimate normal_estimate(double mean, double sd);

/// Years until a cost is saved, without interest. Absent: it never is.
struct Payback {
  std::optional<double> q05_years;
  std::optional<double> q50_years;
  std::optional<double> q95_years;
};

/// @param cost          Money, once; >= 0.
/// @param money_a_year  What is saved.
[[nodiscard]] Payback simple_payback(double cost, const Estimate& money_a_year);

}  // namespace recald::savings
