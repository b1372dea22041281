#include "core/diagnosis/check/gap.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/absent.hpp"

namespace recald::diagnosis {
namespace {

// Of what the errors of other meters shrink by.
constexpr double kMostHarm = 0.25;
// Of a meter's mean square error, for each month.
constexpr double kLeastOfMean = 0.1;

double square(double x) { return x * x; }

struct SquareSums {
  double with = 0.0;
  double without = 0.0;
  double count = 0.0;

  void add(double of_with, double of_without) {
    with += of_with;
    without += of_without;
    count += 1.0;
  }
};

/// Month by month. @param part  The scores to add.
MonthScores sum_of(std::span<const HeldChange> changes, MonthScores HeldChange::*part) {
  MonthScores sum;
  for (const HeldChange& change : changes) {
    const MonthScores& added = change.*part;
    sum.resize(added.size());
    for (std::size_t g = 0; g < added.size(); ++g) {
      for (const auto& [month, score] : added[g]) sum[g][month] += score;
    }
  }
  return sum;
}

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

bool is_worse(const ScoreGain& scores) { return scores.sum < -2.0 * scores.se - 1.0; }

bool grows_errors(const ScoreGain& error_cut) { return error_cut.sum < -2.0 * error_cut.se; }

MonthScores error_cuts(const SiteProblem& site, const Eigen::ArrayXXd& with_kW,
                       const Eigen::ArrayXXd& without_kW) {
  MonthScores cuts;
  for (Eigen::Index g = 0; g < with_kW.cols(); ++g) {
    std::map<int, SquareSums> months;
    SquareSums all;
    for (Eigen::Index i = 0; i < with_kW.rows(); ++i) {
      const auto part = static_cast<std::size_t>(i);
      const double measured_kW = site.measured_parts_kW(i, g);
      if (site.roles[part] != Role::show || !std::isfinite(measured_kW)) continue;
      const double with = square(with_kW(i, g) - measured_kW);
      const double without = square(without_kW(i, g) - measured_kW);
      months[site.day_parts.parts[part].month].add(with, without);
      all.add(with, without);
    }
    const double least = kLeastOfMean * std::min(all.with, all.without) / all.count;
    std::map<int, double>& cut = cuts.emplace_back();
    for (const auto& [month, sums] : months) {
      const double without = sums.without / sums.count + least;
      const double with = sums.with / sums.count + least;
      cut[month] = with > 0.0 && without > 0.0 ? 0.5 * std::log(without / with) : 0.0;
    }
  }
  return cuts;
}

std::set<int> months_moved(const SiteProblem& site, const Eigen::ArrayXXd& with_kW,
                           const Eigen::ArrayXXd& without_kW) {
  constexpr double kLeastShare = 0.01;
  std::map<int, double> moved_kW;
  double most_kW = 0.0;
  for (Eigen::Index i = 0; i < with_kW.rows(); ++i) {
    double& month_kW = moved_kW[site.day_parts.parts[static_cast<std::size_t>(i)].month];
    month_kW += (with_kW.row(i) - without_kW.row(i)).abs().sum();
    most_kW = std::max(most_kW, month_kW);
  }
  std::set<int> months;
  for (const auto& [month, kW] : moved_kW) {
    if (kW > kLeastShare * most_kW) months.insert(month);
  }
  return months;
}

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

bool is_confirmed(const MonthScores& error_cuts, const std::set<int>& moved,
                  const Eigen::ArrayXd& error_change_kW) {
  double shrunk_kW = 0.0;
  double grown_kW = 0.0;
  const std::vector<ScoreGain> cuts = gain_by_meter(error_cuts);
  std::size_t months = 0;
  for (std::size_t g = 0; g < cuts.size(); ++g) {
    months = std::max(months, error_cuts[g].size());
    const double change_kW = error_change_kW[static_cast<Eigen::Index>(g)];
    if (!std::isfinite(change_kW)) continue;
    shrunk_kW += std::max(-change_kW, 0.0);
    if (grows_errors(cuts[g])) grown_kW += std::max(change_kW, 0.0);
  }
  const ScoreGain all = gain_over(error_cuts, moved);
  return months >= 2 && all.sum > 2.0 * all.se && grown_kW <= kMostHarm * shrunk_kW;
}

GapChange change_of(std::vector<MeterGap> before, std::vector<MeterGap> after,
                    std::span<const HeldChange> changes) {
  const MonthScores scores = sum_of(changes, &HeldChange::log_scores);
  GapChange change{.before = std::move(before),
                   .after = std::move(after),
                   .log_score_change = gain_by_meter(scores),
                   .error_cut = gain_by_meter(sum_of(changes, &HeldChange::error_cuts))};
  for (std::size_t g = 0; g < scores.size(); ++g) {
    const double gain = change.log_score_change[g].sum;
    change.after[g].log_score =
        change.before[g].log_score + gain / static_cast<double>(scores[g].size());
  }
  return change;
}

}  // namespace recald::diagnosis
