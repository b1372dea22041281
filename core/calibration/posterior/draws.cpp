#include "core/calibration/posterior/draws.hpp"

#include <cmath>
#include <functional>
#include <utility>

namespace recald::calibration {
namespace {

/// One quantity in the draws of all chains, (iterations x chains), and its prior.
struct Quantity {
  std::string name;
  std::string unit;
  double prior_mean;
  double prior_sd;
  std::function<Eigen::VectorXd(const ChainDraws&)> draws_of;
};

std::vector<Quantity> parameter_quantities(const std::vector<Parameter>& parameters) {
  std::vector<Quantity> quantities;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const Parameter& parameter = parameters[j];
    const Prior& prior = parameter.prior;
    quantities.push_back({parameter.name, parameter.unit, prior.mean(), std::sqrt(prior.variance()),
                          [column = static_cast<Eigen::Index>(j)](const ChainDraws& chain) {
                            return chain.theta.col(column);
                          }});
  }
  return quantities;
}

std::vector<Quantity> hyperparameter_quantities(const HyperPrior& prior,
                                                const std::vector<std::string>& names) {
  const auto sd = [](const GammaPrior& gamma) { return std::sqrt(gamma.variance()); };
  std::vector<Quantity> quantities;
  quantities.push_back({names[0], "", prior.discrepancy_precision.mean(),
                        sd(prior.discrepancy_precision),
                        [](const ChainDraws& chain) { return chain.discrepancy_precision; }});
  quantities.push_back({names[1], "", prior.error_precision.mean(), sd(prior.error_precision),
                        [](const ChainDraws& chain) { return chain.error_precision; }});
  for (std::size_t s = 2; s < names.size(); ++s) {
    quantities.push_back({names[s], "", prior.rho.beta_mean(), std::sqrt(prior.rho.beta_variance()),
                          [column = static_cast<Eigen::Index>(s - 2)](const ChainDraws& chain) {
                            return chain.beta.col(column);
                          }});
  }
  return quantities;
}

std::vector<Summary> summarise_all(const std::vector<Quantity>& quantities,
                                   const std::vector<ChainDraws>& chains,
                                   const ForEachIndex& executor) {
  std::vector<Summary> summaries(quantities.size());
  executor(quantities.size(), [&](std::size_t i) {
    const Quantity& quantity = quantities[i];
    Eigen::MatrixXd draws(chains.front().log_density.size(),
                          static_cast<Eigen::Index>(chains.size()));
    for (std::size_t k = 0; k < chains.size(); ++k) {
      draws.col(static_cast<Eigen::Index>(k)) = quantity.draws_of(chains[k]);
    }
    summaries[i] =
        summarise(quantity.name, quantity.unit, draws, quantity.prior_mean, quantity.prior_sd);
  });
  return summaries;
}

}  // namespace

ChainDraws to_natural_units(const Chain& chain, const Posterior& posterior) {
  const Eigen::Index n = chain.draws.rows();
  ChainDraws draws{Eigen::MatrixXd(n, posterior.parameter_count()),
                   Eigen::VectorXd(n),
                   Eigen::VectorXd(n),
                   Eigen::MatrixXd(n, posterior.kernel_dimension()),
                   chain.log_density,
                   chain.statistics.acceptance_rate};
  Eigen::VectorXd theta(posterior.parameter_count());
  Hyperparameters hyper{0.0, 0.0, Eigen::VectorXd(posterior.kernel_dimension())};
  for (Eigen::Index i = 0; i < n; ++i) {
    posterior.to_natural(chain.draws.row(i).transpose(), theta, hyper);
    draws.theta.row(i) = theta;
    draws.discrepancy_precision(i) = hyper.discrepancy_precision;
    draws.error_precision(i) = hyper.error_precision;
    draws.beta.row(i) = hyper.beta;
  }
  return draws;
}

ThinnedDraws thin(const std::vector<ChainDraws>& chains, int count) {
  const auto per_chain = static_cast<int>(chains.front().theta.rows());
  const std::vector<int> indices =
      equally_spaced(per_chain * static_cast<int>(chains.size()), count);
  ThinnedDraws thinned;
  thinned.theta.resize(static_cast<Eigen::Index>(indices.size()), chains.front().theta.cols());
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const int chain = indices[i] / per_chain;
    const int iteration = indices[i] % per_chain;
    thinned.chain.push_back(chain);
    thinned.iteration.push_back(iteration);
    thinned.theta.row(static_cast<Eigen::Index>(i)) =
        chains[static_cast<std::size_t>(chain)].theta.row(iteration);
  }
  return thinned;
}

std::vector<Summary> summarise_parameters(const std::vector<Parameter>& parameters,
                                          const std::vector<ChainDraws>& chains,
                                          const ForEachIndex& executor) {
  return summarise_all(parameter_quantities(parameters), chains, executor);
}

std::vector<Summary> summarise_hyperparameters(const HyperPrior& prior,
                                               const std::vector<std::string>& names,
                                               const std::vector<ChainDraws>& chains,
                                               const ForEachIndex& executor) {
  return summarise_all(hyperparameter_quantities(prior, names), chains, executor);
}

std::vector<std::string> hyperparameter_names(const std::vector<std::string>& input_names,
                                              bool has_output_dimension) {
  std::vector<std::string> names{"lambda_delta", "lambda_eps"};
  for (const std::string& input : input_names) names.push_back("beta_" + input);
  if (has_output_dimension) names.emplace_back("beta_out");
  return names;
}

}  // namespace recald::calibration
