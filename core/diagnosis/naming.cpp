#include "core/diagnosis/naming.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/diagnosis/check/gap.hpp"
#include "core/diagnosis/effect_posterior.hpp"
#include "core/diagnosis/evidence/candidate_shapes.hpp"

namespace recald::diagnosis {
namespace {

// Of the prior's range: a value this near its upper bound counts as limited by it.
constexpr double kNearEnd = 0.05;
constexpr FitOptions kFineFit{.iterations_max = 40};

/// sum |with - without| / sum without, for the meter where it is largest.
double largest_move(const Eigen::ArrayXXd& with_kW, const Eigen::ArrayXXd& without_kW) {
  const Eigen::ArrayXd moved = (with_kW - without_kW).abs().colwise().sum().transpose();
  const Eigen::ArrayXd whole = without_kW.abs().colwise().sum().transpose();
  return (moved / whole.max(1e-9)).maxCoeff();
}

bool is_at_truncation(const Candidate& candidate, const JointFit& fit) {
  const auto first = static_cast<Eigen::Index>(fit.scores.size() - std::ssize(fit.eta));
  for (std::size_t j = 0; j < candidate.parameters.size(); ++j) {
    const Prior& prior = candidate.parameters[j].prior;
    const double value = fit.eta[j];
    // Uniform priors end at natural bounds; only truncated normals and log-normals
    // may end too early.
    const bool natural = std::holds_alternative<UniformPrior>(prior.distribution());
    if (!natural && std::isfinite(prior.max()) && std::isfinite(prior.min()) &&
        value > prior.max() - kNearEnd * (prior.max() - prior.min()))
      return true;
    const double score = fit.scores[first + static_cast<Eigen::Index>(j)];
    if (is_amount(candidate.parameters[j]) && std::abs(score) > (1.0 - kNearEnd) * kScoreLimit) {
      return true;
    }
  }
  return false;
}

/// Whether no amount of the effect is surely different from none. Effects that have only shapes,
/// such as a clock, are certain.
bool may_be_nothing(const Candidate& candidate, const JointFit& fit) {
  constexpr double kSure = 2.0;  // Standard deviations.
  const std::vector<ParameterPosterior> posterior = posterior_of(candidate, fit);
  bool has_amount = false;
  for (std::size_t j = 0; j < candidate.parameters.size(); ++j) {
    if (!is_amount(candidate.parameters[j])) continue;
    has_amount = true;
    const double amount = posterior[j].mode - candidate.parameters[j].neutral;
    if (std::abs(amount) >= kSure * posterior[j].sd) return false;
  }
  return has_amount;
}

int months_read(const SiteProblem& site) {
  std::set<int> months;
  for (Eigen::Index i = 0; i < site.measured_parts_kW.rows(); ++i) {
    if (site.measured_parts_kW.row(i).isFinite().any()) {
      months.insert(site.day_parts.parts[static_cast<std::size_t>(i)].month);
    }
  }
  return static_cast<int>(months.size());
}

/// Evidence counts at a mode alone, so a fit that found one is better than one that did not.
bool is_better(const JointFit& a, const JointFit& b) {
  return a.converged != b.converged ? a.converged : a.log_evidence > b.log_evidence;
}

/// Fits of effects beside a base model.
class Rivals {
 public:
  Rivals(Predictor& predictor, const SiteProblem& site, const std::vector<Candidate>& candidates,
         Ground& ground)
      : predictor_(predictor), site_(site), candidates_(candidates), ground_(ground) {}

  Result<void> fit(const EffectStart& start) {
    rivals_.push_back({.candidate = start.candidate});
    Explanation& e = rivals_.back();
    Eigen::VectorXd from = start_of(start);
    e.fit = TRY(fit_of(e, from));
    if (start.scores.size() == 0) return {};
    from.head(start.scores.size()) = start.scores;
    return fit_again(e, from);
  }

