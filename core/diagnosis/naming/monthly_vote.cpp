#include "core/diagnosis/naming/monthly_vote.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/absent.hpp"
#include "core/assessment/fit_metrics.hpp"
#include "core/random/rng.hpp"
#include "core/random/streams.hpp"
#include "core/statistics/quantile.hpp"

namespace recald::diagnosis {
namespace {

/// The assumed error of a predicted month is at least this share of an output's mean.
constexpr double kLeastErrorShare = 0.02;
constexpr double kFirstErrorShare = 0.05;
constexpr int kErrorRounds = 3;
constexpr int kFitIterations = 12;
constexpr double kFitScoreStep = 1e-3;
constexpr double kFitScoreLimit = 3.0;
constexpr std::size_t kLeastShown = 2;
constexpr int kResamples = 2000;

std::vector<double> theta_at(std::span<const Parameter> parameters, const Eigen::VectorXd& scores) {
  std::vector<double> theta;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    theta.push_back(parameters[j].prior.at_score(scores[static_cast<Eigen::Index>(j)]).value);
  }
  return theta;
}

/// Mean of an output's measurements in the fitted months.
double mean_of(const MonthlyFigures& measured, std::size_t output) {
  double sum = 0.0;
  int n = 0;
  for (const std::size_t month : measured.fitted) {
    if (!measured.has(output, month)) continue;
    sum += measured.value(output, month);
    ++n;
  }
  return n > 0 ? sum / n : 0.0;
}

/// (points) residuals divided by their sd, measured - modelled, in the fitted months.
Eigen::VectorXd residuals(const MonthlyFigures& measured, const std::vector<double>& modelled,
                          const std::vector<double>& error_sd) {
  const std::size_t months = modelled.size() / measured.outputs.size();
  std::vector<double> values;
  for (std::size_t k = 0; k < measured.outputs.size(); ++k) {
    for (const std::size_t i : measured.fitted) {
      if (!measured.has(k, i)) continue;
      values.push_back((measured.value(k, i) - modelled[k * months + i]) / error_sd[k]);
    }
  }
  return Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
}

/// Scores that minimise  |residuals|^2 + |scores|^2; a priori every score is standard normal.
Eigen::VectorXd most_probable(MonthlyModel& model, std::span<const Parameter> parameters,
                              const MonthlyFigures& measured, const std::vector<double>& error_sd) {
  const auto q = static_cast<Eigen::Index>(parameters.size());
  const auto residuals_at = [&](const Eigen::VectorXd& scores) {
    return residuals(measured, evaluate(model, theta_at(parameters, scores)), error_sd);
  };
  Eigen::VectorXd scores = Eigen::VectorXd::Zero(q);
  Eigen::VectorXd residual = residuals_at(scores);
  double cost = residual.squaredNorm();
  for (int iteration = 0; iteration < kFitIterations; ++iteration) {
    Eigen::MatrixXd jacobian(residual.size(), q);
    for (Eigen::Index j = 0; j < q; ++j) {
      Eigen::VectorXd moved = scores;
      moved[j] += kFitScoreStep;
      jacobian.col(j) = (residual - residuals_at(moved)) / kFitScoreStep;
    }
    const Eigen::MatrixXd normal =
        jacobian.transpose() * jacobian + Eigen::MatrixXd::Identity(q, q);
    Eigen::VectorXd step = normal.llt().solve(jacobian.transpose() * residual - scores);
    bool better = false;
    for (int halving = 0; halving < 8 && !better; ++halving, step *= 0.5) {
      const Eigen::VectorXd next =
          (scores + step).cwiseMax(-kFitScoreLimit).cwiseMin(kFitScoreLimit);
      const Eigen::VectorXd there = residuals_at(next);
      const double next_cost = there.squaredNorm() + next.squaredNorm();
      better = next_cost < cost - 1e-9;
      if (!better) continue;
      scores = next;
      residual = there;
      cost = next_cost;
    }
    if (!better) break;
  }
  return scores;
}

/// (outputs) sd of the residuals, but at least a share of the mean.
std::vector<double> errors_left(const MonthlyFigures& measured,
                                const std::vector<double>& modelled) {
  const std::size_t months = modelled.size() / measured.outputs.size();
  std::vector<double> error_sd;
  for (std::size_t k = 0; k < measured.outputs.size(); ++k) {
    double squares = 0.0;
    int n = 0;
    for (const std::size_t i : measured.fitted) {
      if (!measured.has(k, i)) continue;
      const double error = measured.value(k, i) - modelled[k * months + i];
      squares += error * error;
      ++n;
    }
    const double least = kLeastErrorShare * mean_of(measured, k);
    error_sd.push_back(std::max({n > 0 ? std::sqrt(squares / n) : 0.0, least, 1e-9}));
  }
  return error_sd;
}

struct Fit {
  std::vector<double> modelled;  ///< (outputs * months)
  std::vector<double> error_sd;  ///< (outputs)
};

/// Fits errors and parameters alternately.
Fit fit_before(MonthlyModel& model, std::span<const Parameter> parameters,
               const MonthlyFigures& measured) {
  Fit fit;
  for (std::size_t k = 0; k < measured.outputs.size(); ++k) {
    fit.error_sd.push_back(std::max(kFirstErrorShare * mean_of(measured, k), 1e-9));
  }
  for (int round = 0;; ++round) {
    const auto scores = most_probable(model, parameters, measured, fit.error_sd);
    fit.modelled = evaluate(model, theta_at(parameters, scores));
    // Both models must be fitted with the same errors, so the last fit does not change them.
    if (round == kErrorRounds) return fit;
    fit.error_sd = errors_left(measured, fit.modelled);
  }
}

double log_density(double error, double sd) {
  return -0.5 * (error * error / (sd * sd) + std::log(2.0 * std::numbers::pi * sd * sd));
}

/// One output in the held-out months: pairs of measured and modelled.
struct Pairs {
  std::vector<double> measured;
  std::vector<double> before;
  std::vector<double> after;
};

Pairs pairs_of(const MonthlyFigures& measured, std::size_t output, const Fit& before,
               const std::vector<double>& after) {
  const std::size_t months = after.size() / measured.outputs.size();
  Pairs pairs;
  for (const std::size_t i : measured.shown) {
    if (!measured.has(output, i)) continue;
    pairs.measured.push_back(measured.value(output, i));
    pairs.before.push_back(before.modelled[output * months + i]);
    pairs.after.push_back(after[output * months + i]);
  }
  return pairs;
}

ModelGap::Figures figures_of(const std::vector<double>& measured,
                             const std::vector<double>& modelled, double error_sd) {
  ModelGap::Figures figures{kAbsent, kAbsent, kAbsent, kAbsent};
  if (const auto metrics = assessment::fit_metrics(measured, modelled)) {
    figures.nmbe_sim_minus_meas = metrics->nmbe_sim_minus_meas;
    figures.cvrmse = metrics->cvrmse;
  }
  if (measured.empty()) return figures;
  double sum = 0.0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    sum += log_density(measured[i] - modelled[i], error_sd);
  }
  figures.log_score = sum / static_cast<double>(measured.size());
  return figures;
}

