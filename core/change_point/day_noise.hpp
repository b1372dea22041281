/// How days scatter about what is expected of them: by level, over time, and outliers among them.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace recald::change_point {

/// Standard deviation of a day as a function of its expected level: heat meters scatter in winter
/// and hardly in summer. Piecewise linear between groups of at least 40 days of similar level,
/// constant beyond the outer ones.
class ScatterByLevel {
 public:
  ScatterByLevel() = default;  ///< No scatter at any level.

  /// Within each group Huber's proposal 2, which outliers move little.
  /// @param levels_kWh     (n) expected, any order. @param residuals_kWh  (n) n >= 1.
  /// @param least_sd_kWh   No scatter is below it; > 0.
  /// @see   Huber (1964), Ann. Math. Stat. 35(1), section 10.
  ScatterByLevel(std::span<const double> levels_kWh, std::span<const double> residuals_kWh,
                 double least_sd_kWh);

  [[nodiscard]] double at(double level_kWh) const;

 private:
  struct Node {
    double level;
    double sd;
  };
  std::vector<Node> nodes_{{0.0, 0.0}};  ///< Ascending levels, at least one.
};

/// Weight of a day `standardised` sd off: 1 up to 3 sd, then falling as Tukey's bisquare to
/// (nearly) 0 at 6. Days within 3 sd count fully, so that skewed but honest days keep their mean.
[[nodiscard]] double outlier_weight(double standardised);

/// Correlation of successive days within blocks, 0…0.9. The mean of a block is taken off first, and
/// the bias that this brings is corrected to first order.
/// @param standardised  (n) residuals in sd; cut at 3.
/// @param day_numbers   (n) ascending. @param blocks  (n) from 0.
[[nodiscard]] double lag_one_correlation(std::span<const double> standardised,
                                         std::span<const int> day_numbers,
                                         std::span<const int> blocks);

/// R C R' with C_ij = rho^|t_i - t_j| (p x p): the covariance of sums over AR(1) noise of unit
/// variance.
/// @param parts        R (p x n), what each day adds to each sum. @param day_numbers  t (n),
/// ascending.
/// @pre   0 <= rho < 1
/// @note  O(n p^2).
[[nodiscard]] Eigen::MatrixXd autoregressive_products(
    const Eigen::Ref<const Eigen::MatrixXd>& parts, std::span<const int> day_numbers, double rho);

}  // namespace recald::change_point
