#include "tests/blind/scoring/gap_scores.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/blind/scoring/naming_scores.hpp"

namespace recald::blind {
namespace {

constexpr double kHarmStandardErrors = 2.0;

bool is_catalogued(const ScoredCase& scored) {
  return scored.answer->block == Block::single || scored.answer->block == Block::pair;
}

bool has_addition(const ScoredCase& scored) { return scored.result->outcome == Outcome::named; }

/// The three fits of a case, as far as they are known.
std::optional<Gap> full_gap(const ScoredCase& scored, const OracleGaps& oracles) {
  const auto oracle = oracles.find(scored.answer->case_id);
  std::optional<Gap> gap = scored.result->gap;
  if (oracle == oracles.end()) return gap;
  if (!gap && !has_addition(scored)) {
    gap = Gap{.before = oracle->second.before, .after = oracle->second.before};
  }
  if (gap && !gap->oracle) gap->oracle = oracle->second.after;
  return gap;
}

/// Minus the log score, summed over the meters of `meters`; empty if `fits` lacks one.
std::optional<double> log_loss_of(const FitOfMeter& fits, const FitOfMeter& meters) {
  double loss = 0.0;
  for (const auto& [meter, ignored] : meters) {
    const auto fit = fits.find(meter);
    if (fit == fits.end()) return std::nullopt;
    loss -= fit->second.log_score;
  }
  return loss;
}

std::optional<double> cvrmse_of(const FitOfMeter& fits, const std::string& meter) {
  const auto fit = fits.find(meter);
  return fit == fits.end() ? std::nullopt : std::optional(fit->second.cvrmse);
}

std::optional<double> reduction(std::optional<double> before, std::optional<double> after,
                                std::optional<double> oracle) {
  if (!before || !after || !oracle || !(*oracle < *before)) return std::nullopt;
  return (*before - *after) / (*before - *oracle);
}

bool is_harmful(const ScoredCase& scored) {
  return std::ranges::any_of(scored.result->other_meters, [](const auto& meter_and_change) {
    const LogScoreChange& change = meter_and_change.second;
    return change.mean < -kHarmStandardErrors * change.se;
  });
}

/// Values of R, each list for one median.
struct Reductions {
  std::vector<double> cvrmse;
  std::vector<double> log_score;

  void add(const GapReduction& reduction) {
    if (reduction.cvrmse) cvrmse.push_back(*reduction.cvrmse);
    if (reduction.log_score) log_score.push_back(*reduction.log_score);
  }
};

void score_reductions(const ScoredCases& cases, const OracleGaps& oracles, GapScores& scores) {
  Reductions claimed;
  Reductions all;
  for (const ScoredCase& scored : cases) {
    if (!is_catalogued(scored)) continue;
    const GapReduction reduction = gap_reduction(scored, oracles);
    all.add(reduction);
    if (!has_addition(scored) || !is_large(*scored.answer)) continue;
    ++scores.large_named;
    claimed.add(reduction);
  }
  scores.cvrmse = median_score(std::move(claimed.cvrmse));
  scores.log_score = median_score(std::move(claimed.log_score));
  scores.cvrmse_all = median_score(std::move(all.cvrmse));
  scores.log_score_all = median_score(std::move(all.log_score));
}

BiasScores bias_scores(const ScoredCases& cases) {
  std::vector<double> before, after, ratio;
  for (const ScoredCase& scored : cases) {
    if (!is_catalogued(scored) || !has_addition(scored)) continue;
    const auto was = mean_bias(*scored.answer, scored.result->parameters_before);
    const auto is = mean_bias(*scored.answer, scored.result->parameters_after);
    if (!was || !is) continue;
    before.push_back(*was);
    after.push_back(*is);
    if (*was > 0.0) ratio.push_back(*is / *was);
  }
  return {.before = median_score(std::move(before)),
          .after = median_score(std::move(after)),
          .ratio = median_score(std::move(ratio))};
}

void score_effect_intervals(const ScoredCases& cases, GapScores& scores) {
  int all = 0;
  int covered = 0;
  for (const ScoredCase& scored : cases) {
    const auto& interval = scored.result->effect_parameter;
    if (scored.answer->block != Block::single || !scored.judgement.right || !interval) continue;
    const HiddenEffect& effect = scored.answer->effects.front();
    if (!interval->unit.empty() && interval->unit != effect.unit) {
      ++scores.other_units;
      continue;
    }
    ++all;
    if (interval->q05 <= effect.strength && effect.strength <= interval->q95) ++covered;
  }
  scores.effect_coverage = share_score(covered, all);
}

std::vector<std::string> without_truth(const ScoredCases& cases) {
  std::set<std::string> names;
  for (const ScoredCase& scored : cases) {
    for (const auto* posteriors :
         {&scored.result->parameters_before, &scored.result->parameters_after}) {
      for (const auto& [name, ignored] : *posteriors) {
        if (!scored.answer->true_parameters.contains(name)) names.insert(name);
      }
    }
  }
  return {names.begin(), names.end()};
}

}  // namespace

OracleGaps oracle_gaps(std::span<const CaseResult> results) {
  OracleGaps gaps;
  for (const CaseResult& result : results) {
    if (result.method == kOracle && result.gap) gaps[result.case_id] = *result.gap;
  }
  return gaps;
}

GapReduction gap_reduction(const ScoredCase& scored, const OracleGaps& oracles) {
  const std::optional<Gap> gap = full_gap(scored, oracles);
  if (!gap || !gap->oracle) return {};
  const std::string meter = most_affected_meter(*scored.answer);
  return {.cvrmse = reduction(cvrmse_of(gap->before, meter), cvrmse_of(gap->after, meter),
                              cvrmse_of(*gap->oracle, meter)),
          .log_score =
              reduction(log_loss_of(gap->before, gap->before), log_loss_of(gap->after, gap->before),
                        log_loss_of(*gap->oracle, gap->before))};
}

std::optional<double> mean_bias(const Answer& answer,
                                const std::map<std::string, Posterior>& posteriors) {
  double sum = 0.0;
  int shared = 0;
  for (const auto& [name, posterior] : posteriors) {
    const auto truth = answer.true_parameters.find(name);
    if (truth == answer.true_parameters.end()) continue;
    sum += std::abs(posterior.mean - truth->second) / answer.prior_sd.at(name);
    ++shared;
  }
  if (shared == 0) return std::nullopt;
  return sum / shared;
}

GapScores gap_scores(const ScoredCases& cases, const OracleGaps& oracles) {
  GapScores scores;
  score_reductions(cases, oracles, scores);
  const auto has_figures = [](const ScoredCase& scored) {
    return has_addition(scored) && !scored.result->other_meters.empty();
  };
  scores.harm = share_of(cases, has_figures, is_harmful);
  scores.additions_without_harm_figures =
      static_cast<int>(std::ranges::count_if(cases, [&](const ScoredCase& scored) {
        return has_addition(scored) && !has_figures(scored);
      }));
  scores.bias = bias_scores(cases);
  score_effect_intervals(cases, scores);
  scores.parameters_without_truth = without_truth(cases);
  return scores;
}

}  // namespace recald::blind