ScoreGain summed_gain(const std::vector<double>& gains) {
  const auto n = static_cast<double>(gains.size());
  ScoreGain gain;
  for (const double value : gains) gain.sum += value;
  if (gains.size() < 2) return gain;
  double squares = 0.0;
  for (const double value : gains) squares += (value - gain.sum / n) * (value - gain.sum / n);
  gain.se = std::sqrt(squares / (n - 1.0) * n);
  return gain;
}

/// Changes of |NMBE| and CV(RMSE) over resampled months, always the same ones before and after.
/// Held-out months are far apart, so they are resampled one by one.
std::pair<ChangeInterval, ChangeInterval> resampled(const Pairs& pairs, Rng& rng) {
  std::vector<double> nmbe;
  std::vector<double> cvrmse;
  const std::size_t n = pairs.measured.size();
  Pairs drawn = pairs;
  for (int sample = 0; sample < kResamples && n > 0; ++sample) {
    for (std::size_t i = 0; i < n; ++i) {
      const auto from = static_cast<std::size_t>(rng.below(n));
      drawn.measured[i] = pairs.measured[from];
      drawn.before[i] = pairs.before[from];
      drawn.after[i] = pairs.after[from];
    }
    const auto before = assessment::fit_metrics(drawn.measured, drawn.before);
    const auto after = assessment::fit_metrics(drawn.measured, drawn.after);
    if (!before || !after) continue;
    nmbe.push_back(std::abs(after->nmbe_sim_minus_meas) - std::abs(before->nmbe_sim_minus_meas));
    cvrmse.push_back(after->cvrmse - before->cvrmse);
  }
  const auto interval = [](std::vector<double> values) -> ChangeInterval {
    if (values.empty()) return {kAbsent, kAbsent};
    std::ranges::sort(values);
    return {quantile_of_sorted(std::span<const double>{values}, 0.05),
            quantile_of_sorted(std::span<const double>{values}, 0.95)};
  };
  return {interval(std::move(nmbe)), interval(std::move(cvrmse))};
}

