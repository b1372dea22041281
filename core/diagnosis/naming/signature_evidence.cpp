#include "core/diagnosis/naming/signature_evidence.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "core/diagnosis/evidence/candidate_shapes.hpp"
#include "core/diagnosis/evidence/joint_fit.hpp"
#include "core/diagnosis/naming/expected_changes.hpp"
#include "core/diagnosis/naming/signature_fit.hpp"

namespace recald::diagnosis {
namespace {

constexpr double kImpossible = -1e300;
// The typical amount and a factor of eight to either side, nearly evenly in its logarithm.
constexpr std::array<double, 8> kAmounts{0.12, 0.25, 0.5, 0.8, 1.2, 1.8, 2.6, 4.0};

double log_add(double a, double b) {
  const double top = std::max(a, b);
  return top + std::log1p(std::exp(std::min(a, b) - top));
}

double log_amount_prior(double amount) {
  return -0.5 * std::pow(std::log(amount) / SignatureSearch::kAmountSpread, 2);
}

/// What the model, linear about a point, says of the shapes of an effect.
struct ShapeLook {
  EffectShape shape;           ///< The likeliest.
  double along = 0.0;          ///< How much of what is left points its way …
  double across = 0.0;         ///< … and how long its change is, squared.
  double factor = 1.0;         ///< On the typical amount.
  Eigen::VectorXd change;      ///< (n) of the typical amount, whitened.
  double gain = kImpossible;   ///< Log Bayes factor of this shape with this sign.
  double total = kImpossible;  ///< Log sum over all shapes tried.
  int shapes = 0;

  /// What the choice of the shape and its sign costs.
  [[nodiscard]] double log_choice() const { return total - std::log(shapes) - gain; }
};
using ShapeLooks = std::map<std::string_view, ShapeLook>;

/// ShapeLooks at all shapes about one point.
class Viewpoint {
 public:
  Viewpoint(const SignatureSearch& search, const SignaturePoint& point)
      : search_(search),
        weight_(search.weight_of(point)),
        slopes_(std::sqrt(weight_) * point.slopes),
        inner_(Eigen::MatrixXd::Identity(slopes_.cols(), slopes_.cols()) +
               slopes_.transpose() * slopes_),
        misfit_(0.0) {
    const Eigen::VectorXd left = std::sqrt(weight_) * point.residual + slopes_ * point.at;
    unexplained_ = beyond_parameters(left);
    misfit_ = left.dot(unexplained_);
    for (const double amount : kAmounts) log_sum_ = log_add(log_sum_, log_amount_prior(amount));
  }

  void look(const ExpectedChange& expected, ShapeLooks& looks) const {
    constexpr double kLeastVisible = 1e-3;
    constexpr double kLeastFactor = 0.05;
    constexpr double kMostFactor = 8.0;
    const Eigen::VectorXd change = search_.metric().whiten(expected.change);
    const Eigen::VectorXd weighted = std::sqrt(weight_) * change;
    ShapeLook now{.along = weighted.dot(unexplained_),
                  .across = weighted.dot(beyond_parameters(weighted))};
    if (now.across <= kLeastVisible) return;
    now.shape = {.candidate = expected.candidate, .values = expected.values};
    if (expected.candidate->begins) now.shape.values.push_back(expected.from_day);
    if (expected.candidate->ends) now.shape.values.push_back(expected.to_day);
    const bool has_amount = now.shape.has_amount();
    now.gain = gain_of(now, has_amount);
    double of_both = now.gain;
    if (has_amount && may_take_away(*expected.candidate)) {
      ShapeLook away = now;
      away.shape.sign = -1.0;
      away.gain = gain_of(away, has_amount);
      of_both = log_add(now.gain, away.gain) - std::log(2.0);
      if (away.gain > now.gain) std::swap(now, away);
    }
    now.factor = std::clamp(now.shape.sign * now.along / now.across, kLeastFactor, kMostFactor);
    ShapeLook& best = looks[expected.candidate->effect->id];
    now.total = log_add(best.total, of_both);
    now.shapes = best.shapes + 1;
    if (now.gain > best.gain) {
      now.change = change;
      best = std::move(now);
    } else {
      best.total = now.total;
      best.shapes = now.shapes;
    }
  }

