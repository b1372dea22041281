#include "core/assessment/given_data.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/absent.hpp"
#include "core/assessment/level_forecast.hpp"
#include "core/assessment/spread.hpp"
#include "core/calibration/checks/leave_out.hpp"
#include "core/calibration/checks/psis.hpp"
#include "core/calibration/posterior/points_at_draw.hpp"

namespace recald::assessment {
namespace {

using calibration::PointBlocks;
using calibration::PosteriorData;
using Eigen::Index;

constexpr double kParetoKMax = 0.7;  // Vehtari et al. (2024): beyond, the estimate is unreliable
constexpr int kBlockMonths = 3;

bool is_given(const AssessedCalibration& result, const OutputCalibration& output, std::size_t i) {
  return result.roles[i] == MonthRole::calibration && !std::isnan(output.measured[i]);
}

/// Whether it has months to learn from.
bool is_measured(const AssessedCalibration& result, const OutputCalibration& output) {
  for (std::size_t i = 0; i < result.roles.size(); ++i) {
    if (is_given(result, output, i)) return true;
  }
  return false;
}

bool is_fitted(const AssessedCalibration& result, const OutputCalibration& output) {
  return output.calibrated && is_measured(result, output);
}

/// Forecast by the model's errors.
bool has_errors(const AssessedCalibration& result, const OutputCalibration& output) {
  return is_measured(result, output) &&
         (output.calibrated || output.following == Following::errors);
}

/// Outputs whose months are given together. The draws have seen those of fitted outputs alone.
struct Group {
  std::vector<bool> given;  ///< (outputs)
  std::vector<bool> asked;  ///< (outputs) Of the given ones those that are forecast.
  bool is_fitted;
};

/// All fitted outputs; then every other one that has errors, together with them: it tells them
/// nothing, as it told the draws nothing. Where one output alone is fitted it stands alone, too,
/// since the draws do not say how outputs hang together.
std::vector<Group> groups_of(const AssessedCalibration& result) {
  std::vector<bool> fitted;
  for (const OutputCalibration& output : result.outputs) {
    fitted.push_back(is_fitted(result, output));
  }
  std::vector<Group> groups;
  const auto count = std::ranges::count(fitted, true);
  if (count == 0) return groups;
  groups.push_back({fitted, fitted, true});
  const std::vector<bool> none(fitted.size(), false);
  for (std::size_t k = 0; k < fitted.size(); ++k) {
    if (fitted[k] || !has_errors(result, result.outputs[k])) continue;
    Group& group = groups.emplace_back(count > 1 ? fitted : none, none, false);
    group.given[k] = true;
    group.asked[k] = true;
  }
  return groups;
}

Index calibration_months(const AssessedCalibration& result) {
  return std::ranges::count(result.roles, MonthRole::calibration);
}

/// The points that are given and, if `with_asked`, all others of the outputs asked, whose values
/// stand for nothing.
PosteriorData points_of(const AssessedCalibration& result, const WholePeriod& whole,
                        const Group& group, bool with_asked) {
  calibration::CalibrationProblem all = problem_of(result, result.month_names.size());
  for (std::size_t k = 0; k < all.outputs.size(); ++k) {
    const OutputCalibration& output = result.outputs[k];
    for (std::size_t i = 0; i < result.roles.size(); ++i) {
      if (group.given[k] && is_given(result, output, i)) continue;
      all.outputs[k].values[i] = group.asked[k] && with_asked ? 0.0 : kAbsent;
    }
    all.outputs[k].extra_variances = known_variances(output);
  }
  all.inputs = whole.inputs;
  all.common_errors = whole.common_errors;
  return calibration::normalise_problem(all, result.calibration.normalisation,
                                        calibration_months(result));
}

/// The covariance of some points, and their residuals, at one draw after the other.
class DrawnErrors {
 public:
  DrawnErrors(const AssessedCalibration& result, PosteriorData data,
              const Eigen::MatrixXd& simulated)
      : result_(result),
        data_(std::move(data)),
        simulated_(simulated),
        points_(data_, result.calibration.hyper_prior),
        residual_(data_.values.size()) {}

  [[nodiscard]] Result<void> go_to(Index draw) {
    const calibration::ThinnedDraws& thinned = result_.calibration.thinned;
    const auto d = static_cast<std::size_t>(draw);
    for (Index p = 0; p < residual_.size(); ++p) {
      residual_(p) = data_.values(p) - scale_of(p).normalise(simulated(draw, p));
    }
    return points_.go_to(result_.calibration.chains[static_cast<std::size_t>(thinned.chain[d])],
                         thinned.iteration[d], residual_);
  }

