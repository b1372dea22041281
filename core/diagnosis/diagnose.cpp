#include "core/diagnosis/diagnose.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace recald::diagnosis {
namespace {

constexpr Eigen::Index kLeastParts = 100;
constexpr int kDraws = 200;
// Spread of residuals in the upper half of the levels over that in the lower half, beyond which a
// meter is judged on the square-root scale.
constexpr double kSpreadRatio = 1.6;

using Alterations = std::vector<std::shared_ptr<const model::hourly::Alteration>>;

Error cancelled() { return {ErrorCode::cancelled, "the diagnosis was cancelled"}; }

/// Root mean square of the residuals at the upper half of the modelled levels over the lower half.
double spread_ratio(const Observations& observations, std::size_t meter,
                    const Eigen::VectorXd& residual, const Eigen::VectorXd& modelled) {
  const MeterRows& rows = observations.meters[meter];
  const auto n = static_cast<Eigen::Index>(rows.rows.size());
  std::vector<std::pair<double, double>> by_level;
  for (Eigen::Index i = rows.offset; i < rows.offset + n; ++i) {
    by_level.emplace_back(modelled[i], residual[i] * residual[i]);
  }
  std::ranges::sort(by_level);
  double low = 0.0;
  double high = 0.0;
  for (std::size_t i = 0; i < by_level.size(); ++i) {
    (2 * i < by_level.size() ? low : high) += by_level[i].second;
  }
  return std::sqrt(high / std::max(low, 1e-12));
}

/// Observations, noise and the base fit of one model version.
struct Ground {
  Observations fit;
  Observations unknown;
  Observations select;
  Observations show;
  std::vector<NoiseLevel> levels;
  std::vector<NoiseNode> grid;
  std::vector<NoiseNode> unknown_grid;
  JointFit none;

  [[nodiscard]] FitContext context(const SiteProblem& site) const {
    return {site, fit, grid, grid.size() / 2};
  }
};

Result<std::vector<NoiseLevel>> levels_of(const Observations& observations,
                                          const Eigen::VectorXd& residual) {
  std::vector<NoiseLevel> levels;
  for (const MeterRows& meter : observations.meters) {
    const auto n = static_cast<Eigen::Index>(meter.rows.size());
    auto fitted =
        fit_levels(residual.segment(meter.offset, n), meter.design, std::max(meter.mean_kW, 1e-6));
    if (!fitted) return tl::unexpected(fitted.error());
    levels.push_back(fitted->level);
  }
  return levels;
}

/// First levels before any residual is known: what the priors expect.
std::vector<NoiseLevel> first_levels(const Observations& observations) {
  std::vector<NoiseLevel> levels;
  for (const MeterRows& meter : observations.meters) {
    const double mean = std::max(meter.mean_kW, 1e-6);
    levels.push_back({.structure_sd = 0.1 * mean,
                      .correlation_h = 48.0,
                      .white_sd = 0.1 * mean,
                      .pattern_sd = 0.02 * mean});
  }
  return levels;
}

Result<void> set_gates(Observations& observations, const Eigen::VectorXd& residual,
                       std::span<const NoiseLevel> levels) {
  std::vector<Eigen::VectorXd> residuals;
  for (const MeterRows& meter : observations.meters) {
    residuals.push_back(
        residual.segment(meter.offset, static_cast<Eigen::Index>(meter.rows.size())));
  }
  std::vector<GateInput> inputs;
  for (std::size_t g = 0; g < observations.meters.size(); ++g) {
    inputs.push_back({observations.meters[g].design, residuals[g], levels[g]});
  }
  const auto gates = choose_gates(inputs);
  for (std::size_t g = 0; g < gates.size(); ++g) observations.meters[g].design.gated = gates[g];
  return {};
}

/// Scales, noise and mode of the base model, by turns: the first fit finds the scales, the second
/// the noise, the third stands.
Result<Ground> lay_ground(Predictor& predictor, const SiteProblem& site) {
  Ground ground;
  std::vector<ResidualScale> scales(site.meters.size(), ResidualScale::linear);
  const auto fit_parts = parts_of(site, {Role::fit});
  Eigen::VectorXd start = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(site.parameters.size()));
  for (int round = 0; round < 3; ++round) {
    ground.fit = observe(site, fit_parts, scales, Patterns::modest);
    for (const MeterRows& meter : ground.fit.meters) {
      if (static_cast<Eigen::Index>(meter.rows.size()) < kLeastParts) {
        return failure(ErrorCode::not_enough_data,
                       "a meter has fewer than 100 measured four-hour parts in the months to fit; "
                       "leave it out of the model's outputs or give more readings");
      }
    }
    if (round == 0) {
      ground.levels = first_levels(ground.fit);
    } else {
      auto levels =
          levels_of(ground.fit, ground.fit.measured - ground.fit.stack(ground.none.parts_kW));
      if (!levels) return tl::unexpected(levels.error());
      ground.levels = std::move(*levels);
      if (auto set =
              set_gates(ground.fit, ground.fit.measured - ground.fit.stack(ground.none.parts_kW),
                        ground.levels);
          !set) {
        return tl::unexpected(set.error());
      }
    }
    ground.grid = noise_grid(ground.fit, ground.levels, round == 2);
    auto none = fit_jointly(predictor, ground.context(site), Candidate{}, start);
    if (!none) return tl::unexpected(none.error());
    ground.none = std::move(*none);
    start = ground.none.scores;
    if (round > 0) continue;
    const Eigen::VectorXd modelled = ground.fit.stack(ground.none.parts_kW);
    for (std::size_t g = 0; g < scales.size(); ++g) {
      if (spread_ratio(ground.fit, g, ground.none.residual, modelled) > kSpreadRatio) {
        scales[g] = ResidualScale::square_root;
      }
    }
  }
  ground.unknown = observe(site, fit_parts, scales, Patterns::generous);
  for (std::size_t g = 0; g < ground.unknown.meters.size(); ++g) {
    ground.unknown.meters[g].design.gated = ground.fit.meters[g].design.gated;
  }
  std::vector<NoiseLevel> generous = ground.levels;
  for (NoiseLevel& level : generous) level.pattern_sd *= 5.0;
  ground.unknown_grid = noise_grid(ground.unknown, generous, true);
  ground.select = observe(site, parts_of(site, {Role::select}), scales, Patterns::modest);
  ground.show = observe(site, parts_of(site, {Role::show}), scales, Patterns::modest);
  return ground;
}

