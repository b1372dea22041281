/// Posterior draws in natural units, and their summaries.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/calibration/covariance/hyper_prior.hpp"
#include "core/calibration/posterior/posterior.hpp"
#include "core/calibration/posterior/summary.hpp"
#include "core/calibration/samplers/sampler.hpp"
#include "core/executor.hpp"
#include "core/model/parameter.hpp"

namespace recald::calibration {

/// Kept draws of one chain in natural units, one row per iteration.
struct ChainDraws {
  Eigen::MatrixXd theta;                  ///< (n x q) in the parameters' units.
  Eigen::VectorXd discrepancy_precision;  ///< (n) lambda_delta, normalised scale.
  Eigen::VectorXd error_precision;        ///< (n) lambda_epsilon, normalised scale.
  Eigen::MatrixXd beta;                   ///< (n x S)
  Eigen::VectorXd log_density;            ///< (n) in the sampler's coordinates.
  double acceptance_rate;
};

/// Equally spaced draws over the pooled chains, to run through the model for a report.
struct ThinnedDraws {
  std::vector<int> chain;      ///< (count)
  std::vector<int> iteration;  ///< (count) row in that chain's draws.
  Eigen::MatrixXd theta;       ///< (count x q)
};

/// Converts a chain in `posterior`'s unconstrained coordinates to natural units.
[[nodiscard]] ChainDraws to_natural_units(const Chain& chain, const Posterior& posterior);

/// `count` draws equally spaced over the pooled chains. @pre chains of equal, positive length
[[nodiscard]] ThinnedDraws thin(const std::vector<ChainDraws>& chains, int count);

/// One summary per parameter, pooled over chains; the executor runs them in parallel.
[[nodiscard]] std::vector<Summary> summarise_parameters(const std::vector<Parameter>& parameters,
                                                        const std::vector<ChainDraws>& chains,
                                                        const ForEachIndex& executor);

/// As above for lambda_delta, lambda_eps and the betas.
/// @param names  `hyperparameter_names`
[[nodiscard]] std::vector<Summary> summarise_hyperparameters(const HyperPrior& prior,
                                                             const std::vector<std::string>& names,
                                                             const std::vector<ChainDraws>& chains,
                                                             const ForEachIndex& executor);

/// lambda_delta, lambda_eps, beta_<input> …, and beta_out if there is more than one output.
[[nodiscard]] std::vector<std::string> hyperparameter_names(
    const std::vector<std::string>& input_names, bool has_output_dimension);

}  // namespace recald::calibration