  [[nodiscard]] const calibration::PointsAtDraw& points() const { return points_; }
  /// What the model has at a point, in units.
  [[nodiscard]] double simulated(Index draw, Index p) const {
    const calibration::PointIndex& point = data_.points[static_cast<std::size_t>(p)];
    return simulated_(draw, point.output * std::ssize(result_.month_names) + point.month);
  }
  [[nodiscard]] const calibration::OutputScale& scale_of(Index p) const {
    return data_.scales[static_cast<std::size_t>(data_.points[static_cast<std::size_t>(p)].output)];
  }
  [[nodiscard]] const PosteriorData& data() const { return data_; }

 private:
  const AssessedCalibration& result_;
  PosteriorData data_;
  const Eigen::MatrixXd& simulated_;
  calibration::PointsAtDraw points_;
  Eigen::VectorXd residual_;
};

Forecast mixture_of(Index draws) {
  return {Eigen::VectorXd(draws), Eigen::VectorXd(draws),
          Eigen::VectorXd::Constant(draws, 1.0 / static_cast<double>(draws))};
}

/// (months) What a month counts in the mean of unseen ones, 0 where it does not; sums to one.
Eigen::VectorXd weights_of_unseen(const AssessedCalibration& result,
                                  const OutputCalibration& output) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(std::ssize(result.roles));
  for (std::size_t i = 0; i < result.roles.size(); ++i) {
    if (result.roles[i] != MonthRole::validation || std::isnan(output.measured[i])) continue;
    weights(static_cast<Index>(i)) = result.month_days.empty() ? 1.0 : result.month_days[i];
  }
  if (weights.sum() > 0.0) weights /= weights.sum();
  return weights;
}

/// Unseen months of a group's outputs, together.
Result<void> forecast_unseen(const AssessedCalibration& result, const WholePeriod& whole,
                             const Group& group, const Eigen::MatrixXd& simulated,
                             std::vector<OutputForecasts>& forecasts) {
  DrawnErrors errors(result, points_of(result, whole, group, true), simulated);
  const auto& points = errors.data().points;
  std::vector<Index> asked;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const OutputCalibration& output = result.outputs[static_cast<std::size_t>(points[p].output)];
    const auto month = static_cast<std::size_t>(points[p].month);
    if (!is_given(result, output, month)) asked.push_back(static_cast<Index>(p));
  }
  if (asked.empty()) return {};
  const auto count = static_cast<Index>(asked.size());
  const auto outputs = static_cast<Index>(result.outputs.size());
  // (asked x outputs) what a point counts in the mean of its output
  Eigen::MatrixXd shares = Eigen::MatrixXd::Zero(count, outputs);
  for (Index k = 0; k < outputs; ++k) {
    const Eigen::VectorXd weights =
        weights_of_unseen(result, result.outputs[static_cast<std::size_t>(k)]);
    for (Index a = 0; a < count; ++a) {
      const auto& point = points[static_cast<std::size_t>(asked[static_cast<std::size_t>(a)])];
      if (point.output == k) shares(a, k) = weights(point.month);
    }
  }
  std::vector<Forecast> by_point(asked.size(), mixture_of(simulated.rows()));
  std::vector<Forecast> means(result.outputs.size(), mixture_of(simulated.rows()));
  Eigen::VectorXd range(count);
  for (Index a = 0; a < count; ++a) {
    range(a) = errors.scale_of(asked[static_cast<std::size_t>(a)]).range();
  }
  Eigen::VectorXd expected(count);
  for (Index d = 0; d < simulated.rows(); ++d) {
    if (auto there = errors.go_to(d); !there) return there;
    const calibration::ConditionalNormal given = errors.points().given_others(asked);
    const Eigen::MatrixXd covariance = range.asDiagonal() * given.covariance * range.asDiagonal();
    for (Index a = 0; a < count; ++a) {
      expected(a) =
          errors.simulated(d, asked[static_cast<std::size_t>(a)]) + range(a) * given.mean(a);
      by_point[static_cast<std::size_t>(a)].means(d) = expected(a);
      by_point[static_cast<std::size_t>(a)].sds(d) = std::sqrt(covariance(a, a));
    }
    for (Index k = 0; k < outputs; ++k) {
      means[static_cast<std::size_t>(k)].means(d) = shares.col(k).dot(expected);
      means[static_cast<std::size_t>(k)].sds(d) =
          std::sqrt(shares.col(k).dot(covariance * shares.col(k)));
    }
  }
  for (std::size_t a = 0; a < asked.size(); ++a) {
    const auto& point = points[static_cast<std::size_t>(asked[a])];
    forecasts[static_cast<std::size_t>(point.output)]
        .months[static_cast<std::size_t>(point.month)] = std::move(by_point[a]);
  }
  for (Index k = 0; k < outputs; ++k) {
    if (shares.col(k).sum() > 0.0) {
      forecasts[static_cast<std::size_t>(k)].unseen_mean =
          std::move(means[static_cast<std::size_t>(k)]);
    }
  }
  return {};
}

