/// The meters' observations in parts with certain roles, stacked meter by meter, and their noise.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/diagnosis/evidence/block_noise.hpp"
#include "core/diagnosis/evidence/posterior_algebra.hpp"
#include "core/diagnosis/evidence/site_problem.hpp"

namespace recald::diagnosis {

/// The scale on which a meter's residuals have the same spread at all levels.
enum class ResidualScale { linear, square_root };

/// y on the scale, in kW at the meter's mean, where the derivative is 1.
/// square_root: 2 sqrt(m (y + m/10)) with the mean m; y below 0 counts as 0.
[[nodiscard]] double on_scale(double power_kW, double mean_kW, ResidualScale scale);

/// The scale on which a meter's residuals have the same spread at all times.
struct MeterScale {
  ResidualScale levels = ResidualScale::linear;
  /// (parts) spread of the residuals, with geometric mean 1: powers are divided by it. Empty: 1.
  Eigen::ArrayXd spread = {};
};

struct MeterRows {
  std::vector<Eigen::Index> rows;  ///< Measured parts with a wanted role.
  BlockDesign design;       ///< Patterns by part of week and a spline in outdoor temperature.
  Eigen::Index offset = 0;  ///< Start of the meter in stacked vectors.
  double mean_kW = 0.0;
  MeterScale scale;
};

struct Observations {
  std::vector<MeterRows> meters;
  Eigen::VectorXd measured;  ///< (n) on the scale, stacked.

  [[nodiscard]] Eigen::Index count() const { return measured.size(); }
  /// Selects the rows of a run. @param parts_kW  (parts x m)
  [[nodiscard]] Eigen::VectorXd stack(const Eigen::ArrayXXd& parts_kW) const;
};

/// @param scales  (m)
/// @param part_flags  (parts) which parts to use.
[[nodiscard]] Observations observe(const SiteProblem& site, const std::vector<bool>& part_flags,
                                   std::span<const MeterScale> scales);

/// How the spread of a meter's residuals depends on the part of the day, separately for workdays
/// and other days, and on outdoor temperature: errors are largest where consumption is.
/// @param residual  (n) of the meter's rows, without recurring patterns.
/// @return (parts) for the whole period; bins with few parts are shrunk towards the overall mean.
[[nodiscard]] Eigen::ArrayXd spread_of(const SiteProblem& site, const MeterRows& meter,
                                       const Eigen::Ref<const Eigen::VectorXd>& residual);

/// Flags of the parts whose role is one of `roles`.
[[nodiscard]] std::vector<bool> parts_of(const SiteProblem& site,
                                         std::initializer_list<Role> roles);

/// The covariance at one node of the grid over its hyper-parameters.
struct NoiseNode {
  std::vector<BlockNoise> meters;
  double log_weight;  ///< Prior.

  /// Gram of stacked columns, summed over meters.
  [[nodiscard]] GramSystem gram(const Observations& observations,
                                const Eigen::Ref<const Eigen::MatrixXd>& columns) const;
  /// Sigma^-1 X of stacked columns (n x k).
  [[nodiscard]] Eigen::MatrixXd solve(const Observations& observations,
                                      const Eigen::Ref<const Eigen::MatrixXd>& columns) const;
  /// x' Sigma^-1 x of each stacked column (k).
  [[nodiscard]] Eigen::VectorXd squared_norms(
      const Observations& observations, const Eigen::Ref<const Eigen::MatrixXd>& columns) const;
};

/// Common factors on structure_sd, correlation_h and white_sd: 3 x 3 x 3 nodes around the fitted
/// levels, or only the middle one. A single noise level, learnt without an effect, would contain
/// the effect and hide it.
[[nodiscard]] std::vector<NoiseNode> noise_grid(
    const Observations& observations, std::span<const NoiseLevel> levels, bool whole,
    const ForEachIndex& executor = for_each_index_serially);

}  // namespace recald::diagnosis