  /// Moves the base model to where the effects have led, if it is better there. From a better
  /// place all effects are fitted again.
  Result<void> be_fair() {
    bool has_moved = false;
    for (const Explanation& e : rivals_) {
      Eigen::VectorXd from = ground_.none.scores;
      from.head(parameters()) = e.fit.scores.head(parameters());
      auto base = TRY(fit_jointly(predictor_, ground_.context(site_), Candidate{}, from, kFineFit));
      if (!is_better(base, ground_.none)) continue;
      ground_.none = std::move(base);
      has_moved = true;
    }
    if (!has_moved) return {};
    for (Explanation& e : rivals_) {
      Eigen::VectorXd from = e.fit.scores;
      from.head(parameters()) = ground_.none.scores.head(parameters());
      if (auto again = fit_again(e, from); !again) return again;
    }
    return {};
  }

  /// What else is asked of them.
  std::vector<Explanation> judged(const NamingRules& rules) && {
    const HeldJudge judge = judge_of(site_, ground_, ground_.select);
    const MonthScores without = judge.scores(ground_.none, *ground_.usual);
    for (Explanation& e : rivals_) {
      e.evidence_gain = e.fit.log_evidence - ground_.none.log_evidence;
      e.selected = gain_over(difference(judge.scores(e.fit, *ground_.usual), without));
      e.move = largest_move(e.fit.parts_kW, predictor_.parts_kW(e.fit.theta));
      e.at_truncation = is_at_truncation(candidates_[e.candidate], e.fit);
      e.objection = objection_to(e, rules);
    }
    return std::move(rivals_);
  }

 private:
  [[nodiscard]] Eigen::Index parameters() const { return std::ssize(site_.parameters); }

  /// The base model's mode, with an effect of these values.
  [[nodiscard]] Eigen::VectorXd start_of(const EffectStart& start) const {
    const Eigen::VectorXd& base = ground_.none.scores;
    const std::vector<EffectParameter>& effect = candidates_[start.candidate].parameters;
    Eigen::VectorXd from(base.size() + std::ssize(effect));
    from.head(base.size()) = base;
    for (std::size_t j = 0; j < effect.size(); ++j) {
      from[base.size() + static_cast<Eigen::Index>(j)] = score_of(effect[j].prior, start.values[j]);
    }
    return from;
  }

  Result<JointFit> fit_of(const Explanation& e, const Eigen::VectorXd& from) {
    auto fit =
        fit_jointly(predictor_, ground_.context(site_), candidates_[e.candidate], from, kFineFit);
    if (fit) fit->jacobian.resize(0, 0);  // the largest part of a fit, and not needed any more
    return fit;
  }

  Result<void> fit_again(Explanation& e, const Eigen::VectorXd& from) {
    auto again = TRY(fit_of(e, from));
    if (is_better(again, e.fit)) e.fit = std::move(again);
    return {};
  }

  /// The reason why it cannot be named; empty if there is none.
  [[nodiscard]] std::string objection_to(const Explanation& e, const NamingRules& rules) const {
    const int months = months_read(site_);
    if (months < rules.least_months) {
      return std::to_string(months) +
             " months of readings are too few to tell an effect from a season; most of a year is "
             "needed";
    }
    if (!ground_.none.converged) return "the base calibration of the hourly model did not converge";
    if (is_worse(e.selected)) return "the months set aside for choosing contradict it";
    if (e.move < rules.least_move) return "it would hardly show at any meter";
    if (e.at_truncation) return "its size is at the limit of what is thought possible";
    if (may_be_nothing(candidates_[e.candidate], e.fit)) return "its size may as well be nothing";
    return {};
  }