MonthlyVote compare(const MonthlyFigures& measured, const Fit& before,
                    const std::vector<double>& after, std::uint64_t seed) {
  MonthlyVote result;
  result.months_shown = static_cast<int>(measured.shown.size());
  result.figures_shown = 0;
  std::vector<double> by_month(measured.shown.size(), 0.0);
  const std::size_t months = after.size() / measured.outputs.size();
  Rng rng{seed, streams::kVote.first};
  for (std::size_t k = 0; k < measured.outputs.size(); ++k) {
    const Pairs pairs = pairs_of(measured, k, before, after);
    const double sd = before.error_sd[k];
    result.gap.outputs.push_back(measured.outputs[k]);
    result.gap.before.push_back(figures_of(pairs.measured, pairs.before, sd));
    result.gap.after.push_back(figures_of(pairs.measured, pairs.after, sd));
    std::vector<double> gains;
    for (std::size_t s = 0; s < measured.shown.size(); ++s) {
      const std::size_t i = measured.shown[s];
      if (!measured.has(k, i)) continue;
      const double y = measured.value(k, i);
      gains.push_back(log_density(y - after[k * months + i], sd) -
                      log_density(y - before.modelled[k * months + i], sd));
      by_month[s] += gains.back();
    }
    const auto [nmbe, cvrmse] = resampled(pairs, rng);
    result.gap.change.push_back({summed_gain(gains), nmbe, cvrmse});
    result.figures_shown += static_cast<int>(gains.size());
  }
  result.total = summed_gain(by_month);
  return result;
}

}  // namespace

Result<void> require_enough(const MonthlyFigures& measured, std::size_t parameters) {
  std::size_t points = 0;
  for (std::size_t k = 0; k < measured.outputs.size(); ++k) {
    for (const std::size_t i : measured.fitted) points += measured.has(k, i) ? 1 : 0;
  }
  if (points >= parameters + 2 && measured.shown.size() >= kLeastShown) return {};
  return failure(ErrorCode::not_enough_data,
                 "the monthly model needs " + std::to_string(parameters + 2) +
                     " measured monthly figures for the fit and " + std::to_string(kLeastShown) +
                     " months for the check, but has " + std::to_string(points) + " and " +
                     std::to_string(measured.shown.size()));
}

MonthlyVote monthly_vote(MonthlyModel& before, MonthlyModel& after,
                         std::span<const Parameter> parameters, const MonthlyFigures& measured,
                         std::uint64_t seed) {
  const Fit fit = fit_before(before, parameters, measured);
  const auto scores = most_probable(after, parameters, measured, fit.error_sd);
  return compare(measured, fit, evaluate(after, theta_at(parameters, scores)), seed);
}

}  // namespace recald::diagnosis
