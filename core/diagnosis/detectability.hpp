/// How visible an effect of a known footprint is at a site: d*.
///
/// A simulator tells what an effect adds to each meter; the meters without the effect, its twin,
/// tell what the model gets wrong anyway and what its parameters could imitate. With Sigma and the
/// Jacobian J of the base model calibrated to the twin, and s the footprint on the meters' scales,
///     d = sqrt(s' M s),  M = (Sigma + J J')^-1   (parameters as standard normal scores),
/// usual errors among the parameters. The scores of effects that are not there would vary by 1 if
/// that were all that models get wrong; they vary by `null_score_spread`. So
///     d* = d / null_score_spread
/// is what the same signal would show against noise that is known.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "core/diagnosis/observations.hpp"
#include "core/diagnosis/site_problem.hpp"
#include "core/result.hpp"

namespace recald::diagnosis {

/// What one grain of the data shows of a footprint. Pure numbers.
struct Visibility {
  double detectability;   ///< d = sqrt(s' M s)
  double unprojected;     ///< sqrt(s' Sigma^-1 s): as if the base parameters were known.
  double absorbed_share;  ///< 1 - s' M s / s' Sigma^-1 s; 0 where nothing shows at all.
};

/// A footprint beside its meter, over the parts that count: months to fit, measured.
struct MeterMove {
  double net_share;    ///< sum s / sum y, signed.
  double moved_share;  ///< sum |s| / sum y, four hours at a time.
};

struct Detectability {
  Visibility month;  ///< Means of the measured parts of each month.
  Visibility day;
  Visibility block;               ///< Four-hour parts: what a diagnosis reads.
  double d_star;                  ///< Of these parts, in units of what null scores vary by.
  std::vector<MeterMove> meters;  ///< (m)
};

/// Measures footprints at one site. Made once, it costs some 10 ms a footprint.
class FootprintGauge {
 public:
  /// Calibrates the base model to the twin and fixes the noise at the node of highest weight.
  /// @param twin  The meters without the effect; must outlive the gauge.
  /// @return the gauge, or what `lay_ground` refuses.
  [[nodiscard]] static Result<FootprintGauge> calibrate(const SiteProblem& twin);

  /// From parts at hand.
  /// @param observations  (n) what counts of the twin.
  /// @param noise     Sigma of these observations.
  /// @param jacobian  J (n x q) on the meters' scales, for a unit of each standard normal score.
  /// @return not_positive_definite if a sensitivity is not finite.
  [[nodiscard]] static Result<FootprintGauge> make(const SiteProblem& twin,
                                                   const Observations& observations,
                                                   const NoiseNode& noise,
                                                   const Eigen::MatrixXd& jacobian);

  /// @param footprint_kW  (hours x m) meters with the effect minus without, by the twin's hours.
  ///                      Where the twin was not measured it does not count.
  /// @return or not_finite where it counts and is no number.
  [[nodiscard]] Result<Detectability> measure(
      const Eigen::Ref<const Eigen::ArrayXXd>& footprint_kW) const;

 private:
  using Factor = Eigen::LLT<Eigen::MatrixXd>;

  /// A coarser grain of one meter: P averages its rows by day or month.
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
