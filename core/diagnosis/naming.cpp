#include "core/diagnosis/naming.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "core/diagnosis/candidate_shapes.hpp"
#include "core/diagnosis/held_scores.hpp"
#include "core/diagnosis/null_scale.hpp"

namespace recald::diagnosis {
namespace {

constexpr double kConfusable = 0.7;
constexpr double kSameSignal = 0.9;
// Of the prior's range: a value this near its upper bound counts as limited by it.
constexpr double kNearEnd = 0.05;

double class_weight(EffectClass effect_class) {
  switch (effect_class) {
    case EffectClass::schedule:
    case EffectClass::outdoor_air:
    case EffectClass::meter:
      return 3.0;
    case EffectClass::air_system:
    case EffectClass::electrical:
      return 2.0;
    case EffectClass::envelope:
    case EffectClass::plant:
      return 1.0;
  }
  return 1.0;
}

/// One name: an effect, with its meter if it affects one meter.
using Name = std::pair<std::string, int>;
Name name_of(const Candidate& candidate) {
  return {std::string{candidate.effect->id}, candidate.meter};
}

/// Prior probability of each candidate: classes by weight, all effects of a class alike, and an
/// effect's meters and datings share its part.
std::vector<double> log_priors(const std::vector<Candidate>& candidates, const NamingRules& rules) {
  std::map<EffectClass, std::set<std::string_view>> effects;
  std::map<std::string_view, int> variants;
  for (const Candidate& c : candidates) {
    effects[c.effect->effect_class].insert(c.effect->id);
    ++variants[c.effect->id];
  }
  double total = 0.0;
  for (const auto& [effect_class, ids] : effects) total += class_weight(effect_class);
  std::vector<double> priors;
  for (const Candidate& c : candidates) {
    const double of_class = (1.0 - rules.prior_none - rules.prior_unknown) *
                            class_weight(c.effect->effect_class) / total;
    const double of_effect =
        of_class / static_cast<double>(effects.at(c.effect->effect_class).size());
    priors.push_back(std::log(of_effect / variants.at(c.effect->id)));
  }
  return priors;
}

/// The unit for each candidate's evidence: the smallest null scale among all candidates with the
/// same footprint at this site. An error that is rare under one name is equally rare under another.
std::vector<double> scales_of(const FirstLook& look, const std::vector<Candidate>& candidates,
                              const NamingRules& rules) {
  std::vector<double> scales(candidates.size(), 1.0);
  if (!rules.errs_as_learnt) return scales;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    scales[i] = null_scale(candidates[i].effect->id);
    for (std::size_t j = 0; j < candidates.size(); ++j) {
      const double alike =
          std::abs(look.confusability(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
      if (alike > kSameSignal) {
        scales[i] = std::min(scales[i], null_scale(candidates[j].effect->id));
      }
    }
  }
  return scales;
}

/// Candidates worth a fit: the best by evidence in units of null scale, and those
/// similar to the best.
std::vector<std::size_t> survivors_of(const FirstLook& look, const std::vector<double>& scales,
                                      const NamingRules& rules) {
  const auto evidence = [&](std::size_t i) {
    return look.candidates[i].log_bayes_factor / scales[i];
  };
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < look.candidates.size(); ++i) {
    if (look.candidates[i].visible) order.push_back(i);
  }
  std::ranges::stable_sort(order, std::greater{}, evidence);
  std::vector<std::size_t> kept;
  if (order.empty()) return kept;
  const std::size_t best = order.front();
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const std::size_t i = order[rank];
    const bool near = evidence(i) > evidence(best) - rules.survivor_gap;
    const bool alike =
        std::abs(look.confusability(static_cast<Eigen::Index>(i),
                                    static_cast<Eigen::Index>(best))) > kConfusable &&
        look.candidates[i].log_bayes_factor > 0.0;
    if (rank < rules.survivors_min || near || alike) kept.push_back(i);
  }
  return kept;
}

/// The base model's mode, with an effect of these values.
Eigen::VectorXd start_at(const JointFit& none, const Candidate& candidate,
                         const std::vector<double>& values) {
  const auto q = none.scores.size();
  Eigen::VectorXd start(q + std::ssize(candidate.parameters));
  start.head(q) = none.scores;
  for (std::size_t j = 0; j < candidate.parameters.size(); ++j) {
    start[q + static_cast<Eigen::Index>(j)] = score_of(candidate.parameters[j].prior, values[j]);
  }
  return start;
}

/// The base model's mode, with the amount of the effect that the first look estimates by
/// its linear model.
Eigen::VectorXd start_at(const JointFit& none, const Candidate& candidate, const Look& look) {
  constexpr double kLeast = 0.05;  // of typical: at zero amount there is no slope to a shape
  constexpr double kMost = 3.0;
  const double factor = look.detectability > 0.0 ? look.score / look.detectability : 1.0;
  const double taken = std::copysign(std::clamp(std::abs(factor), kLeast, kMost), factor);
  return start_at(none, candidate, with_amount(candidate, look.values, taken));
}

/// A candidate to be fitted, and from where.
struct FitStart {
  std::size_t candidate;  ///< Index into the list.
  Eigen::VectorXd start;  ///< (q + r) scores.
};

std::vector<FitStart> starts_of(const std::vector<std::size_t>& chosen,
                                const std::vector<Candidate>& candidates, const FirstLook& look,
                                const JointFit& none) {
  std::vector<FitStart> rivals;
  for (const std::size_t i : chosen) {
    rivals.push_back({i, start_at(none, candidates[i], look.candidates[i].best)});
  }
  return rivals;
}

/// The likeliest effects by signatures, in order.
std::vector<FitStart> likeliest(const SignatureNames& names,
                                const std::vector<Candidate>& candidates, const JointFit& none) {
  constexpr std::size_t kFitted = 3;
  std::vector<std::size_t> order(names.evidence.effects.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater{}, [&](std::size_t i) {
    return names.probabilities[static_cast<Eigen::Index>(i)];
  });
  order.resize(std::min(order.size(), kFitted));
  std::vector<FitStart> rivals;
  for (const std::size_t i : order) {
    const EffectEvidence& e = names.evidence.effects[i];
    rivals.push_back({static_cast<std::size_t>(e.shape.candidate - candidates.data()),
                      start_at(none, *e.shape.candidate, e.values)});
  }
  return rivals;
}

/// sum |with - without| / sum without, for the meter where it is largest.
double largest_move(const Eigen::ArrayXXd& with_kW, const Eigen::ArrayXXd& without_kW) {
  const Eigen::ArrayXd moved = (with_kW - without_kW).abs().colwise().sum().transpose();
  const Eigen::ArrayXd whole = without_kW.abs().colwise().sum().transpose();
  return (moved / whole.max(1e-9)).maxCoeff();
}

bool is_at_truncation(const Candidate& candidate, const JointFit& fit) {
  for (std::size_t j = 0; j < candidate.parameters.size(); ++j) {
    const Prior& prior = candidate.parameters[j].prior;
    const double value = fit.eta[j];
    // Uniform priors end at natural bounds; only truncated normals and log-normals
    // may end too early.
    const bool natural = std::holds_alternative<UniformPrior>(prior.distribution());
    if (!natural && std::isfinite(prior.max()) && std::isfinite(prior.min()) &&
        value > prior.max() - kNearEnd * (prior.max() - prior.min()))
      return true;
  }
  return false;
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

namespace {

/// Probabilities of all names, none and unknown, at the rules' temperature.
///
/// An effect's support is measured in units of what the same effect shows where nothing is hidden:
/// as if every model had an additional error with this effect's shape.
std::vector<NameProbability> probabilities_of(const std::vector<Explanation>& explanations,
                                              const std::vector<Candidate>& candidates,
                                              double unknown_gain, const NamingRules& rules) {
  const std::vector<double> priors = log_priors(candidates, rules);
  std::vector<NameProbability> list{
      {"none", -1, std::log(rules.prior_none), {}},
      {"unknown", -1, std::log(rules.prior_unknown) + unknown_gain / rules.unknown_scale, {}}};
  for (std::size_t i = 0; i < explanations.size(); ++i) {
    const Explanation& e = explanations[i];
    const Name name = name_of(candidates[e.candidate]);
    const double weight = priors[e.candidate] + e.support / (e.null_scale * rules.temperature);
    const auto found = std::ranges::find_if(list, [&](const NameProbability& p) {
      return p.effect == name.first && p.meter == name.second;
    });
    if (found == list.end()) {
      list.push_back({name.first, name.second, weight, i});
    } else {
      const double top = std::max(found->probability, weight);
      found->probability =
          top + std::log(std::exp(found->probability - top) + std::exp(weight - top));
    }
  }
  double top = list.front().probability;
  for (const NameProbability& p : list) top = std::max(top, p.probability);
  double sum = 0.0;
  for (NameProbability& p : list) sum += p.probability = std::exp(p.probability - top);
  for (NameProbability& p : list) p.probability /= sum;
  std::ranges::stable_sort(list, std::greater{}, &NameProbability::probability);
  return list;
}

/// The names by signatures. An effect that was not fitted keeps its probability.
std::vector<NameProbability> probabilities_of(const SignatureNames& names,
                                              const std::vector<Explanation>& explanations,
                                              const std::vector<Candidate>& candidates) {
  std::vector<NameProbability> list{{"none", -1, names.none, {}},
                                    {"unknown", -1, names.unknown, {}}};
  for (std::size_t i = 0; i < names.evidence.effects.size(); ++i) {
    const Candidate& candidate = *names.evidence.effects[i].shape.candidate;
    const auto found = std::ranges::find_if(
        explanations, [&](const Explanation& e) { return &candidates[e.candidate] == &candidate; });
    std::optional<std::size_t> explanation;
    if (found != explanations.end()) {
      explanation = static_cast<std::size_t>(found - explanations.begin());
    }
    list.push_back({std::string{candidate.effect->id}, candidate.meter,
                    names.probabilities[static_cast<Eigen::Index>(i)], explanation});
  }
  std::ranges::stable_sort(list, std::greater{}, &NameProbability::probability);
  return list;
}

/// The conditions for every name.
struct Grounds {
  bool settled;        ///< The base calibration is at its mode.
  int months;          ///< With readings.
  bool by_signatures;  ///< These say how sure a name is.
};

int months_read(const SiteProblem& site) {
  std::set<int> months;
  for (Eigen::Index i = 0; i < site.measured_parts_kW.rows(); ++i) {
    if (site.measured_parts_kW.row(i).isFinite().any()) {
      months.insert(site.day_parts.parts[static_cast<std::size_t>(i)].month);
    }
  }
  return static_cast<int>(months.size());
}

/// The reason why an explanation cannot be named; empty if there is none.
std::string objection(const Explanation& e, const Grounds& grounds, const Naming& naming,
                      const NamingRules& rules) {
  const double least = std::max(rules.least_evidence, naming.null_threshold);
  if (!grounds.by_signatures && e.support / e.null_scale < least) {
    return "its evidence is no stronger than in buildings with nothing hidden";
  }
  if (grounds.months < rules.least_months) {
    return std::to_string(grounds.months) +
           " months of readings are too few to tell an effect from a season; most of a year is "
           "needed";
  }
  if (!grounds.settled) return "the base calibration of the hourly model did not converge";
  if (!grounds.by_signatures && e.first_look < naming.null_threshold)
    return "the residuals alone do not support it";
  if (e.selected_gain < -rules.most_against * e.null_scale - 2.0 * e.selected_se) {
    return "the months set aside for choosing contradict it";
  }
  if (e.move < rules.least_move) return "it would hardly change any meter";
  if (e.at_truncation) return "its size is at the limit of what is thought possible";
  return {};
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
    naming.outcome = Outcome::none;
    return;
  }
  double share = 0.0;
  std::vector<std::string> set;
  bool supported = true;
  for (const NameProbability& p : naming.probabilities) {
    if (!p.explanation || p.probability < rules.confusable_share) continue;
    share += p.probability;
    set.push_back(p.effect);
    supported = supported && naming.explanations[*p.explanation].objection.empty();
  }
  if (set.size() >= 2 && share >= rules.least_probability && supported) {
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
  naming.outcome = Outcome::none;
  naming.why = "no effect is supported strongly enough";
}

/// @param rules  Whether the model has errors.
void settle_support(const NamingRules& rules, Explanation& e) {
  e.support = rules.errs_as_learnt ? std::min(e.evidence_gain, e.first_look) : e.evidence_gain;
}

void take_fit(JointFit fit, const JointFit& none, Explanation& e) {
  e.fit = std::move(fit);
  e.fit.jacobian.resize(0, 0);  // the largest part of a fit, and no longer needed
  e.evidence_gain = e.fit.log_evidence - none.log_evidence;
  e.likelihood_gain = e.fit.log_likelihood - none.log_likelihood;
}

/// The result of a fit compared with the base model alone.
Explanation explanation_of(JointFit fit, const JointFit& none, double null_scale) {
  Explanation e{};
  e.null_scale = null_scale;
  take_fit(std::move(fit), none, e);
  return e;
}

void sort_by_support(std::vector<Explanation>& explanations) {
  std::ranges::stable_sort(explanations, std::greater{},
                           [](const Explanation& e) { return e.support / e.null_scale; });
}

// Number of best rivals to restart, if they have half of the support that a name needs.
constexpr std::size_t kRestarts = 3;
constexpr double kWorthRestarts = 0.5;
constexpr double kLikely = 0.5;  // By signatures: so probable that it is worth restarts.
const FitOptions kRestart{.hops = 2};

bool is_worth_restarts(const std::vector<Explanation>& sorted, const NamingRules& rules) {
  return !sorted.empty() &&
         (!rules.only.empty() || sorted.front().support / sorted.front().null_scale >
                                     kWorthRestarts * rules.least_evidence);
}

/// Restarts rivals near the first and the base model equally. A rival's gain from a better mode of
/// the base model is not its own, so as much effort goes into the model without effects.
class Restarts {
 public:
  Restarts(Predictor& predictor, const FitContext& context,
           const std::vector<Candidate>& candidates, const JointFit& none,
           std::vector<Explanation>& explanations)
      : predictor_(predictor),
        context_(context),
        candidates_(candidates),
        none_(none),
        explanations_(explanations),
        count_(std::min(kRestarts, explanations.size())) {}

  /// @return a better mode of the base model, if one was found
  Result<std::optional<JointFit>> run() {
    for (std::size_t i = 0; i < count_; ++i) {
      if (auto again = refit(i, explanations_[i].fit.scores, kRestart); !again) {
        return tl::unexpected(again.error());
      }
    }
    std::optional<JointFit> better;
    for (std::size_t i = 0; i < count_; ++i) {
      const Eigen::VectorXd start = explanations_[i].fit.scores.head(none_.scores.size());
      auto again = fit_jointly(predictor_, context_, Candidate{}, start, kRestart);
      if (!again) return tl::unexpected(again.error());
      if (again->log_evidence > (better ? better->log_evidence : none_.log_evidence)) {
        better = std::move(*again);
      }
    }
    for (std::size_t i = 0; better && i < count_; ++i) {
      Eigen::VectorXd start = explanations_[i].fit.scores;
      start.head(none_.scores.size()) = better->scores;
      if (auto again = refit(i, start, {}); !again) return tl::unexpected(again.error());
    }
    return better;
  }

 private:
  Result<void> refit(std::size_t i, const Eigen::VectorXd& start, const FitOptions& options) {
    Explanation& e = explanations_[i];
    auto again = fit_jointly(predictor_, context_, candidates_[e.candidate], start, options);
    if (!again) return tl::unexpected(again.error());
    if (again->log_evidence > e.fit.log_evidence) take_fit(std::move(*again), none_, e);
    return {};
  }

  Predictor& predictor_;
  const FitContext& context_;
  const std::vector<Candidate>& candidates_;
  const JointFit& none_;
  std::vector<Explanation>& explanations_;
  std::size_t count_;
};

}  // namespace

Result<Naming> name_effect(Predictor& predictor, const NamingData& data, const JointFit& none,
                           const std::vector<Candidate>& candidates, const FirstLook& look,
                           const NamingRules& rules) {
  Naming naming;
  naming.null_threshold = look.null_threshold;
  const HeldJudge judge{data.fit.site, data.fit.observations,
                        data.fit.grid[static_cast<std::size_t>(none.best_node)], data.select,
                        data.levels};
  const std::vector<double> scales = scales_of(look, candidates, rules);
  const SignatureNames* names = rules.only.empty() ? data.names : nullptr;
  const std::vector<FitStart> rivals =
      names != nullptr
          ? likeliest(*names, candidates, none)
          : starts_of(rules.only.empty() ? survivors_of(look, scales, rules) : rules.only,
                      candidates, look, none);
  for (const auto& [i, start] : rivals) {
    auto fit = fit_jointly(predictor, data.fit, candidates[i], start);
    if (!fit) return tl::unexpected(fit.error());
    Explanation e = explanation_of(std::move(*fit), none, scales[i]);
    e.candidate = i;
    e.first_look = look.candidates[i].log_bayes_factor;
    settle_support(rules, e);
    naming.explanations.push_back(std::move(e));
  }
  if (names == nullptr) sort_by_support(naming.explanations);
  const bool is_worth = names != nullptr
                            ? !rivals.empty() && names->probabilities.maxCoeff() >= kLikely
                            : is_worth_restarts(naming.explanations, rules);
  if (is_worth) {
    auto better = Restarts{predictor, data.fit, candidates, none, naming.explanations}.run();
    if (!better) return tl::unexpected(better.error());
    naming.better_base = std::move(*better);
  }
  const JointFit& base = naming.better_base ? *naming.better_base : none;
  const MonthScores base_scores = judge.scores(base, data.usual);
  const double owed = base.log_evidence - none.log_evidence;
  naming.unknown_gain = data.unknown_log_evidence - none.log_evidence - owed;
  const Grounds grounds{none.converged, months_read(data.fit.site), names != nullptr};
  for (Explanation& e : naming.explanations) {
    e.evidence_gain -= owed;
    settle_support(rules, e);
    const ScoreGain gain = gain_over(difference(judge.scores(e.fit, data.usual), base_scores));
    e.selected_gain = gain.sum;
    e.selected_se = gain.se;
    e.move = largest_move(e.fit.parts_kW, predictor.parts_kW(e.fit.theta));
    e.at_truncation = is_at_truncation(candidates[e.candidate], e.fit);
    e.objection = objection(e, grounds, naming, rules);
  }
  if (names != nullptr) {
    naming.probabilities = probabilities_of(*names, naming.explanations, candidates);
  } else {
    sort_by_support(naming.explanations);
    naming.probabilities =
        probabilities_of(naming.explanations, candidates, naming.unknown_gain, rules);
  }
  decide(naming, rules);
  return naming;
}

}  // namespace recald::diagnosis
