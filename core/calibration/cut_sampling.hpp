/// Draws of θ that leave some parameters of the model, η, as they are known: a cut posterior.
///
/// p(θ, η) = p(θ | y, η) p(η | earlier data): the months teach θ for every value of η, and nothing
/// flows back to η. Each chain walks through all values of η; at each it goes on from where it
/// stood, settles, and is kept for a while. A walk through neighbouring targets needs no new
/// burn-in for each of them.
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
  int stride;       ///< every so many iterations.
  int chains = 4;
};

struct CutDraws {
  /// θ, then η in `theta`; the values of η take turns, so that draws next to each other are not of
  /// one η.
  std::vector<ChainDraws> chains;
  std::vector<ChainStatistics> statistics;  ///< Acceptance and evaluations, a chain.
};

/// @param model      θ (q), then η (r).
/// @param base       Of the same problem at one η: its normalisation and hyper-prior are taken.
/// @param problem    Parameters are θ alone.
/// @param eta        (n x r), n >= 1.
/// @return the draws; an error of the model; cancelled.
/// @note   Chain k draws from a stream of its own: any executor gives the same bytes.
[[nodiscard]] Result<CutDraws> sample_given_eta(const MonthlyModel& model, const Calibration& base,
                                                const CalibrationProblem& problem,
                                                const Eigen::MatrixXd& eta,
                                                const CutOptions& options,
                                                const RunContext& context);

}  // namespace recald::calibration
