#include "core/diagnosis/diagnose.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "core/diagnosis/evidence/candidate_shapes.hpp"
#include "core/diagnosis/evidence/monthly_impact.hpp"
#include "core/diagnosis/naming/learnt_names.hpp"
#include "core/display/id_words.hpp"
#include "core/random/rng.hpp"
#include "core/random/streams.hpp"

namespace recald::diagnosis {
namespace {

constexpr int kDraws = 200;

using Alterations = std::vector<std::shared_ptr<const model::hourly::Alteration>>;

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

double probability_of(const Naming& naming, const Candidate& candidate) {
  const auto found = std::ranges::find_if(naming.probabilities, [&](const NameProbability& p) {
    return p.effect == candidate.effect->id && p.meter == candidate.meter;
  });
  return found == naming.probabilities.end() ? 0.0 : found->probability;
}

Addition addition_of(Predictor& predictor, const SiteProblem& site,
                     const std::vector<Candidate>& candidates, const Naming& naming, Rng& rng) {
  const Explanation& e = naming.explanations[*naming.named];
  Addition addition{
      .candidate = candidates[e.candidate],
      .eta = e.fit.eta,
      .eta_sd = {},
      .draws = draw_effect(candidates[e.candidate], e.fit, rng),
      .probability = probability_of(naming, candidates[e.candidate]),
      .evidence_gain = e.evidence_gain,
      .monthly_kWh = {},
      .effect_kW = predictor.change_kW(
          e.fit.theta, *alteration_of(candidates[e.candidate], site.facts(), e.fit.eta))};
  addition.monthly_kWh =
      monthly_impact_kWh(site, addition.candidate, addition.eta, addition.effect_kW);
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

/// Values of a candidate's parameters to start a fit from.
std::vector<double> a_typical(const Candidate& candidate) {
  std::vector<double> values = shapes_to_try(candidate).front();
  for (std::size_t j = values.size(); j < candidate.parameters.size(); ++j) {
    values.push_back(candidate.parameters[j].prior.quantile(0.5));
  }
  return values;
}

/// Indices of the candidates in `open` with an id such as "scale_fault:steam".
Result<std::vector<std::size_t>> meant_by(const std::string& id, const std::vector<Candidate>& open,
                                          const SiteProblem& site, const CandidateList& list) {
  std::vector<std::size_t> meant;
  for (std::size_t i = 0; i < open.size(); ++i) {
    std::string key = open[i].key(site);
    if (key.ends_with('@')) key.pop_back();
    if (key == id || open[i].effect->id == id) meant.push_back(i);
  }
  if (!meant.empty()) return meant;
  for (const NotIdentifiable& hidden : list.not_identifiable) {
    if (hidden.effect == id) {
      return failure(ErrorCode::not_found, "'" + id + "' cannot be judged here: " + hidden.why);
    }
  }
  return failure(ErrorCode::not_found,
                 "'" + id + "' is not an effect of the catalogue, or the model already has it");
}

/// From the posterior, linearised in the scores.
std::vector<ParameterBelief> beliefs_of(const SiteProblem& site, const JointFit& fit) {
  constexpr double kQuantile95 = 1.6448536269514722;
  std::vector<ParameterBelief> beliefs;
  for (std::size_t j = 0; j < site.parameters.size(); ++j) {
    const auto k = static_cast<Eigen::Index>(j);
    const double reach = kQuantile95 * std::sqrt(fit.posterior.covariance(k, k));
    const auto value = [&](double score) { return site.parameters[j].prior.at_score(score).value; };
    beliefs.push_back({fit.theta[j], value(fit.scores[k] - reach), value(fit.scores[k] + reach)});
  }
  return beliefs;
}

void take_back(const char* why, Diagnosis& result) {
  result.not_confirmed = true;
  result.outcome = Outcome::unknown;
  result.why = why;
  result.parameters_after = result.parameters_before;
}

/// What one addition does to held-out months, and the base parameters with all additions so far.
struct Shown {
  HeldChange change;
  bool confirmed;
  std::vector<ParameterBelief> parameters = {};
};

/// Keeps the first `count` additions, as if the search had ended there.
void keep_first(std::size_t count, const std::vector<Shown>& shown, Diagnosis& result) {
  for (std::size_t i = count; i < result.added.size(); ++i) {
    result.warnings.push_back({"'" + std::string{result.added[i].candidate.effect->title} +
                               "' was named last and withdrawn: the held-out months do not "
                               "confirm it."});
  }
  result.added.resize(count);
  result.modelled_kW = result.passes[count].modelled_kW;
  result.gaps = result.passes[count].gaps;
  result.parameters_after = shown[count - 1].parameters;
}

/// The outcome of the first pass, unless the held-out months do not confirm the additions; then the
/// longest confirmed sequence of first additions.
/// @param shown  One per addition; empty if no month was held out.
void conclude(const std::vector<Shown>& shown, bool assumed, Diagnosis& result) {
  const Naming& verdict = result.passes.front().naming;
  result.outcome = verdict.outcome;
  result.why = verdict.why;
  if (result.added.empty()) return;
  if (shown.empty()) {
    take_back(
        "the held-out months have no readings, so nothing confirms what was named and it was "
        "withdrawn",
        result);
    return;
  }
  const auto doubtful = std::ranges::find_if(shown, [](const Shown& s) { return !s.confirmed; });
  const auto confirmed = static_cast<std::size_t>(doubtful - shown.begin());
  if (!assumed && confirmed > 0 && confirmed < shown.size()) keep_first(confirmed, shown, result);
  std::vector<HeldChange> changes;
  for (std::size_t i = 0; i < result.added.size(); ++i) changes.push_back(shown[i].change);
  result.gap = change_of(result.passes.front().gaps, result.gaps, changes);
  result.gap->confirmed = confirmed >= result.added.size();
  if (!assumed && confirmed == 0) {
    take_back(
        "what was named does not improve the prediction of the held-out months, so it was "
        "withdrawn",
        result);
  }
}

/// A diagnosis in progress: the current model and the findings so far.
class Search {
 public:
  /// @param proceed  Called before each run of the model.
  Search(const SiteProblem& site, const DiagnoseOptions& options, std::function<bool()> proceed)
      : site_(site),
        options_(options),
        proceed_(std::move(proceed)),
        before_show_(without_shown_months(site)),
        list_(list_candidates(before_show_)) {
    result_.not_identifiable = list_.not_identifiable;
    result_.not_identifiable.push_back(
        {"stuck_meter",
         "readings that stand still are marked as suspect and left out before a diagnosis"});
    result_.candidates = list_.candidates;
  }

  Result<void> begin() {
    Predictor base{site_, {}, proceed_, options_.executor};
    if (auto asked = ask(base); !asked) return asked;
    first_ = TRY(lay_ground(base, site_, question_.names.evidence.scores));
    result_.model_runs += base.runs();
    return {};
  }

  /// One pass, and the next model if an effect was named. @return whether to continue
  Result<bool> turn() {
    const std::size_t count = result_.passes.size();
    Rng rng{options_.seed, streams::kPasses[count]};
    Predictor predictor{site_, accepted_, proceed_, options_.executor};
    auto pass = TRY(search(predictor, rng));
    const bool named = pass.naming.outcome == Outcome::named && may_add(count);
    if (named) {
      result_.added.push_back(addition_of(predictor, site_, question_.open, pass.naming, rng));
      if (first_.show.count() > 0) shown_.push_back(show(pass.naming, predictor));
    }
    if (predictor.is_stopped()) return tl::unexpected(diagnosis_cancelled());
    result_.passes.push_back(std::move(pass));
    result_.model_runs += predictor.runs();
    if (!named) return false;
    const Naming& naming = result_.passes.back().naming;
    TRY(take_up(result_.added.back(), naming.explanations[*naming.named].fit));
    // An addition that the held-out months do not confirm is withdrawn, together
    // with all later ones.
    return question_.assumed || (!shown_.empty() && shown_.back().confirmed);
  }

  Diagnosis end() && {
    result_.modelled_kW = now().none.parts_kW;
    result_.gaps = gaps_of(site_, now(), judge_of(site_, first_, first_.show));
    // The rivals may have found a better mode of the drawings' model in the meantime; it
    // is final only now.
    result_.base_fit = gaps_of(site_, first_, judge_of(site_, first_, first_.fit));
    if (!first_.none.converged) {
      result_.warnings.push_back(
          {.sentence = "The base calibration of the hourly model did not converge, so no effect is "
                       "named.",
           .details = "Compare [building] with the drawings and look for a meter in a wrong unit.",
           .share = 1.0});
    }
    result_.parameters_before = beliefs_of(site_, first_.none);
    result_.parameters_after = beliefs_of(site_, now().none);
    conclude(shown_, !options_.assumed.empty(), result_);
    warn_of_harm();
    return std::move(result_);
  }

 private:
  void warn_of_harm() {
    if (!result_.gap || result_.not_confirmed) return;
    for (std::size_t g = 0; g < site_.meters.size(); ++g) {
      if (!grows_errors(result_.gap->error_cut[g])) continue;
      result_.warnings.push_back(
          {display::meter_label(site_.meters[g].id) +
               " is predicted worse than before in the held-out months.",
           "The model gets the side effect of the addition on this meter wrong."});
    }
  }

  [[nodiscard]] const Ground& now() const { return latest_ ? *latest_ : first_; }
  [[nodiscard]] Ground& now() { return latest_ ? *latest_ : first_; }

  /// What the signatures of the meters say of the effects that the model does not have yet.
  Result<void> ask(Predictor& predictor) {
    const std::size_t count = result_.passes.size();
    question_ = {.open = still_open(list_, result_.added)};
    if (count >= options_.assumed.size()) {
      question_.names =
          names_by(evidence_of(before_show_, question_.open, learnt_null(), predictor),
                   learnt_weights(), options_.prior_none);
    } else if (auto assumed = assume(options_.assumed[count], predictor); !assumed) {
      return assumed;
    }
    if (predictor.is_stopped()) return tl::unexpected(diagnosis_cancelled());
    return {};
  }

  /// Where the signatures put an effect that is known to be present.
  Result<void> assume(const std::string& id, Predictor& predictor) {
    const auto meant = TRY(meant_by(id, question_.open, site_, list_));
    std::vector<Candidate> asked;
    for (const std::size_t i : meant) asked.push_back(question_.open[i]);
    SignatureEvidence evidence = evidence_of(before_show_, asked, learnt_null(), predictor);
    if (evidence.effects.empty()) {  // Other meters may still show it.
      question_.assumed = {meant.front(), a_typical(asked.front())};
    } else {
      const EffectEvidence& e = evidence.effects.front();
      const auto which = static_cast<std::size_t>(e.shape.candidate - asked.data());
      question_.assumed = {meant[which], e.values, e.scores};
    }
    question_.names.evidence = {.scores = std::move(evidence.scores)};
    return {};
  }

  /// One pass: where the gap is, and which effect explains it.
  Result<Pass> search(Predictor& predictor, Rng& rng) {
    if (!result_.passes.empty()) {
      TRY(ask(predictor));
    }
    auto located = TRY(locate(now().context(site_), now().none, rng));
    auto naming = TRY(question_.assumed ? take_as_named(predictor, site_, *question_.assumed,
                                                        question_.open, options_.rules, now())
                                        : name_effect(predictor, site_, question_.names,
                                                      question_.open, options_.rules, now()));
    return Pass{.located = std::move(located),
                .naming = std::move(naming),
                .modelled_kW = now().none.parts_kW,
                .gaps = gaps_of(site_, now(), judge_of(site_, first_, first_.show))};
  }

  [[nodiscard]] bool may_add(std::size_t count) const {
    return count < (options_.assumed.empty() ? static_cast<std::size_t>(options_.additions_max)
                                             : options_.assumed.size());
  }

  /// What the effect just named does to held-out months, on the ground where it was found.
  /// @param predictor  Of the model without it.
  [[nodiscard]] Shown show(const Naming& naming, Predictor& predictor) const {
    const Explanation& e = naming.explanations[*naming.named];
    const HeldJudge judge = judge_of(site_, now(), now().show);
    const JointFit& base = now().none;
    HeldChange change{difference(judge.scores(e.fit, *now().usual),  //
                                 judge.scores(base, *now().usual)),
                      error_cuts(site_, e.fit.parts_kW, base.parts_kW)};
    const bool confirmed = is_confirmed(
        change.error_cuts, months_moved(site_, e.fit.parts_kW, predictor.parts_kW(e.fit.theta)),
        held_errors_kW(site_, e.fit.parts_kW) - held_errors_kW(site_, base.parts_kW));
    return {std::move(change), confirmed};
  }

  /// Adds the effect to the model. @param found  The base parameters fitted together with it.
  Result<void> take_up(const Addition& addition, const JointFit& found) {
    accepted_.push_back(alteration_of(addition.candidate, site_.facts(), addition.eta));
    Predictor altered{site_, accepted_, proceed_, options_.executor};
    latest_ = TRY(lay_next_ground(altered, site_, now(), found));
    if (!shown_.empty()) shown_.back().parameters = beliefs_of(site_, latest_->none);
    result_.model_runs += altered.runs();
    return {};
  }

  /// Which effects the model does not have yet, and what the signatures say of them.
  struct Question {
    std::vector<Candidate> open;
    SignatureNames names;
    std::optional<EffectStart> assumed = {};  ///< Then nothing else is asked.
  };

  const SiteProblem& site_;
  const DiagnoseOptions& options_;
  std::function<bool()> proceed_;
  SiteProblem before_show_;  ///< What may be known before the final check.
  CandidateList list_;
  Question question_;
  Alterations accepted_;
  Ground first_;
  std::optional<Ground> latest_;  ///< Of the model with all additions.
  std::vector<Shown> shown_;
  Diagnosis result_;
};

}  // namespace

Result<Diagnosis> diagnose(const SiteProblem& site, const DiagnoseOptions& options,
                           const Observer& observer) {
  const char* what = "calibrating the hourly model";
  double share = 0.0;
  const auto go_on = [&] { return !observer || observer(what, share); };
  Search search{site, options, go_on};
  if (!go_on()) return tl::unexpected(diagnosis_cancelled());
  TRY(search.begin());
  for (int turn = 0;; ++turn) {
    what = "looking for disagreements";
    share = 0.2 + 0.15 * turn;
    if (!go_on()) return tl::unexpected(diagnosis_cancelled());
    const auto more = TRY(search.turn());
    if (!more) break;
  }
  what = "showing";
  share = 0.95;
  if (!go_on()) return tl::unexpected(diagnosis_cancelled());
  return std::move(search).end();
}

}  // namespace recald::diagnosis
