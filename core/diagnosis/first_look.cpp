#include "core/diagnosis/first_look.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace recald::diagnosis {
namespace {

constexpr std::size_t kColumnsAtOnce = 24;
constexpr int kNullDraws = 999;
constexpr double kNullProbability = 0.99;

/// What is scanned is no amount, even where it has a neutral value: a clock two hours off is not
/// twice a clock one hour off.
bool is_amount(const EffectParameter& parameter) {
  return std::isfinite(parameter.neutral) && parameter.scan.empty();
}

/// A typical amount: the prior's mean, or one standard deviation up where that is nothing.
double typical_value(const EffectParameter& parameter) {
  const double mean = parameter.prior.mean();
  const double sd = std::sqrt(parameter.prior.variance());
  return std::abs(mean - parameter.neutral) > 0.1 * sd ? mean : parameter.neutral + sd;
}

/// The prior of a factor on the typical deviation from neutral.
AmountPrior factor_prior(const EffectParameter& parameter) {
  const double typical = std::abs(typical_value(parameter) - parameter.neutral);
  const Prior& prior = parameter.prior;
  const bool one_sided = prior.min() >= parameter.neutral || prior.max() <= parameter.neutral;
  if (!one_sided) return {AmountPriorKind::normal, std::sqrt(prior.variance()) / typical};
  if (std::holds_alternative<UniformPrior>(prior.distribution())) {
    return {AmountPriorKind::uniform, (prior.max() - prior.min()) / typical};
  }
  // Of a half-normal: its second moment about the neutral value is the scale squared.
  const double shift = prior.mean() - parameter.neutral;
  return {AmountPriorKind::half_normal, std::sqrt(prior.variance() + shift * shift) / typical};
}

AmountPrior prior_of(const Candidate& candidate) {
  for (const EffectParameter& parameter : candidate.parameters) {
    if (is_amount(parameter)) return factor_prior(parameter);
  }
  return {AmountPriorKind::half_normal, 1.0};  // nothing but shapes: there or not
}

/// Combinations of the scanned values of the effect's own parameters; amounts at typical values.
std::vector<std::vector<double>> own_shapes(const Candidate& candidate) {
  const std::size_t days = (candidate.begins ? 1 : 0) + (candidate.ends ? 1 : 0);
  std::vector<std::vector<double>> shapes{{}};
  for (std::size_t j = 0; j + days < candidate.parameters.size(); ++j) {
    const EffectParameter& parameter = candidate.parameters[j];
    std::vector<double> values = parameter.scan;
    if (values.empty()) {
      values.push_back(is_amount(parameter) ? typical_value(parameter) : parameter.prior.mean());
    }
    std::vector<std::vector<double>> longer;
    for (const auto& shape : shapes) {
      for (const double value : values) {
        longer.push_back(shape);
        longer.back().push_back(value);
      }
    }
    shapes = std::move(longer);
  }
  return shapes;
}

/// First and last days to try: all pairs in which the effect lasts a week at least.
std::vector<std::pair<double, double>> day_choices(const Candidate& candidate) {
  constexpr double kForever = 1e9;
  constexpr std::array<double, 5> kLengths_d{10.0, 30.0, 60.0, 120.0, 240.0};
  std::vector<std::pair<double, double>> choices;
  if (!candidate.begins) return {{-kForever, kForever}};
  const std::size_t n = candidate.parameters.size();
  const EffectParameter& first = candidate.parameters[n - (candidate.ends ? 2 : 1)];
  for (const double from : first.scan) {
    if (!candidate.ends) {
      choices.emplace_back(from, kForever);
      continue;
    }
    for (const double length : kLengths_d) {
      const double to = from + length;
      if (to < candidate.parameters.back().prior.max()) choices.emplace_back(from, to);
    }
  }
  return choices;
}

/// A footprint of an effect that acts always, cut to its days: exact but for what the building
/// remembers of the day before.
Eigen::VectorXd cut_to_days(const SiteProblem& site, const Observations& observations,
                            const Eigen::VectorXd& footprint, std::pair<double, double> days) {
  Eigen::VectorXd cut = footprint;
  for (const MeterRows& meter : observations.meters) {
    for (std::size_t i = 0; i < meter.rows.size(); ++i) {
      const int day = site.day_parts.parts[static_cast<std::size_t>(meter.rows[i])].day_index;
      if (day < days.first || day >= days.second)
        cut[meter.offset + static_cast<Eigen::Index>(i)] = 0.0;
    }
  }
  return cut;
}

/// Collects footprints and judges them many at once.
class Judge {
 public:
  Judge(const FitContext& context, const JointFit& none)
      : context_(context), node_(context.grid[static_cast<std::size_t>(none.best_node)]) {
    base_.resize(none.residual.size(), none.jacobian.cols() + 1);
    base_ << none.linear_residual(), none.jacobian;
  }