 private:
  /// (I - A (I + A'A)^-1 A') x: what parameters, whose priors have their say, cannot do.
  [[nodiscard]] Eigen::VectorXd beyond_parameters(const Eigen::VectorXd& x) const {
    return x - slopes_ * inner_.solve(slopes_.transpose() * x);
  }

  /// Log Bayes factor over amounts.
  [[nodiscard]] double gain_of(const ShapeLook& look, bool has_amount) const {
    const auto gain_at = [&](double amount) {
      const double after =
          misfit_ - 2.0 * look.shape.sign * amount * look.along + amount * amount * look.across;
      return search_.log_ratio(misfit_ / weight_, std::max(after, 1e-6) / weight_);
    };
    double gain = kImpossible;
    for (const double amount : kAmounts) {
      gain = log_add(gain, gain_at(amount) + log_amount_prior(amount) - log_sum_);
    }
    // What has no amount may be worth a fit even if a part of it would look better here.
    constexpr double kOfPart = 3.0;
    return has_amount ? gain : std::max(gain_at(1.0), gain - kOfPart);
  }

  const SignatureSearch& search_;
  double weight_;
  Eigen::MatrixXd slopes_;
  Eigen::LLT<Eigen::MatrixXd> inner_;
  Eigen::VectorXd unexplained_;
  double misfit_;
  double log_sum_ = kImpossible;
};

/// An effect fitted together with the parameters.
struct Fitted {
  std::string_view effect;
  SignaturePoint point;
  const ShapeLook* look;

  /// Less is better.
  [[nodiscard]] double cost() const { return point.cost - look->log_choice(); }
};

class EvidenceSearch {
 public:
  EvidenceSearch(const SiteProblem& site, const std::vector<Candidate>& candidates,
                 const SignatureNull& null, Predictor& predictor, std::optional<int> since_day)
      : site_(site),
        candidates_(candidates),
        predictor_(predictor),
        since_day_(since_day),
        reader_(site),
        fit_(fit_signatures(site, reader_, predictor)),
        search_(site, reader_, null, predictor, fit_.measured, fit_.fitted) {}

  SignatureEvidence run() {
    if (search_.metric().count() == 0) return {.scores = fit_.scores};  // no meter they know
    mode_ = search_.settled(search_.base_at(fit_.scores), nullptr);
    search_.widen(mode_);
    SignaturePoint drawings = search_.base_at(Eigen::VectorXd::Zero(search_.parameters()));
    search_.linearise(drawings, nullptr);
    mode_ = search_.settled(search_.base_at(search_.scores_of(mode_)), nullptr);
    take_if_better(search_.settled(drawings, nullptr));
    search_.linearise(mode_, nullptr);
    looks_ = {look_from(drawings), look_from(mode_)};
    looks_[1].insert(looks_[0].begin(), looks_[0].end());  // what shows from there alone
    const std::array<SignaturePoint, 2> from{std::move(drawings), mode_};
    fit_effects(likeliest(), from);
    if (predictor_.is_stopped()) return {};
    settle_leaders();
    look_for_better_base();
    return predictor_.is_stopped() ? SignatureEvidence{} : conclude();
  }

 private:
  void take_if_better(SignaturePoint point) {
    if (point.cost < mode_.cost) mode_ = std::move(point);
  }

  [[nodiscard]] ShapeLooks look_from(const SignaturePoint& point) {
    SignatureFit here = fit_;
    here.scores = search_.scores_of(point);
    here.theta = values_at(priors_of(site_), here.scores);
    predictor_.parts_kW(here.theta);
    here.hours_kW = predictor_.hours_kW();
    const Viewpoint viewpoint(search_, point);
    ShapeLooks looks;
    expect_changes(
        site_, reader_, here, candidates_, predictor_,
        [&](const ExpectedChange& expected) {
          // Readings that stand still are no readings, so no model is asked for them.
          if (expected.candidate->effect->id == "stuck_meter") return;
          viewpoint.look(expected, looks);
        },
        since_day_);
    return looks;
  }