/// Points that are left out together, with what is kept of every draw.
struct LeftOut {
  explicit LeftOut(PointBlocks these, Index points, Index draws)
      : blocks(std::move(these)),
        scores(draws, static_cast<Index>(blocks.size())),
        by_point(static_cast<std::size_t>(points), mixture_of(draws)) {}

  void take(const DrawnErrors& errors, Index d) {
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      scores(d, static_cast<Index>(b)) = errors.points().log_score(blocks[b]);
      const calibration::ConditionalNormal given = errors.points().given_others(blocks[b]);
      for (std::size_t i = 0; i < blocks[b].size(); ++i) {
        const Index p = blocks[b][i];
        const auto row = static_cast<Index>(i);
        const double range = errors.scale_of(p).range();
        Forecast& forecast = by_point[static_cast<std::size_t>(p)];
        forecast.means(d) = errors.simulated(d, p) + range * given.mean(row);
        forecast.sds(d) = range * std::sqrt(given.covariance(row, row));
      }
    }
  }

  /// Weighs the draws as if the block had not been seen. @return the blocks' Pareto k.
  std::vector<double> reweight() {
    std::vector<double> pareto_k;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const auto smoothed = calibration::pareto_smooth(-scores.col(static_cast<Index>(b)));
      pareto_k.push_back(smoothed.pareto_k);
      for (const Index p : blocks[b]) {
        by_point[static_cast<std::size_t>(p)].weights = smoothed.log_weight.array().exp();
      }
    }
    return pareto_k;
  }

  PointBlocks blocks;
  Eigen::MatrixXd scores;  ///< (draws x blocks)
  std::vector<Forecast> by_point;
};

/// Calibration months of a group's outputs, as if they had not been seen.
Result<void> forecast_seen(const AssessedCalibration& result, const WholePeriod& whole,
                           const Group& group, const Eigen::MatrixXd& simulated,
                           std::vector<OutputForecasts>& forecasts) {
  DrawnErrors errors(result, points_of(result, whole, group, false), simulated);
  const auto& points = errors.data().points;
  const auto left_out = [&](int months) {
    return LeftOut{calibration::blocks_of_months(points, months), std::ssize(points),
                   simulated.rows()};
  };
  LeftOut one = left_out(1);
  LeftOut three = left_out(kBlockMonths);
  // With all months left out nothing is given.
  const bool has_blocks = three.blocks.size() > 1;
  if (one.blocks.size() < 2) return {};
  for (Index d = 0; d < simulated.rows(); ++d) {
    if (auto there = errors.go_to(d); !there) return there;
    one.take(errors, d);
    if (has_blocks) three.take(errors, d);
  }
  // Draws that have not seen an output's months need no weights to forget them.
  std::vector<double> pareto_k;
  if (group.is_fitted) {
    pareto_k = one.reweight();
    if (has_blocks) (void)three.reweight();
  }
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (!group.asked[static_cast<std::size_t>(points[p].output)]) continue;
    OutputForecasts& output = forecasts[static_cast<std::size_t>(points[p].output)];
    const auto month = static_cast<std::size_t>(points[p].month);
    output.months[month] = std::move(one.by_point[p]);
    if (has_blocks) output.blocks[month] = std::move(three.by_point[p]);
  }
  const auto unreliable = std::ranges::count_if(pareto_k, [](double k) { return k > kParetoKMax; });
  for (std::size_t k = 0; k < forecasts.size(); ++k) {
    if (group.is_fitted && group.asked[k]) {
      forecasts[k].unreliable_months = static_cast<int>(unreliable);
    }
  }
  return {};
}