struct HeldScores {
  std::vector<std::map<int, double>> by_month;  ///< (m) log density of each held month.
};

HeldScores held_scores(const SiteProblem& site, const Observations& held,
                       std::span<const NoiseLevel> levels, const Eigen::ArrayXXd& parts_kW) {
  HeldScores scores{std::vector<std::map<int, double>>(held.meters.size())};
  const Eigen::VectorXd residual = held.measured - held.stack(parts_kW);
  for (std::size_t g = 0; g < held.meters.size(); ++g) {
    const MeterRows& meter = held.meters[g];
    const auto month_at = [&](std::size_t i) {
      return site.day_parts.parts[static_cast<std::size_t>(meter.rows[i])].month;
    };
    for (std::size_t begin = 0, end = 0; begin < meter.rows.size(); begin = end) {
      while (end < meter.rows.size() && month_at(end) == month_at(begin)) ++end;
      const auto first = static_cast<Eigen::Index>(begin);
      const auto n = static_cast<Eigen::Index>(end - begin);
      const BlockDesign month{
          meter.design.times_h.segment(first, n), meter.design.patterns.middleRows(first, n), {}};
      scores.by_month[g][month_at(begin)] = BlockNoise{month, levels[g]}.marginal_log_density(
          residual.segment(meter.offset + first, n));
    }
  }
  return scores;
}

/// Root mean square error over groups of parts (days, months), of the mean of the groups.
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
  return n > 1.0 && total > 0.0 ? std::sqrt(squares / (n - 1.0)) / (total / n) : 0.0;
}