  /// Effects worth a fit: those that look likeliest from either place, and all of one meter: what
  /// a wrong clock does is not linear.
  [[nodiscard]] std::vector<std::string_view> likeliest() const {
    constexpr std::array<std::size_t, 2> kMany{6, 10};
    std::vector<std::string_view> chosen;
    for (std::size_t i = 0; i < looks_.size(); ++i) {
      std::vector<std::pair<double, std::string_view>> order;
      for (const auto& [effect, look] : looks_[i]) {
        order.emplace_back(look.gain + look.log_choice(), effect);
      }
      std::ranges::sort(order, std::greater{});
      order.resize(std::min(order.size(), kMany[i]));
      for (const auto& [gain, effect] : order) {
        if (std::ranges::find(chosen, effect) == chosen.end()) chosen.push_back(effect);
      }
    }
    for (const auto& [effect, look] : looks_[1]) {
      const bool is_of_meter = look.shape.candidate->effect->effect_class == EffectClass::meter;
      if (is_of_meter && std::ranges::find(chosen, effect) == chosen.end())
        chosen.push_back(effect);
    }
    return chosen;
  }

  /// Calls `body` for each index below `count` with a search of its own, several at a time.
  template <class Body>
  void for_each(std::size_t count, const Body& body) {
    predictor_.for_each(count, [&](Predictor& predictor, std::size_t i) {
      SignatureSearch search = search_.with(predictor);
      if (!predictor.is_stopped()) body(search, i);
    });
  }

  void fit_effects(const std::vector<std::string_view>& effects,
                   const std::array<SignaturePoint, 2>& from) {
    fitted_.resize(effects.size());
    for_each(effects.size(), [&](SignatureSearch& search, std::size_t i) {
      fitted_[i] = fit_effect(search, effects[i], from);
    });
  }

  [[nodiscard]] Fitted fit_effect(SignatureSearch& search, std::string_view effect,
                                  const std::array<SignaturePoint, 2>& from) const {
    std::optional<Fitted> best;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const auto found = looks_[i].find(effect);
      if (found == looks_[i].end()) continue;
      const ShapeLook& look = found->second;
      Fitted fitted{effect, search.with_effect(from[i], look.shape, look.factor, look.change),
                    &look};
      fitted.point = search.improved(std::move(fitted.point), &look.shape);
      if (!best || fitted.cost() < best->cost()) best = std::move(fitted);
    }
    return std::move(*best);
  }

  /// Those that may still come first; new slopes cost as many runs as there are parameters.
  void settle_leaders() {
    constexpr std::size_t kLeaders = 8;
    constexpr double kOutOfReach = 15.0;
    std::ranges::sort(fitted_, {}, &Fitted::cost);
    const double best = fitted_.empty() ? 0.0 : fitted_.front().cost();
    std::size_t leaders = 0;
    while (leaders < std::min(fitted_.size(), kLeaders) &&
           fitted_[leaders].cost() <= best + kOutOfReach) {
      ++leaders;
    }
    for_each(leaders, [&](SignatureSearch& search, std::size_t i) {
      fitted_[i].point = search.settled(std::move(fitted_[i].point), &fitted_[i].look->shape);
    });
  }

  /// A better place of the base model to which an effect has led is no evidence for the effect.
  /// From there all may gain.
  void look_for_better_base() {
    constexpr std::size_t kLeaders = 3;
    constexpr double kFarAhead = 8.0;
    constexpr double kFarBehind = 3.0;
    std::ranges::sort(fitted_, {}, [](const Fitted& f) { return f.point.cost; });
    std::vector<SignaturePoint> bases(std::min(fitted_.size(), kLeaders));
    for_each(bases.size(), [&](SignatureSearch& search, std::size_t i) {
      bases[i] = search.settled(search.base_at(search.scores_of(fitted_[i].point)), nullptr);
    });
    if (predictor_.is_stopped()) return;
    for (SignaturePoint& base : bases) take_if_better(std::move(base));
    for_each(fitted_.size(), [&](SignatureSearch& search, std::size_t i) {
      Fitted& fitted = fitted_[i];
      if (fitted.point.cost < mode_.cost - kFarAhead) return;
      const bool has_amount = fitted.point.at.size() > search.parameters();
      const double factor =
          has_amount ? std::min(std::exp(fitted.point.at[search.parameters()]), 1.0) : 1.0;
      const EffectShape& shape = fitted.look->shape;
      SignaturePoint again =
          search.improved(search.with_effect(mode_, shape, factor, fitted.look->change), &shape);
      if (again.cost > fitted.point.cost + kFarBehind) return;
      again = search.settled(std::move(again), &shape);
      if (again.cost < fitted.point.cost) fitted.point = std::move(again);
    });
  }