/// An output that is not fitted: its meter's level against what the model has of it.
void follow_level(const AssessedCalibration& result, const OutputCalibration& output,
                  const Eigen::VectorXd& modelled, OutputForecasts& forecasts) {
  if (!(modelled.minCoeff() > 0.0)) return;
  std::vector<std::size_t> given;
  for (std::size_t i = 0; i < result.roles.size(); ++i) {
    if (is_given(result, output, i)) given.push_back(i);
  }
  if (given.size() < 2) return;
  const auto at = [&](std::size_t i) { return modelled(static_cast<Index>(i)); };
  /// Without the given months number [begin, end).
  const auto level_without = [&](std::size_t begin, std::size_t end) {
    LevelForecast level{kProfiledLevel};
    for (std::size_t j = 0; j < given.size(); ++j) {
      if (j < begin || j >= end) level.take(at(given[j]), output.measured[given[j]]);
    }
    return level;
  };
  const LevelForecast whole = level_without(0, 0);
  for (std::size_t i = 0; i < result.roles.size(); ++i) {
    if (!is_given(result, output, i)) forecasts.months[i] = whole.forecast(at(i));
  }
  for (std::size_t j = 0; j < given.size(); ++j) {
    forecasts.months[given[j]] = level_without(j, j + 1).forecast(at(given[j]));
    const std::size_t first = j - j % kBlockMonths;
    const std::size_t last = std::min(first + kBlockMonths, given.size());
    if (last - first < given.size()) {
      forecasts.blocks[given[j]] = level_without(first, last).forecast(at(given[j]));
    }
  }
  const Eigen::VectorXd weights = weights_of_unseen(result, output);
  if (weights.sum() > 0.0) forecasts.unseen_mean = whole.forecast_mean(modelled, weights);
}

}  // namespace

void scale_followed(AssessedCalibration& result) {
  const Eigen::MatrixXd& runs = result.calibration.design.outputs;
  const Index months = runs.cols() / std::ssize(result.outputs);
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    OutputCalibration& output = result.outputs[k];
    if (output.calibrated || output.following != Following::errors) continue;
    const auto block = runs.middleCols(static_cast<Index>(k) * months, months);
    if (block.size() == 0 || !(block.maxCoeff() > block.minCoeff())) {
      output.following = Following::level;
    } else {
      result.calibration.normalisation.scales[k] = {block.minCoeff(), block.maxCoeff()};
    }
  }
}

Result<std::vector<OutputForecasts>> forecast_given_data(const AssessedCalibration& result,
                                                         const WholePeriod& whole,
                                                         const Eigen::MatrixXd& simulated) {
  const std::size_t months = result.month_names.size();
  std::vector<OutputForecasts> forecasts(result.outputs.size());
  for (OutputForecasts& output : forecasts) {
    output.months.resize(months);
    output.blocks.resize(months);
  }
  const std::vector<Group> groups = groups_of(result);
  for (const Group& group : groups) {
    TRY(forecast_unseen(result, whole, group, simulated, forecasts));
    TRY(forecast_seen(result, whole, group, simulated, forecasts));
  }
  for (std::size_t k = 0; k < result.outputs.size(); ++k) {
    if (!groups.empty() && has_errors(result, result.outputs[k])) continue;
    const auto first = static_cast<Index>(k * months);
    const Eigen::VectorXd modelled =
        simulated.middleCols(first, static_cast<Index>(months)).colwise().mean();
    follow_level(result, result.outputs[k], modelled, forecasts[k]);
  }
  return forecasts;
}

void adapt_to_scatter(const AssessedCalibration& result, std::size_t k,
                      OutputForecasts& forecasts) {
  const OutputCalibration& output = result.outputs[k];
  if (!has_errors(result, output)) return;
  const OutputForecasts plain = forecasts;
  const double full = result.calibration.normalisation.scales[k].max;
  const auto level_of = [&](const Forecast& forecast) { return forecast.mean() / full; };
  std::vector<std::size_t> seen;
  for (std::size_t i = 0; i < result.roles.size(); ++i) {
    if (is_given(result, output, i) && plain.months[i]) seen.push_back(i);
  }
  std::vector<double> surprises;
  for (const std::size_t i : seen) {
    surprises.push_back(standardised_surprise(*plain.months[i], output.measured[i]));
  }
  /// Learnt from all but the seen months number [begin, end).
  const auto spread_without = [&](std::size_t begin, std::size_t end) {
    Spread spread;
    for (std::size_t j = 0; j < seen.size(); ++j) {
      if (j < begin || j >= end) spread.take(level_of(*plain.months[seen[j]]), surprises[j]);
    }
    return spread;
  };
  const Spread whole = spread_without(0, 0);
  for (std::size_t i = 0; i < result.roles.size(); ++i) {
    if (!plain.months[i] || is_given(result, output, i)) continue;
    forecasts.months[i] = whole.adapt(*plain.months[i], level_of(*plain.months[i]));
  }
  for (std::size_t j = 0; j < seen.size(); ++j) {
    const Forecast& month = *plain.months[seen[j]];
    forecasts.months[seen[j]] = spread_without(j, j + 1).adapt(month, level_of(month));
    const auto& block = plain.blocks[seen[j]];
    if (!block) continue;
    const std::size_t first = j - j % kBlockMonths;
    forecasts.blocks[seen[j]] =
        spread_without(first, first + kBlockMonths).adapt(*block, level_of(*block));
  }
}

}  // namespace recald::assessment