std::vector<MeterGap> gaps_of(const SiteProblem& site, const Ground& ground,
                              const Observations& held, const JointFit& fit) {
  std::vector<MeterGap> gaps;
  const HeldScores scores = held_scores(site, held, ground.levels, fit.parts_kW);
  const NoiseNode& node = ground.grid[static_cast<std::size_t>(fit.best_node)];
  for (std::size_t g = 0; g < held.meters.size(); ++g) {
    const MeterRows& rows = held.meters[g];
    const auto column = static_cast<Eigen::Index>(g);
    double measured = 0.0;
    double difference = 0.0;
    for (const Eigen::Index row : rows.rows) {
      const DayPart& part = site.day_parts.parts[static_cast<std::size_t>(row)];
      measured += part.hours * site.measured_parts_kW(row, column);
      difference += part.hours * (fit.parts_kW(row, column) - site.measured_parts_kW(row, column));
    }
    double log_score = 0.0;
    for (const auto& [month, score] : scores.by_month[g]) log_score += score;
    const MeterRows& fitted = ground.fit.meters[g];
    const auto n = static_cast<Eigen::Index>(fitted.rows.size());
    const ResidualShares shares = node.meters[g].residual_shares(
        fit.residual.segment(fitted.offset, n), fit.jacobian.middleRows(fitted.offset, n),
        fit.posterior.covariance);
    gaps.push_back({.nmbe_sim_minus_meas = measured > 0.0 ? difference / measured : 0.0,
                    .cvrmse_daily = cvrmse_by(site, rows, column, fit.parts_kW,
                                              [](const DayPart& p) { return p.day_index; }),
                    .cvrmse_monthly = cvrmse_by(site, rows, column, fit.parts_kW,
                                                [](const DayPart& p) { return p.month; }),
                    .log_score = scores.by_month[g].empty()
                                     ? 0.0
                                     : log_score / static_cast<double>(scores.by_month[g].size()),
                    .discrepancy_share = shares.structural / (shares.structural + shares.white)});
  }
  return gaps;
}

GapChange change_of(const SiteProblem& site, const Ground& before, const Ground& after) {
  GapChange change;
  change.before = gaps_of(site, before, before.show, before.none);
  change.after = gaps_of(site, after, before.show, after.none);
  // Both judged by the noise of the model before: a change of noise is no better model.
  const HeldScores old_scores = held_scores(site, before.show, before.levels, before.none.parts_kW);
  const HeldScores new_scores = held_scores(site, before.show, before.levels, after.none.parts_kW);
  std::map<int, double> months;
  bool worse = false;
  const auto sum_and_se = [](const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    double sum = 0.0;
    double squares = 0.0;
    for (const double v : values) {
      sum += v;
      squares += v * v;
    }
    const double se =
        n > 1.0 ? std::sqrt(n * std::max(squares - sum * sum / n, 0.0) / (n - 1.0)) : 0.0;
    return std::pair{sum, se};
  };
  for (std::size_t g = 0; g < old_scores.by_month.size(); ++g) {
    std::vector<double> differences;
    for (const auto& [month, score] : old_scores.by_month[g]) {
      differences.push_back(new_scores.by_month[g].at(month) - score);
      months[month] += differences.back();
    }
    const auto [sum, se] = sum_and_se(differences);
    change.log_score_change.push_back(sum);
    change.log_score_se.push_back(se);
    worse = worse || sum < -2.0 * se - 1.0;
  }
  std::vector<double> totals;
  for (const auto& [month, difference] : months) totals.push_back(difference);
  const auto [sum, se] = sum_and_se(totals);
  change.confirmed = sum > 2.0 * se && !worse;
  return change;
}

/// Draws of the effect's parameters from the linearised posterior of all scores.
std::vector<std::vector<double>> draw_effect(const Candidate& candidate, const JointFit& fit,
                                             Rng& rng) {
  const auto r = static_cast<Eigen::Index>(candidate.parameters.size());
  const Eigen::MatrixXd covariance = fit.posterior.covariance.bottomRightCorner(r, r);
  const Eigen::MatrixXd root = covariance.llt().matrixL();
  const std::vector<Prior> priors = priors_of(candidate);
  std::vector<std::vector<double>> draws;
  for (int i = 0; i < kDraws; ++i) {
    Eigen::VectorXd normal(r);
    for (Eigen::Index j = 0; j < r; ++j) normal[j] = rng.normal();
    draws.push_back(values_at(priors, fit.scores.tail(r) + root * normal));
  }
  return draws;
}

std::vector<double> monthly_impact_kWh(const SiteProblem& site, const Eigen::ArrayXXd& with_kW,
                                       const Eigen::ArrayXXd& without_kW) {
  std::vector<double> impact;
  for (Eigen::Index g = 0; g < with_kW.cols(); ++g) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < with_kW.rows(); ++i) {
      sum += site.day_parts.parts[static_cast<std::size_t>(i)].hours *
             (with_kW(i, g) - without_kW(i, g));
    }
    impact.push_back(sum / static_cast<double>(site.drivers->months.size()));
  }
  return impact;
}

