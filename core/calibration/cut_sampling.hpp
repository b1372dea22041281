/// Draws of θ that do not change what is known of some other parameters η of the model:
/// a cut posterior.
///
/// p(θ, η) = p(θ | y, η) p(η | earlier data): the months inform θ for every value of η, without
/// feedback to η. Each chain goes through all values of η. At each value it continues from its
/// position, settles, and is then kept for a while. Neighbouring targets are similar, so no new
/// burn-in is needed.
/// @see Plummer (2015), Stat. Comput. 25, "Cuts in Bayesian graphical models".
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/calibration/calibration.hpp"
#include "core/model/monthly_model.hpp"
#include "core/result.hpp"

namespace recald::calibration {

struct CutOptions {
  int burn_in;      ///< Iterations at the first η, in which the walk learns its steps.
  int settle_each;  ///< Dropped after each change of η.
  int kept_each;    ///< Draws at each η,
  int stride;       ///< one every so many iterations.
  int chains = 4;
};

struct CutDraws {
  /// θ, then η in `theta`; the values of η alternate, so adjacent draws have different η.
  std::vector<ChainDraws> chains;
  std::vector<ChainStatistics> statistics;  ///< Acceptance and evaluations, per chain.
};

/// @param model      θ (q), then η (r).
/// @param emulator_error_sd  (outputs * months) in units, where `model` is an emulator; empty: it
/// is
///                   the model itself.
/// @param base       A calibration of the same problem at one η; gives normalisation
///                   and hyper-prior.
/// @param problem    Its parameters are θ alone.
/// @param eta        (n x r), n >= 1.
/// @return the draws; an error of the model; cancelled.
/// @note   Chain k draws from its own stream, so any executor gives the same bytes.
[[nodiscard]] Result<CutDraws> sample_given_eta(
    const MonthlyModel& model, const Eigen::VectorXd& emulator_error_sd, const Calibration& base,
    const CalibrationProblem& problem, const Eigen::MatrixXd& eta, const CutOptions& options,
    const RunContext& context);

}  // namespace recald::calibration
