#include "core/diagnosis/diagnose.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace recald::diagnosis {
namespace {

constexpr int kDraws = 200;

using Alterations = std::vector<std::shared_ptr<const model::hourly::Alteration>>;

Error cancelled() { return {ErrorCode::cancelled, "the diagnosis was cancelled"}; }

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

std::vector<double> monthly_impact_kWh(const SiteProblem& site, const Eigen::ArrayXXd& effect_kW) {
  std::vector<double> impact;
  for (Eigen::Index g = 0; g < effect_kW.cols(); ++g) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < effect_kW.rows(); ++i) {
      sum += site.day_parts.parts[static_cast<std::size_t>(i)].hours * effect_kW(i, g);
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
                    .null_scale = e.null_scale,
                    .monthly_kWh = {},
                    .effect_kW = e.fit.parts_kW - predictor.parts_kW(e.fit.theta)};
  addition.monthly_kWh = monthly_impact_kWh(site, addition.effect_kW);
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

/// One pass: where, who, which one. @param now  The model as it stands, with `accepted`.
Result<Pass> search(Predictor& predictor, const SiteProblem& site, const Ground& now,
                    const HeldJudge& shown, const std::vector<Candidate>& open,
                    const NamingRules& rules, Rng& rng) {
  auto located = locate(now.context(site), now.none, rng);
  if (!located) return tl::unexpected(located.error());
  auto look = look_at(predictor, now.context(site), now.none, open, rng);
  if (!look) return tl::unexpected(look.error());
  const auto unknown = unknown_log_evidence(site, now);
  if (!unknown) return tl::unexpected(unknown.error());
  const NamingData data{now.context(site), *unknown, now.select, now.levels, *now.usual};
  auto naming = name_effect(predictor, data, now.none, open, *look, rules);
  if (!naming) return tl::unexpected(naming.error());
  return Pass{.located = std::move(*located),
              .look = std::move(*look),
              .naming = std::move(*naming),
              .modelled_kW = now.none.parts_kW,
              .gaps = gaps_of(site, now, shown)};
}

void take_back(const char* why, Diagnosis& result) {
  result.not_confirmed = true;
  result.outcome = Outcome::unknown;
  result.why = why;
}

/// The verdict of the first pass, unless the months kept back do not bear out what was added.
void conclude(const SiteProblem& site, const Ground& first, const Ground& last, Diagnosis& result) {
  const Naming& verdict = result.passes.front().naming;
  result.outcome = verdict.outcome;
  result.why = verdict.why;
  if (result.added.empty()) return;
  if (first.show.count() == 0) {
    take_back(
        "no reading lies in the months kept back, so nothing confirms what was named and it "
        "was taken back",
        result);
    return;
  }
  double scale = 1.0;
  for (const Addition& addition : result.added) scale = std::max(scale, addition.null_scale);
  result.gap = change_of(site, first, last, scale);
  if (!result.gap->confirmed) {
    take_back(
        "what was named does not foretell the months that were kept back, so it was taken "
        "back",
        result);
  }
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
  auto first = lay_ground(
      base, site, options.rules.errs_as_learnt ? nullptr : std::make_shared<const UsualErrors>());
  if (!first) return tl::unexpected(first.error());
  result.base_fit = gaps_of(site, *first, judge_of(site, *first, first->fit));
  if (!first->none.converged) {
    result.warnings.push_back("The base calibration of the hourly model did not settle.");
  }
  const HeldJudge shown = judge_of(site, *first, first->show);
  std::optional<Ground> latest;  // of the model with what was added
  for (int turn = 0; turn <= options.additions_max; ++turn) {
    if (!go_on("looking for disagreement", 0.2 + 0.15 * turn)) return tl::unexpected(cancelled());
    Rng rng{options.seed, static_cast<std::uint64_t>(turn)};
    Predictor predictor{site, accepted};
    const std::vector<Candidate> open = still_open(list, result.added);
    auto pass = search(predictor, site, latest ? *latest : *first, shown, open, options.rules, rng);
    if (!pass) return tl::unexpected(pass.error());
    const bool named = pass->naming.outcome == Outcome::named && turn < options.additions_max;
    if (named) {
      result.added.push_back(addition_of(predictor, site, open, pass->naming, rng));
      const Addition& addition = result.added.back();
      accepted.push_back(alteration_of(addition.candidate, site.facts(), addition.eta));
    }
    result.passes.push_back(std::move(*pass));
    result.model_runs += predictor.runs();
    if (!named) break;
    Predictor altered{site, accepted};
    auto next = lay_ground(altered, site, first->usual);
    if (!next) return tl::unexpected(next.error());
    latest = std::move(*next);
    result.model_runs += altered.runs();
  }
  if (!go_on("showing", 0.95)) return tl::unexpected(cancelled());
  const Ground& last = latest ? *latest : *first;
  result.modelled_kW = last.none.parts_kW;
  result.gaps = gaps_of(site, last, shown);
  conclude(site, *first, last, result);
  result.model_runs += base.runs();
  return result;
}

}  // namespace recald::diagnosis