  /// d and z of each column. @param columns  (n x k)
  Result<GramSystem> judge(const Eigen::MatrixXd& columns) const {
    Eigen::MatrixXd all(base_.rows(), base_.cols() + columns.cols());
    all << base_, columns;
    const Eigen::Index q = base_.cols() - 1;
    return marginalise(node_.gram(context_.observations, all), Eigen::MatrixXd::Identity(q, q));
  }

 private:
  const FitContext& context_;
  const NoiseNode& node_;
  Eigen::MatrixXd base_;  ///< [r | J]
};

struct Footprints {
  std::vector<Look> looks;
  std::vector<Eigen::VectorXd> columns;
};

Footprints footprints_of(Predictor& predictor, const FitContext& context, const JointFit& none,
                         const Candidate& candidate, std::size_t index,
                         const Eigen::VectorXd& base) {
  Footprints result;
  const SiteFacts facts = context.site.facts();
  const AmountPrior prior = prior_of(candidate);
  // Undated first: days are cut out of one run.
  Candidate undated = candidate;
  undated.begins = undated.ends = false;
  for (const std::vector<double>& shape : own_shapes(candidate)) {
    const auto alteration = alteration_of(undated, facts, shape);
    const Eigen::VectorXd footprint =
        context.observations.stack(predictor.parts_kW(none.theta, alteration.get())) - base;
    for (const auto& days : day_choices(candidate)) {
      Look look{.candidate = index, .values = shape, .prior = prior};
      if (candidate.begins) look.values.push_back(days.first);
      if (candidate.ends) look.values.push_back(days.second);
      result.looks.push_back(std::move(look));
      result.columns.push_back(
          candidate.begins ? cut_to_days(context.site, context.observations, footprint, days)
                           : footprint);
    }
  }
  return result;
}

Result<void> judge_all(const Judge& judge, Footprints& prints) {
  for (std::size_t first = 0; first < prints.looks.size(); first += kColumnsAtOnce) {
    const std::size_t count = std::min(kColumnsAtOnce, prints.looks.size() - first);
    Eigen::MatrixXd columns(prints.columns[first].size(), static_cast<Eigen::Index>(count));
    for (std::size_t i = 0; i < count; ++i) {
      columns.col(static_cast<Eigen::Index>(i)) = prints.columns[first + i];
    }
    const auto system = judge.judge(columns);
    if (!system) return tl::unexpected(system.error());
    const Eigen::VectorXd d = detectability(*system);
    const Eigen::VectorXd z = score(*system);
    for (std::size_t i = 0; i < count; ++i) {
      Look& look = prints.looks[first + i];
      look.detectability = d[static_cast<Eigen::Index>(i)];
      look.score = z[static_cast<Eigen::Index>(i)];
      look.log_bayes_factor = log_bayes_factor(look.detectability, look.score, look.prior);
    }
  }
  return {};
}

CandidateLook summarise(const std::vector<Look>& looks) {
  const auto best = std::ranges::max_element(looks, {}, &Look::log_bayes_factor);
  double sum = 0.0;
  double most = 0.0;
  for (const Look& look : looks) {
    sum += std::exp(look.log_bayes_factor - best->log_bayes_factor);
    most = std::max(most, look.detectability);
  }
  return {.best = *best,
          .log_bayes_factor =
              best->log_bayes_factor + std::log(sum / static_cast<double>(looks.size())),
          .most_detectable = most,
          .visible = most >= kLeastDetectability};
}

}  // namespace

Result<FirstLook> look_at(Predictor& predictor, const FitContext& context, const JointFit& none,
                          const std::vector<Candidate>& candidates, Rng& rng) {
  FirstLook result;
  const Judge judge{context, none};
  const Eigen::VectorXd base = context.observations.stack(predictor.parts_kW(none.theta));
  Eigen::MatrixXd best_columns(base.size(), static_cast<Eigen::Index>(candidates.size()));
  std::vector<CandidateScale> scales;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Footprints prints = footprints_of(predictor, context, none, candidates[i], i, base);
    if (auto judged = judge_all(judge, prints); !judged) return tl::unexpected(judged.error());
    result.candidates.push_back(summarise(prints.looks));
    const Look& best = result.candidates.back().best;
    const auto column = std::ranges::find_if(
        prints.looks, [&](const Look& look) { return look.values == best.values; });
    best_columns.col(static_cast<Eigen::Index>(i)) =
        prints.columns[static_cast<std::size_t>(column - prints.looks.begin())];
    scales.push_back({best.detectability, best.prior});
  }
  const auto system = judge.judge(best_columns);
  if (!system) return tl::unexpected(system.error());
  result.confusability = confusability(*system);
  result.null_threshold =
      null_threshold(scales, result.confusability, kNullProbability, kNullDraws, rng);
  return result;
}

}  // namespace recald::diagnosis
