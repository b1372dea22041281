#include "core/diagnosis/check/held_scores.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace recald::diagnosis {
namespace {

// Of the sd of a pattern, after two years of data: about a third.
constexpr double kPatternsLeftOpen = 0.3;
// Of the size of a held-out month's noise, which is known within a factor of about two.
constexpr double kFreedom = 4.0;

ScoreGain gain_of(const std::vector<double>& differences) {
  const auto n = static_cast<double>(differences.size());
  double sum = 0.0;
  double squares = 0.0;
  for (const double d : differences) {
    sum += d;
    squares += d * d;
  }
  if (differences.size() < 2) return {sum, 0.0};
  const double variance = std::max(squares - sum * sum / n, 0.0) / (n - 1.0);
  return {sum, std::sqrt(n * variance)};
}

/// Remaining uncertainty of the usual errors' amounts after the fitted months: a root of
/// their covariance.
Eigen::MatrixXd root_of_errors(const JointFit& model) {
  const Eigen::Index k = model.usual.size();
  const auto q = static_cast<Eigen::Index>(model.theta.size());
  if (k == 0) return Eigen::MatrixXd(0, 0);
  return model.posterior.covariance.block(q, q, k, k).llt().matrixL();
}

/// A drift cannot be learnt from other months, and the errors' amounts are not known exactly.
/// @param errors  (n x k) one sd of each, in units of the remaining patterns.
void leave_open(BlockDesign& month, const Eigen::MatrixXd& errors) {
  Eigen::MatrixXd patterns(month.patterns.rows(), month.patterns.cols() + errors.cols());
  patterns << month.patterns, errors;
  patterns.middleCols(month.patterns.cols() - month.drifts, month.drifts) /= kPatternsLeftOpen;
  month.patterns = std::move(patterns);
}

}  // namespace

MonthScores HeldJudge::scores(const JointFit& model, const UsualErrors& usual) const {
  MonthScores scores(held.meters.size());
  const auto left_of = [&](const Observations& months) -> Eigen::VectorXd {
    return months.measured - months.stack(model.parts_kW) - usual.columns(months) * model.usual;
  };
  const Eigen::VectorXd fitted = left_of(fit);
  const Eigen::MatrixXd open_errors = usual.columns(held) * root_of_errors(model);
  const Eigen::VectorXd residual = left_of(held);
  for (std::size_t g = 0; g < held.meters.size(); ++g) {
    const MeterRows& teacher = fit.meters[g];
    const MeterRows& meter = held.meters[g];
    if (meter.rows.empty()) continue;
    const Eigen::VectorXd patterns = node.meters[g].pattern_mean(
        fitted.segment(teacher.offset, static_cast<Eigen::Index>(teacher.rows.size())));
    NoiseLevel level = levels[g];
    level.pattern_sd *= kPatternsLeftOpen;
    const auto month_at = [&](std::size_t i) {
      return site.day_parts.parts[static_cast<std::size_t>(meter.rows[i])].month;
    };
    for (std::size_t begin = 0, end = 0; begin < meter.rows.size(); begin = end) {
      while (end < meter.rows.size() && month_at(end) == month_at(begin)) ++end;
      const auto first = static_cast<Eigen::Index>(begin);
      const auto n = static_cast<Eigen::Index>(end - begin);
      BlockDesign month{meter.design.times_h.segment(first, n),
                        meter.design.patterns.middleRows(first, n),
                        {},
                        meter.design.drifts};
      const Eigen::VectorXd expected = month.patterns * patterns;
      leave_open(month, open_errors.middleRows(meter.offset + first, n) / level.pattern_sd);
      scores[g][month_at(begin)] = BlockNoise{month, level}.student_log_density(
          residual.segment(meter.offset + first, n) - expected, kFreedom);
    }
  }
  return scores;
}

MonthScores difference(const MonthScores& with, const MonthScores& without) {
  MonthScores change = with;
  for (std::size_t g = 0; g < with.size(); ++g) {
    for (auto& [month, score] : change[g]) score -= without[g].at(month);
  }
  return change;
}

std::vector<ScoreGain> gain_by_meter(const MonthScores& change) {
  std::vector<ScoreGain> gains;
  for (const auto& months : change) {
    std::vector<double> differences;
    for (const auto& [month, score] : months) differences.push_back(score);
    gains.push_back(gain_of(differences));
  }
  return gains;
}

ScoreGain gain_over(const MonthScores& change) { return gain_over(change, {}); }

ScoreGain gain_over(const MonthScores& change, const std::set<int>& apart) {
  std::map<int, double> months;
  for (const auto& meter : change) {
    for (const auto& [month, score] : meter) months[month] += score;
  }
  std::vector<double> all;
  std::array<std::vector<double>, 2> kinds;
  for (const auto& [month, score] : months) {
    all.push_back(score);
    kinds[apart.contains(month) ? 1 : 0].push_back(score);
  }
  constexpr std::size_t kFewest = 3;  // Two that happen to agree would have no scatter.
  if (kinds[1].size() < kFewest) return gain_of(all);
  const double of_apart = gain_of(kinds[1]).se;
  // A single other month is taken to vary as those apart do.
  const double of_others = kinds[0].size() == 1
                               ? of_apart / std::sqrt(static_cast<double>(kinds[1].size()))
                               : gain_of(kinds[0]).se;
  return {gain_of(all).sum, std::hypot(of_others, of_apart)};
}

}  // namespace recald::diagnosis
