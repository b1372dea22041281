/// Priors of the size and smoothness of the model discrepancy, and of the noise.
///
/// The seed says "20 % model discrepancy, 5 % measurement error" and uses the families of Guillas
/// et al. (2009): Gamma on the precisions, Beta on the correlations. All apply to outputs
/// normalised to [0, 1].
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

#include "core/random/rng.hpp"
#include "core/result.hpp"

namespace recald::calibration {

/// Gamma(shape, rate): mean shape / rate.
struct GammaPrior {
  double shape;
  double rate;

  /// log density = log_constant() + log_kernel(value, log(value)); compute the constant only once.
  [[nodiscard]] double log_constant() const;
  [[nodiscard]] double log_kernel(double value, double log_value) const {
    return (shape - 1.0) * log_value - rate * value;
  }
  /// Minus infinity for value <= 0.
  [[nodiscard]] double log_density(double value) const;
  [[nodiscard]] double quantile(double probability) const;
  [[nodiscard]] double mean() const { return shape / rate; }
  [[nodiscard]] double variance() const { return shape / (rate * rate); }
  bool operator==(const GammaPrior&) const = default;
};

/// beta = -4 ln rho at the coordinate `score` of rho, and the prior density there.
struct ScoredBeta {
  double beta;
  double derivative;          ///< d beta / d score
  double log_density;         ///< Of the score, without the constant of `log_constant_of_score`.
  double density_derivative;  ///< d log_density / d score
};

/// Beta(a, b) for rho, the correlation of the discrepancy at two points half the input range apart.
///
/// With b < 1 the density is infinite at rho = 1, and a double rounds to 1 with prior probability
/// about 1e-5, so all computations start from z = logit rho.
/// about 1e-5, so everything starts from z = logit rho.
struct BetaPrior {
  double a;
  double b;

  /// -log B(a, b); compute it only once.
  [[nodiscard]] double log_constant() const;
  /// log density with respect to rho, at rho = 1 / (1 + exp(-z)).
  [[nodiscard]] double log_density_at_logit(double z) const;
  [[nodiscard]] double quantile(double probability) const;
  /// z = logit rho of the probability-quantile; finite even if rho rounds to 1.
  [[nodiscard]] double logit_quantile(double probability) const;
  /// The coordinate used by samplers: the score with  1 - rho = Phi(-score)^(1/b). For a = 1, the
  /// seed's choice, a standard normal score is exactly this prior; for any other a it is a smooth
  /// coordinate whose density is still exact. While rho = logit^-1(z) has the long exponential tail
  /// exp(-b z) for an input that does not matter, this coordinate has a normal tail.
  /// @pre |score| <= kScoreMax
  [[nodiscard]] ScoredBeta at_score(double score) const;
  [[nodiscard]] double log_constant_of_score() const;
  /// The score whose rho is the probability-quantile.
  [[nodiscard]] double score_quantile(double probability) const;
  [[nodiscard]] double beta_mean() const;      ///< Of beta = -4 ln rho.
  [[nodiscard]] double beta_variance() const;  ///< Of beta = -4 ln rho.
  bool operator==(const BetaPrior&) const = default;
};

/// Beyond this many standard deviations a normal tail cannot be represented as a double.
inline constexpr double kScoreMax = 37.0;

/// log(1 + exp(x)) without overflow or loss. Then -softplus(-z) = log rho,
/// -softplus(z) = log(1 - rho).
[[nodiscard]] double softplus(double x);

/// beta = -4 ln rho = 4 log(1 + exp(-z)), the inverse squared length scale of eq. (4) of the seed.
[[nodiscard]] double beta_from_logit(double z);
/// Its inverse; infinity for beta = 0.
[[nodiscard]] double logit_from_beta(double beta);

struct HyperPrior {
  std::string name;                  ///< Of the profile, or "custom".
  GammaPrior discrepancy_precision;  ///< lambda_delta, 1 / variance of the discrepancy.
  GammaPrior error_precision;        ///< lambda_epsilon, 1 / variance of the measurement error.
  BetaPrior rho;                     ///< The same for every input.

  bool operator==(const HyperPrior&) const = default;
};

enum class HyperPriorProfile {
  scaled,    ///< Gamma(10, 0.3 v_y), Gamma(10, 0.03 v_y): the published constants on unit variance.
  seed,      ///< Gamma(10, 0.4), Gamma(10, 0.025): 20 % and 5 % read literally.
  stan2018,  ///< Gamma(10, 0.3), Gamma(10, 0.03): a public Stan code's constants on [0, 1].
  tight,     ///< Gamma(10, 0.1), Gamma(10, 0.025).
};

/// @param pooled_variance  v_y of `Normalisation`; only `scaled` uses it. @pre > 0
[[nodiscard]] HyperPrior make_hyper_prior(HyperPriorProfile profile, double pooled_variance);

/// For custom values. @return invalid_value unless all are finite and positive.
[[nodiscard]] Result<HyperPrior> make_custom_hyper_prior(GammaPrior discrepancy_precision,
                                                         GammaPrior error_precision, BetaPrior rho);

/// "scaled", "seed", "stan2018" (also "wide"), "tight"; anything else is invalid_value.
[[nodiscard]] Result<HyperPriorProfile> parse_hyper_prior_profile(std::string_view text);

/// One value of all quantities that describe discrepancy and error.
struct Hyperparameters {
  double discrepancy_precision;  ///< lambda_delta
  double error_precision;        ///< lambda_epsilon
  Eigen::VectorXd beta;          ///< (dimensions of the kernel) >= 0
};

}  // namespace recald::calibration
