#include "core/diagnosis/gap.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/absent.hpp"

namespace recald::diagnosis {
namespace {

// Of what the errors of other meters shrink by.
constexpr double kMostHarm = 0.25;

/// Root mean square error over groups of parts (days, months), relative to the mean of the groups.
double cvrmse_by(const SiteProblem& site, const MeterRows& rows, Eigen::Index g,
                 const Eigen::ArrayXXd& parts_kW, int (*group)(const DayPart&)) {
  std::map<int, std::pair<double, double>> sums;
  for (const Eigen::Index row : rows.rows) {
    const DayPart& part = site.day_parts.parts[static_cast<std::size_t>(row)];
    auto& [measured, modelled] = sums[group(part)];
    measured += part.hours * site.measured_parts_kW(row, g);
    modelled += part.hours * parts_kW(row, g);
  }
  double squares = 0.0;
  double total = 0.0;
  for (const auto& [key, pair] : sums) {
    squares += (pair.first - pair.second) * (pair.first - pair.second);
    total += pair.first;
  }
  const auto n = static_cast<double>(sums.size());
  return n > 1.0 && total > 0.0 ? std::sqrt(squares / (n - 1.0)) / (total / n) : kAbsent;
}

}  // namespace

HeldJudge judge_of(const SiteProblem& site, const Ground& ground, const Observations& held) {
  return {site, ground.fit, ground.grid[static_cast<std::size_t>(ground.none.best_node)], held,
          ground.levels};
}

std::vector<MeterGap> gaps_of(const SiteProblem& site, const Ground& ground,
                              const HeldJudge& judge) {
  const JointFit& fit = ground.none;
  const Observations& held = judge.held;
  const NoiseNode& node = ground.grid[static_cast<std::size_t>(fit.best_node)];
  const MonthScores scores = judge.scores(fit, *ground.usual);
  std::vector<MeterGap> gaps;
  for (std::size_t g = 0; g < held.meters.size(); ++g) {
    const MeterRows& rows = held.meters[g];
    const auto column = static_cast<Eigen::Index>(g);
    double measured = 0.0;
    double difference = 0.0;
    for (const Eigen::Index row : rows.rows) {
      const DayPart& part = site.day_parts.parts[static_cast<std::size_t>(row)];
      measured += part.hours * site.measured_parts_kW(row, column);
      difference +=
          part.hours * (ground.none.parts_kW(row, column) - site.measured_parts_kW(row, column));
    }
    double log_score = 0.0;
    for (const auto& [month, score] : scores[g]) log_score += score;
    const MeterRows& fitted = ground.fit.meters[g];
    const auto n = static_cast<Eigen::Index>(fitted.rows.size());
    const ResidualShares shares = node.meters[g].residual_shares(
        fit.residual.segment(fitted.offset, n), fit.jacobian.middleRows(fitted.offset, n),
        fit.posterior.covariance);
    gaps.push_back({.nmbe_sim_minus_meas = measured > 0.0 ? difference / measured : kAbsent,
                    .cvrmse_daily = cvrmse_by(site, rows, column, ground.none.parts_kW,
                                              [](const DayPart& p) { return p.day_index; }),
                    .cvrmse_monthly = cvrmse_by(site, rows, column, ground.none.parts_kW,
                                                [](const DayPart& p) { return p.month; }),
                    .log_score = scores[g].empty()
                                     ? kAbsent
                                     : log_score / static_cast<double>(scores[g].size()),
                    .discrepancy_share = shares.structural / (shares.structural + shares.white)});
  }
  return gaps;
}

bool is_worse(const ScoreGain& meter) { return meter.sum < -2.0 * meter.se - 1.0; }

Eigen::ArrayXd held_errors_kW(const SiteProblem& site, const Eigen::ArrayXXd& parts_kW) {
  Eigen::ArrayXd squares = Eigen::ArrayXd::Zero(parts_kW.cols());
  Eigen::ArrayXd count = squares;
  for (Eigen::Index i = 0; i < parts_kW.rows(); ++i) {
    if (site.roles[static_cast<std::size_t>(i)] != Role::show) continue;
    for (Eigen::Index g = 0; g < parts_kW.cols(); ++g) {
      const double off_kW = parts_kW(i, g) - site.measured_parts_kW(i, g);
      if (!std::isfinite(off_kW)) continue;
      squares[g] += off_kW * off_kW;
      count[g] += 1.0;
    }
  }
  return (squares / count).sqrt();
}

bool is_confirmed(const MonthScores& change, const Eigen::ArrayXd& error_change_kW) {
  constexpr double kThreeToOne = 1.1;  // Nats.
  double shrunk_kW = 0.0;
  double grown_kW = 0.0;
  const std::vector<ScoreGain> gains = gain_by_meter(change);
  for (std::size_t g = 0; g < gains.size(); ++g) {
    const double change_kW = error_change_kW[static_cast<Eigen::Index>(g)];
    if (!std::isfinite(change_kW)) continue;
    shrunk_kW += std::max(-change_kW, 0.0);
    if (is_worse(gains[g])) grown_kW += std::max(change_kW, 0.0);
  }
  const ScoreGain all = gain_over(change);
  return all.sum > std::max(2.0 * all.se, kThreeToOne) && grown_kW <= kMostHarm * shrunk_kW;
}

GapChange change_of(std::vector<MeterGap> before, std::vector<MeterGap> after,
                    std::span<const MonthScores> changes) {
  const MonthScores sum = sum_of(changes);
  GapChange change{.before = std::move(before),
                   .after = std::move(after),
                   .log_score_change = gain_by_meter(sum)};
  for (std::size_t g = 0; g < sum.size(); ++g) {
    const double gain = change.log_score_change[g].sum;
    change.after[g].log_score =
        change.before[g].log_score + gain / static_cast<double>(sum[g].size());
  }
  return change;
}

}  // namespace recald::diagnosis