  Predictor& predictor_;
  const SiteProblem& site_;
  const std::vector<Candidate>& candidates_;
  Ground& ground_;
  std::vector<Explanation> rivals_;
};

std::vector<NameProbability> probabilities_of(const SignatureNames& names) {
  std::vector<NameProbability> list{{"none", -1, names.none, {}},
                                    {"unknown", -1, names.unknown, {}}};
  for (std::size_t i = 0; i < names.evidence.effects.size(); ++i) {
    const EffectEvidence& evidence = names.evidence.effects[i];
    const Candidate& candidate = *evidence.shape.candidate;
    list.push_back({std::string{candidate.effect->id}, candidate.meter,
                    names.probabilities[static_cast<Eigen::Index>(i)], std::nullopt,
                    evidence.signs});
  }
  std::ranges::stable_sort(list, std::greater{}, &NameProbability::probability);
  return list;
}

/// Of the effect with this name.
EffectStart start_of(const NameProbability& name, const SignatureNames& names,
                     const std::vector<Candidate>& candidates) {
  const auto found = std::ranges::find_if(names.evidence.effects, [&](const EffectEvidence& e) {
    return e.shape.candidate->effect->id == name.effect;
  });
  return {static_cast<std::size_t>(found->shape.candidate - candidates.data()), found->values,
          found->scores};
}

void decide(Naming& naming, const NamingRules& rules) {
  const NameProbability& first = naming.probabilities.front();
  if (first.explanation && first.probability >= rules.least_probability) {
    const std::string& against = naming.explanations[*first.explanation].objection;
    if (against.empty()) {
      naming.outcome = Outcome::named;
      naming.named = first.explanation;
      naming.why = "one effect explains the gap better than all others together";
      return;
    }
    naming.why = std::string{find_effect(first.effect)->title} + " fits best, but " + against;
    return;
  }
  double share = 0.0;
  std::vector<std::string> set;
  bool supported = true;
  for (const NameProbability& p : naming.probabilities) {
    if (!p.explanation) continue;
    share += p.probability;
    set.push_back(p.effect);
    supported = supported && naming.explanations[*p.explanation].objection.empty();
  }
  if (set.size() >= 2 && share >= rules.set_probability && supported) {
    naming.outcome = Outcome::confusable;
    naming.confusable = std::move(set);
    naming.why = "several effects explain the gap equally well";
    return;
  }
  if (first.effect == "unknown" && first.probability >= rules.unknown_probability) {
    naming.outcome = Outcome::unknown;
    naming.why = "there is a gap that no effect of the catalogue explains";
    return;
  }
  naming.why = "no effect is supported strongly enough";
}

}  // namespace

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::named:
      return "named";
    case Outcome::confusable:
      return "confusable";
    case Outcome::unknown:
      return "unknown";
    case Outcome::none:
      break;
  }
  return "none";
}

std::vector<double> probabilities_at(const Naming& naming, double prior_none) {
  const auto odds_of = [](double probability) { return probability / (1.0 - probability); };
  const double factor = odds_of(prior_none) / odds_of(naming.prior_none);
  std::vector<double> probabilities;
  double sum = 0.0;
  for (const NameProbability& p : naming.probabilities) {
    probabilities.push_back(p.probability * (p.effect == "none" ? factor : 1.0));
    sum += probabilities.back();
  }
  for (double& probability : probabilities) probability /= sum;
  return probabilities;
}

Result<Naming> name_effect(Predictor& predictor, const SiteProblem& site,
                           const SignatureNames& names, const std::vector<Candidate>& candidates,
                           const NamingRules& rules, Ground& ground) {
  Naming naming{.probabilities = probabilities_of(names), .prior_none = names.prior_none};
  Rivals rivals{predictor, site, candidates, ground};
  std::size_t fits = 0;
  for (NameProbability& p : naming.probabilities) {
    if (p.probability < rules.worth_a_fit || fits == rules.fits_max) break;
    if (p.effect == "none" || p.effect == "unknown") continue;
    TRY(rivals.fit(start_of(p, names, candidates)));
    p.explanation = fits++;
  }
  TRY(rivals.be_fair());
  naming.explanations = std::move(rivals).judged(rules);
  decide(naming, rules);
  return naming;
}

Result<Naming> take_as_named(Predictor& predictor, const SiteProblem& site,
                             const EffectStart& start, const std::vector<Candidate>& candidates,
                             const NamingRules& rules, Ground& ground) {
  Rivals rivals{predictor, site, candidates, ground};
  TRY(rivals.fit(start));
  TRY(rivals.be_fair());
  const Candidate& assumed = candidates[start.candidate];
  return Naming{.outcome = Outcome::named,
                .probabilities = {{std::string{assumed.effect->id}, assumed.meter, 1.0, 0}},
                .explanations = std::move(rivals).judged(rules),
                .named = 0,
                .confusable = {},
                .why = "it was assumed to be present"};
}

}  // namespace recald::diagnosis
