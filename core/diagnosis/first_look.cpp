#include "core/diagnosis/first_look.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/diagnosis/candidate_shapes.hpp"

namespace recald::diagnosis {
namespace {

constexpr std::size_t kColumnsAtOnce = 24;
constexpr int kNullDraws = 999;
constexpr double kNullProbability = 0.99;

/// First and last days to try: all pairs in which the effect lasts at least a week.
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

/// Limits the footprint of a permanent effect to its days: exact except for what the building
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

/// How visible columns are and how strongly the residual supports them, many at once.
struct Judgement {
  Eigen::VectorXd detectability;  ///< (k) d
  Eigen::VectorXd score;          ///< (k) z, 0 if invisible.
};

/// M under the base model, factorised once for thousands of columns.
class Judge {
 public:
  static Result<Judge> make(const FitContext& context, const JointFit& none) {
    Judge judge{context, none};
    const Eigen::Index q = none.jacobian.cols();
    const Eigen::MatrixXd information = none.jacobian.transpose() * judge.solved_.rightCols(q);
    judge.factor_.compute(Eigen::MatrixXd::Identity(q, q) + information);
    if (judge.factor_.info() != Eigen::Success || !judge.factor_.matrixLLT().allFinite()) {
      return failure(ErrorCode::not_positive_definite,
                     "a sensitivity of the base model is not a finite number");
    }
    judge.residual_ =
        judge.factor_.matrixL().solve(none.jacobian.transpose() * judge.solved_.col(0));
    return judge;
  }

  /// @param columns  (n x k)
  [[nodiscard]] Judgement judge(const Eigen::MatrixXd& columns) const {
    const Eigen::MatrixXd products = solved_.transpose() * columns;  // [r | J]' Sigma^-1 s
    const Eigen::MatrixXd imitated =
        factor_.matrixL().solve(products.bottomRows(products.rows() - 1));
    const Eigen::VectorXd squares = (node_.squared_norms(context_.observations, columns) -
                                     imitated.colwise().squaredNorm().transpose())
                                        .cwiseMax(0.0);
    const Eigen::VectorXd spoken = products.row(0).transpose() - imitated.transpose() * residual_;
    const Eigen::VectorXd d = squares.cwiseSqrt();
    return {d, (d.array() > kInvisible).select(spoken.array() / d.array(), 0.0)};
  }

  /// All products, including those between the columns.
  [[nodiscard]] Result<GramSystem> system(const JointFit& none,
                                          const Eigen::MatrixXd& columns) const {
    const Eigen::Index q = none.jacobian.cols();
    Eigen::MatrixXd all(columns.rows(), 1 + q + columns.cols());
    all << none.linear_residual(), none.jacobian, columns;
    return marginalise(node_.gram(context_.observations, all), Eigen::MatrixXd::Identity(q, q));
  }

 private:
  static constexpr double kInvisible = 1e-6;

  Judge(const FitContext& context, const JointFit& none)
      : context_(context), node_(context.grid[static_cast<std::size_t>(none.best_node)]) {
    Eigen::MatrixXd base(none.residual.size(), none.jacobian.cols() + 1);
    base << none.linear_residual(), none.jacobian;
    solved_ = node_.solve(context.observations, base);
  }

  const FitContext& context_;
  const NoiseNode& node_;
  Eigen::MatrixXd solved_;              ///< Sigma^-1 [r | J] (n x (1 + q))
  Eigen::LLT<Eigen::MatrixXd> factor_;  ///< I + J' Sigma^-1 J
  Eigen::VectorXd residual_;            ///< (q) J' Sigma^-1 r with that factor.
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
  const AmountPrior prior = amount_prior(candidate);
  // Undated first: dated footprints are cut out of one run.
  Candidate undated = candidate;
  undated.begins = undated.ends = false;
  for (const std::vector<double>& shape : shapes_to_try(candidate)) {
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

void judge_all(const Judge& judge, Footprints& prints) {
  for (std::size_t first = 0; first < prints.looks.size(); first += kColumnsAtOnce) {
    const std::size_t count = std::min(kColumnsAtOnce, prints.looks.size() - first);
    Eigen::MatrixXd columns(prints.columns[first].size(), static_cast<Eigen::Index>(count));
    for (std::size_t i = 0; i < count; ++i) {
      columns.col(static_cast<Eigen::Index>(i)) = prints.columns[first + i];
    }
    const Judgement judged = judge.judge(columns);
    for (std::size_t i = 0; i < count; ++i) {
      Look& look = prints.looks[first + i];
      look.detectability = judged.detectability[static_cast<Eigen::Index>(i)];
      look.score = judged.score[static_cast<Eigen::Index>(i)];
      look.log_bayes_factor = log_bayes_factor(look.detectability, look.score, look.prior);
    }
  }
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
  const auto judge = Judge::make(context, none);
  if (!judge) return tl::unexpected(judge.error());
  const Eigen::VectorXd base = context.observations.stack(predictor.parts_kW(none.theta));
  Eigen::MatrixXd best_columns(base.size(), static_cast<Eigen::Index>(candidates.size()));
  std::vector<CandidateScale> scales;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    Footprints prints = footprints_of(predictor, context, none, candidates[i], i, base);
    if (predictor.is_stopped()) return tl::unexpected(diagnosis_cancelled());
    judge_all(*judge, prints);
    result.candidates.push_back(summarise(prints.looks));
    const Look& best = result.candidates.back().best;
    const auto column = std::ranges::find_if(
        prints.looks, [&](const Look& look) { return look.values == best.values; });
    best_columns.col(static_cast<Eigen::Index>(i)) =
        prints.columns[static_cast<std::size_t>(column - prints.looks.begin())];
    scales.push_back({best.detectability, best.prior});
  }
  const auto system = judge->system(none, best_columns);
  if (!system) return tl::unexpected(system.error());
  result.confusability = confusability(*system);
  result.null_threshold =
      null_threshold(scales, result.confusability, kNullProbability, kNullDraws, rng);
  return result;
}

}  // namespace recald::diagnosis