  [[nodiscard]] SignatureEvidence conclude() {
    constexpr std::size_t kShown = 4;
    std::ranges::sort(fitted_, {}, &Fitted::cost);
    for (std::size_t i = 0; i < std::min(fitted_.size(), kShown); ++i) {
      signs_[fitted_[i].effect] = signs_of(fitted_[i]);
    }
    SignatureEvidence evidence{.misfit = mode_.misfit,
                               .count = static_cast<int>(search_.metric().count()),
                               .scores = search_.scores_of(mode_)};
    for (const auto& [effect, look] : looks_[1]) {
      const auto fitted = std::ranges::find(fitted_, effect, &Fitted::effect);
      evidence.effects.push_back(fitted == fitted_.end() ? of_look(look) : of_fit(*fitted));
    }
    return evidence;
  }

  [[nodiscard]] EffectEvidence of_look(const ShapeLook& look) const {
    return {.shape = look.shape,
            .factor = look.factor,
            .values = look.shape.with_factor(look.factor),
            .scores = {},
            .log_gain = std::min(look.gain + look.log_choice(), 0.0),
            .misfit = mode_.misfit,
            .visibility = look.across,
            .signs = {},
            .is_wrong_sign = look.shape.sign * look.along < 0.0};
  }

  [[nodiscard]] EffectEvidence of_fit(const Fitted& fitted) const {
    EffectEvidence evidence = of_look(*fitted.look);
    evidence.is_fitted = true;
    evidence.misfit = fitted.point.misfit;
    evidence.log_gain = mode_.cost - fitted.cost() + search_.log_narrowing(fitted.point);
    const bool has_amount = fitted.point.at.size() > search_.parameters();
    evidence.factor = has_amount ? std::exp(fitted.point.at[search_.parameters()]) : 1.0;
    evidence.values = evidence.shape.with_factor(evidence.factor);
    evidence.scores = search_.scores_of(fitted.point);
    const auto signs = signs_.find(fitted.effect);
    if (signs != signs_.end()) evidence.signs = signs->second;
    return evidence;
  }

  /// The signatures from which the effect takes most of what the base model leaves, each of another
  /// kind: hours next to each other say the same.
  [[nodiscard]] std::vector<EffectSign> signs_of(const Fitted& fitted) {
    constexpr double kMost = 15.0;  // Spreads.
    constexpr double kLeast = 1.0;  // Of squared spreads.
    constexpr std::size_t kMany = 3;
    const Eigen::VectorXd without = search_.left_at(mode_, nullptr);
    const Eigen::VectorXd with = search_.left_at(fitted.point, &fitted.look->shape);
    const Eigen::VectorXd gained = search_.metric().in_spreads(without, kMost).cwiseAbs2() -
                                   search_.metric().in_spreads(with, kMost).cwiseAbs2();
    std::vector<Eigen::Index> order(static_cast<std::size_t>(gained.size()));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    std::ranges::stable_sort(order, std::greater{}, [&](Eigen::Index i) { return gained[i]; });
    const auto names = std::ssize(signature_names());
    std::vector<EffectSign> signs;
    std::set<std::pair<Eigen::Index, std::string_view>> kinds;
    for (const Eigen::Index i : order) {
      if (gained[i] < kLeast || signs.size() == kMany) break;
      if (!std::isfinite(without[i]) || !std::isfinite(with[i])) continue;
      const auto signature = static_cast<std::size_t>(i % names);
      const std::string_view name = signature_names()[signature];
      if (!kinds.emplace(i / names, name.substr(0, name.rfind(','))).second) continue;
      signs.push_back({static_cast<SignatureMeter>(i / names), signature, without[i], with[i]});
    }
    return signs;
  }

  const SiteProblem& site_;
  const std::vector<Candidate>& candidates_;
  Predictor& predictor_;
  std::optional<int> since_day_;
  SignatureReader reader_;
  SignatureFit fit_;
  SignatureSearch search_;
  SignaturePoint mode_;
  std::array<ShapeLooks, 2> looks_;  ///< From the drawings; from the base model's mode.
  std::vector<Fitted> fitted_;
  std::map<std::string_view, std::vector<EffectSign>> signs_;
};

}  // namespace

SignatureEvidence evidence_of(const SiteProblem& site, const std::vector<Candidate>& candidates,
                              const SignatureNull& null, Predictor& predictor,
                              std::optional<int> since_day) {
  return EvidenceSearch(site, candidates, null, predictor, since_day).run();
}

}  // namespace recald::diagnosis
