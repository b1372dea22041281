/// How visible an effect of a known footprint is at a site: d*.
///
/// A simulator gives the effect's addition to each meter. The meters without the effect, the twin,
/// show what the model gets wrong anyway and what its parameters could imitate. With Sigma and the
/// Jacobian J of the base model calibrated to the twin, and s the footprint on the meters' scales,
///     d = sqrt(s' M s),  M = (Sigma + J J')^-1   (parameters as standard normal scores),
/// with the usual errors among the parameters. Scores of absent effects would have sd 1 if models
/// had no other errors; their sd is `null_score_spread`. So
///     d* = d / null_score_spread
/// is the detectability of the same signal against known noise.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "core/diagnosis/evidence/observations.hpp"
#include "core/diagnosis/evidence/site_problem.hpp"
#include "core/result.hpp"

namespace recald::diagnosis {

/// Root mean square of the scores of effects in buildings with nothing hidden; 1 if models had only
/// random and usual errors. Of 30 buildings of the training population with seed 601.
inline constexpr double null_score_spread = 3.1;

/// How visible a footprint is at one resolution of the data. Dimensionless.
struct Visibility {
  double detectability;   ///< d = sqrt(s' M s)
  double unprojected;     ///< sqrt(s' Sigma^-1 s): as if the base parameters were known.
  double absorbed_share;  ///< 1 - s' M s / s' Sigma^-1 s; 0 if nothing is visible.
};

/// A footprint relative to its meter, over the parts used: months to fit, measured.
struct MeterMove {
  double net_share;    ///< sum s / sum y, signed.
  double moved_share;  ///< sum |s| / sum y, four hours at a time.
};

struct Detectability {
  Visibility month;  ///< Means of the measured parts of each month.
  Visibility day;
  Visibility block;               ///< Four-hour parts, which a diagnosis uses.
  double d_star;                  ///< For these parts, relative to the spread of null scores.
  std::vector<MeterMove> meters;  ///< (m)
};

/// Measures footprints at one site. Once created, it costs some 10 ms per footprint.
class FootprintGauge {
 public:
  /// Calibrates the base model to the twin and fixes the noise at the node of highest weight.
  /// @param twin  The meters without the effect; must outlive the gauge.
  /// @return the gauge, or an error of `lay_ground`.
  [[nodiscard]] static Result<FootprintGauge> calibrate(const SiteProblem& twin);

  /// From existing parts.
  /// @param observations  (n) the observations of the twin to use.
  /// @param noise     Sigma of these observations.
  /// @param jacobian  J (n x q) on the meters' scales, per unit of each standard normal score.
  /// @return not_positive_definite if a sensitivity is not finite.
  [[nodiscard]] static Result<FootprintGauge> make(const SiteProblem& twin,
                                                   const Observations& observations,
                                                   const NoiseNode& noise,
                                                   const Eigen::MatrixXd& jacobian);

  /// @param footprint_kW  (hours x m) meters with the effect minus without, by the twin's hours.
  ///                      Ignored where the twin was not measured.
  /// @return the detectability, or not_finite for a footprint that is used and not finite.
  [[nodiscard]] Result<Detectability> measure(
      const Eigen::Ref<const Eigen::ArrayXXd>& footprint_kW) const;

 private:
  using Factor = Eigen::LLT<Eigen::MatrixXd>;

  /// A coarser resolution of one meter: P averages its rows by day or month.
  struct Averages {
    Eigen::SparseMatrix<double, Eigen::RowMajor> averaging;  ///< P (groups x n)
    Factor covariance;                                       ///< P Sigma P'
    Eigen::MatrixXd jacobian;                                ///< Whitened P J (groups x q).
  };
  struct CoarseGrain {
    std::vector<Averages> meters;
    Factor posterior;  ///< I + J' P' (P Sigma P')^-1 P J
  };

  explicit FootprintGauge(const SiteProblem& twin) : twin_(&twin) {}
  [[nodiscard]] Result<CoarseGrain> coarse_grain(const Eigen::MatrixXd& jacobian,
                                                 int (*group)(const DayPart&)) const;
  [[nodiscard]] Visibility at_block(const Eigen::VectorXd& footprint) const;
  [[nodiscard]] Visibility at(const CoarseGrain& grain, const Eigen::VectorXd& footprint) const;
  [[nodiscard]] std::vector<MeterMove> moves(const Eigen::ArrayXXd& parts_kW) const;

  const SiteProblem* twin_;
  Observations observations_;
  NoiseNode noise_;
  Eigen::MatrixXd solved_jacobian_;  ///< Sigma^-1 J (n x q)
  Factor posterior_;                 ///< I + J' Sigma^-1 J
  CoarseGrain day_;
  CoarseGrain month_;
};

}  // namespace recald::diagnosis
