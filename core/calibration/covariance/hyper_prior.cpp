#include "core/calibration/covariance/hyper_prior.hpp"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/gamma.hpp>
#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/special_functions/trigamma.hpp>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace recald::calibration {

// Boost's lgamma throughout: the C library's writes a global (signgam), which two
// chains would share.
using boost::math::lgamma;

double GammaPrior::log_constant() const { return shape * std::log(rate) - lgamma(shape); }

double GammaPrior::log_density(double value) const {
  if (!(value > 0.0)) return -std::numeric_limits<double>::infinity();
  return log_constant() + log_kernel(value, std::log(value));
}

double GammaPrior::quantile(double probability) const {
  return boost::math::quantile(boost::math::gamma_distribution<>(shape, 1.0 / rate), probability);
}

double BetaPrior::log_constant() const { return lgamma(a + b) - lgamma(a) - lgamma(b); }

double BetaPrior::log_density_at_logit(double z) const {
  return log_constant() - (a - 1.0) * softplus(-z) - (b - 1.0) * softplus(z);
}

double BetaPrior::quantile(double probability) const {
  return boost::math::quantile(boost::math::beta_distribution<>(a, b), probability);
}

double BetaPrior::logit_quantile(double probability) const {
  const boost::math::beta_distribution<> rho(a, b);
  // 1 - rho ~ Beta(b, a): each is computed from its own side, so rounding near 1 does not matter.
  // Below the smallest double, the exact value of 1 - rho does not matter.
  const boost::math::beta_distribution<> complement(b, a);
  constexpr double tiny = std::numeric_limits<double>::min();
  const double value = std::max(boost::math::quantile(rho, probability), tiny);
  const double rest =
      std::max(boost::math::quantile(boost::math::complement(complement, probability)), tiny);
  return std::log(value) - std::log(rest);
}

ScoredBeta BetaPrior::at_score(double score) const {
  assert(std::abs(score) <= kScoreMax);
  const double density = std::exp(-0.5 * score * score) / std::sqrt(2.0 * std::numbers::pi);
  const double above = 0.5 * std::erfc(score / std::numbers::sqrt2);
  const double log_above =
      score > 0.0 ? std::log(above) : std::log1p(-0.5 * std::erfc(-score / std::numbers::sqrt2));
  const double log_rest = log_above / b;  // log(1 - rho)
  const double rest = std::exp(log_rest);
  const double rho = -std::expm1(log_rest);
  const double log_rho = rest < 0.5 ? std::log1p(-rest) : std::log(rho);
  const double relative_slope = rest / rho * density / (b * above);  // rho' / rho
  return {-4.0 * log_rho, -4.0 * relative_slope, (a - 1.0) * log_rho - 0.5 * score * score,
          (a - 1.0) * relative_slope - score};
}

double BetaPrior::log_constant_of_score() const {
  return log_constant() - std::log(b) - 0.5 * std::log(2.0 * std::numbers::pi);
}

double BetaPrior::score_quantile(double probability) const {
  // Phi(-score) = (1 - rho)^b, with log(1 - rho) from the logit so that no digits are lost near 1.
  const double log_above = -b * softplus(logit_quantile(probability));
  const double above = std::max(std::exp(log_above), 1e-300);
  const double below = std::max(-std::expm1(log_above), 1e-300);
  const double score = above < below ? std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * above)
                                     : -std::numbers::sqrt2 * boost::math::erfc_inv(2.0 * below);
  return std::clamp(score, -kScoreMax, kScoreMax);
}

double BetaPrior::beta_mean() const {
  return 4.0 * (boost::math::digamma(a + b) - boost::math::digamma(a));
}

double BetaPrior::beta_variance() const {
  return 16.0 * (boost::math::trigamma(a) - boost::math::trigamma(a + b));
}

double softplus(double x) { return std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x))); }

double beta_from_logit(double z) { return 4.0 * softplus(-z); }

double logit_from_beta(double beta) {
  // rho = exp(-beta / 4); z = log(rho / (1 - rho)).
  return -beta / 4.0 - std::log(-std::expm1(-beta / 4.0));
}

HyperPrior make_hyper_prior(HyperPriorProfile profile, double pooled_variance) {
  assert(pooled_variance > 0.0);
  constexpr BetaPrior rho{1.0, 0.3};  // mass near 1: an input matters only if the data show it
  switch (profile) {
    case HyperPriorProfile::scaled:
      return {"scaled", {10.0, 0.3 * pooled_variance}, {10.0, 0.03 * pooled_variance}, rho};
    case HyperPriorProfile::seed:
      return {"seed", {10.0, 0.4}, {10.0, 0.025}, rho};
    case HyperPriorProfile::stan2018:
      return {"stan2018", {10.0, 0.3}, {10.0, 0.03}, rho};
    case HyperPriorProfile::tight:
      return {"tight", {10.0, 0.1}, {10.0, 0.025}, rho};
  }
  assert(false);
  return {};
}

Result<HyperPrior> make_custom_hyper_prior(GammaPrior discrepancy_precision,
                                           GammaPrior error_precision, BetaPrior rho) {
  const auto usable = [](double value) { return std::isfinite(value) && value > 0.0; };
  const auto complain = [](const std::string& section, const std::string& keys) {
    return failure(ErrorCode::invalid_value, "the hyper-prior's [" + section + "] needs " + keys +
                                                 " that are finite and positive");
  };
  if (!usable(discrepancy_precision.shape) || !usable(discrepancy_precision.rate)) {
    return complain("discrepancy", "shape and rate");
  }
  if (!usable(error_precision.shape) || !usable(error_precision.rate)) {
    return complain("error", "shape and rate");
  }
  if (!usable(rho.a) || !usable(rho.b)) return complain("rho", "a and b");
  return HyperPrior{"custom", discrepancy_precision, error_precision, rho};
}

Result<HyperPriorProfile> parse_hyper_prior_profile(std::string_view text) {
  if (text == "scaled") return HyperPriorProfile::scaled;
  if (text == "seed") return HyperPriorProfile::seed;
  if (text == "stan2018" || text == "wide") return HyperPriorProfile::stan2018;
  if (text == "tight") return HyperPriorProfile::tight;
  return failure(ErrorCode::invalid_value, "'" + std::string(text) +
                                               "' is not a hyper-prior profile; the profiles are "
                                               "scaled, seed, stan2018 (or wide) and tight");
}

}  // namespace recald::calibration