Addition addition_of(Predictor& predictor, const SiteProblem& site,
                     const std::vector<Candidate>& candidates, const Naming& naming, Rng& rng) {
  const Explanation& e = naming.explanations[*naming.named];
  Addition addition{.candidate = candidates[e.candidate],
                    .eta = e.fit.eta,
                    .eta_sd = {},
                    .draws = draw_effect(candidates[e.candidate], e.fit, rng),
                    .probability = naming.probabilities.front().probability,
                    .evidence_gain = e.evidence_gain,
                    .monthly_kWh = {}};
  for (std::size_t j = 0; j < addition.eta.size(); ++j) {
    double sum = 0.0;
    double squares = 0.0;
    for (const auto& draw : addition.draws) {
      sum += draw[j];
      squares += draw[j] * draw[j];
    }
    const double n = kDraws;
    addition.eta_sd.push_back(std::sqrt(std::max(squares / n - sum * sum / n / n, 0.0)));
  }
  const Eigen::ArrayXXd without_kW = predictor.parts_kW(e.fit.theta);
  addition.monthly_kWh = monthly_impact_kWh(site, e.fit.parts_kW, without_kW);
  return addition;
}

/// Candidates that are not in the model yet.
std::vector<Candidate> still_open(const CandidateList& list, const std::vector<Addition>& added) {
  std::vector<Candidate> open;
  for (const Candidate& candidate : list.candidates) {
    const bool taken = std::ranges::any_of(added, [&](const Addition& addition) {
      return addition.candidate.effect == candidate.effect &&
             addition.candidate.meter == candidate.meter;
    });
    if (!taken) open.push_back(candidate);
  }
  return open;
}

}  // namespace

Result<Diagnosis> diagnose(const SiteProblem& site, const DiagnoseOptions& options,
                           const Observer& observer) {
  const auto go_on = [&](const char* what, double share) {
    return !observer || observer(what, share);
  };
  Diagnosis result;
  CandidateList list = list_candidates(site);
  result.not_identifiable = list.not_identifiable;
  result.candidates = list.candidates;

  if (!go_on("calibrating the hourly model", 0.0)) return tl::unexpected(cancelled());
  Alterations accepted;
  Predictor base{site};
  auto first = lay_ground(base, site);
  if (!first) return tl::unexpected(first.error());
  result.base_fit = gaps_of(site, *first, first->fit, first->none);
  if (!first->none.converged) {
    result.warnings.push_back("The base calibration of the hourly model did not settle.");
  }
  Ground now = *first;
  for (int turn = 0; turn <= options.additions_max; ++turn) {
    if (!go_on("looking for disagreement", 0.2 + 0.15 * turn)) return tl::unexpected(cancelled());
    Rng rng{options.seed, static_cast<std::uint64_t>(turn)};
    Predictor predictor{site, accepted};
    const std::vector<Candidate> open = still_open(list, result.added);
    auto located = locate(now.context(site), now.none, rng);
    if (!located) return tl::unexpected(located.error());
    auto look = look_at(predictor, now.context(site), now.none, open, rng);
    if (!look) return tl::unexpected(look.error());
    const NamingData data{now.context(site), now.unknown, now.unknown_grid, now.select, now.levels};
    auto naming = name_effect(predictor, data, now.none, open, *look, options.rules);
    if (!naming) return tl::unexpected(naming.error());
    const bool named = naming->outcome == Outcome::named && turn < options.additions_max;
    if (named) {
      result.added.push_back(addition_of(predictor, site, open, *naming, rng));
      const Addition& addition = result.added.back();
      accepted.push_back(alteration_of(addition.candidate, site.facts(), addition.eta));
    }
    result.passes.push_back({std::move(*located), std::move(*look), std::move(*naming)});
    if (!named) break;
    Predictor altered{site, accepted};
    auto next = lay_ground(altered, site);
    if (!next) return tl::unexpected(next.error());
    now = std::move(*next);
    result.model_runs += predictor.runs() + altered.runs();
  }
  result.outcome = result.added.empty() ? result.passes.front().naming.outcome : Outcome::named;
  if (!result.added.empty() && first->show.count() > 0) {
    if (!go_on("showing", 0.95)) return tl::unexpected(cancelled());
    result.gap = change_of(site, *first, now);
    result.not_confirmed = !result.gap->confirmed;
    if (result.not_confirmed) {
      result.outcome = Outcome::unknown;
      result.warnings.push_back(
          "The months that were kept back do not confirm what was named; nothing was added.");
    }
  }
  result.model_runs += base.runs();
  return result;
}

}  // namespace recald::diagnosis
