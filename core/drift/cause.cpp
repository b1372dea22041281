#include "core/drift/cause.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "core/absent.hpp"
#include "core/calibration/samplers/log_sum.hpp"
#include "core/random/rng.hpp"
#include "core/random/streams.hpp"

namespace recald::drift {
namespace {

using calibration::Posterior;
using calibration::PosteriorData;

double log_normal(const Eigen::VectorXd& residual, const Eigen::LLT<Eigen::MatrixXd>& factor) {
  const Eigen::VectorXd white = factor.matrixL().solve(residual);
  const auto diagonal = factor.matrixLLT().diagonal();
  return -0.5 * white.squaredNorm() - diagonal.array().log().sum() -
         0.5 * static_cast<double>(residual.size()) * std::log(2.0 * std::numbers::pi);
}

/// One output's months since the change, as shares of what was modelled.
struct LevelBlock {
  int output;
  Eigen::VectorXd differences;  ///< measured / modelled - 1
  Eigen::VectorXd progress;     ///< Of the time from the change to the last month, 0 to 1.
  double level;                 ///< Learnt before.
  double sd;                    ///< Of a month …
  double level_sd;              ///< … and of the level.
};

/// Of a month, from the change (just above 0) to the last one that is known (1).
double progress_at(const ChangeCase& change, int month) {
  return static_cast<double>(month - change.since + 1) /
         static_cast<double>(change.until - change.since + 1);
}

/// Over all months since the change.
double mean_progress(const ChangeCase& change) {
  const double months = change.until - change.since + 1;
  return (months + 1.0) / (2.0 * months);
}

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

std::vector<LevelBlock> level_blocks(const ChangeCase& change) {
  std::vector<LevelBlock> blocks;
  for (const LevelOutput& output : change.levels) {
    LevelForecast learnt;
    std::vector<double> since;
    std::vector<double> progress;
    for (int month = std::max(change.learning_months, change.first); month <= change.until;
         ++month) {
      const auto i = static_cast<std::size_t>(month);
      if (std::isnan(output.measured[i])) continue;
      if (month < change.since) {
        learnt.take(output.modelled[i], output.measured[i]);
      } else {
        since.push_back(output.measured[i] / output.modelled[i] - 1.0);
        progress.push_back(progress_at(change, month));
      }
    }
    if (since.empty()) continue;
    blocks.push_back({output.output, vector_of(since), vector_of(progress), learnt.level(),
                      learnt.scatter(), learnt.level_sd()});
  }
  return blocks;
}

/// @param moved_by  (months of the block)
double log_likelihood(const LevelBlock& block, const Eigen::ArrayXd& moved_by, double more_sd = 0.0,
                      double monthly_sd = 0.0) {
  const Eigen::Index n = block.differences.size();
  const double shared = block.level_sd * block.level_sd + more_sd * more_sd;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Constant(n, n, shared);
  covariance.diagonal().array() += block.sd * block.sd + monthly_sd * monthly_sd;
  return log_normal(block.differences.array() - block.level - moved_by,
                    Eigen::LLT<Eigen::MatrixXd>{covariance});
}

double log_likelihood(const LevelBlock& block, double moved_by, double more_sd = 0.0,
                      double monthly_sd = 0.0) {
  return log_likelihood(block, Eigen::ArrayXd::Constant(block.differences.size(), moved_by),
                        more_sd, monthly_sd);
}

/// How a use changes: by one factor from then on, by a factor that is another one each month
/// (people are away more in one than in the next), or more and more until the last month.
enum class Course : std::uint8_t { even, uneven, growing };
constexpr std::array kCourses{Course::even, Course::uneven, Course::growing};

/// What is tried, and how it did, value by value.
struct Contest {
  CauseKind kind;
  int index;
  double prior;
  std::vector<double> log_likelihoods{};  ///< By particle and value.
  std::vector<double> values{};           ///< Beside them; empty for kinds without any.
};

Cause cause_of(const Contest& contest) {
  Cause cause{.kind = contest.kind,
              .index = contest.index,
              .mean = kAbsent,
              .q05 = kAbsent,
              .q95 = kAbsent};
  const Eigen::VectorXd logs = Eigen::Map<const Eigen::VectorXd>(
      contest.log_likelihoods.data(), static_cast<Eigen::Index>(contest.log_likelihoods.size()));
  const double total = calibration::log_sum(logs);
  cause.log_evidence = total - std::log(static_cast<double>(logs.size()));
  if (contest.values.empty()) return cause;
  std::vector<std::size_t> order(contest.values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return contest.values[i]; });
  double sum = 0.0;
  cause.mean = 0.0;
  for (const std::size_t i : order) {
    const double weight = std::exp(contest.log_likelihoods[i] - total);
    cause.mean += weight * contest.values[i];
    if (sum <= 0.05) cause.q05 = contest.values[i];
    if (sum <= 0.95) cause.q95 = contest.values[i];
    sum += weight;
  }
  return cause;
}

/// The months since the change, given those before, at one particle.
class MonthsSinceChange {
 public:
  MonthsSinceChange(Posterior& posterior, int since) : posterior_(posterior) {
    const auto& points = posterior.data().points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      (points[i].month >= since ? ahead_ : behind_).push_back(static_cast<Eigen::Index>(i));
    }
  }

  /// @return false where the covariance has no factor.
  [[nodiscard]] bool place(const Eigen::VectorXd& theta,
                           const calibration::Hyperparameters& hyper) {
    if (!posterior_.set_hyperparameters(hyper)) return false;
    theta_ = theta;
    const Eigen::Index m = posterior_.point_count();
    Eigen::MatrixXd precision(m, m);
    posterior_.precision(precision);
    covariance_ = Eigen::MatrixXd(precision(ahead_, ahead_)).inverse();
    factor_.compute(covariance_);
    const Eigen::VectorXd residual = all_residuals(theta_);
    shift_ = -covariance_ * (precision(ahead_, behind_) * Eigen::VectorXd(residual(behind_)));
    residual_ = residual(ahead_) - shift_;
    modelled_ = posterior_.data().values(ahead_) - Eigen::VectorXd(residual(ahead_));
    return factor_.info() == Eigen::Success;
  }

  [[nodiscard]] double unchanged() const { return log_normal(residual_, factor_); }

  [[nodiscard]] double with_parameter(Eigen::Index j, double value) {
    Eigen::VectorXd moved = theta_;
    moved(j) = value;
    return log_normal(Eigen::VectorXd(all_residuals(moved)(ahead_)) - shift_, factor_);
  }

  [[nodiscard]] double with_factor(int output, double factor) const {
    Eigen::VectorXd residual = residual_;
    for (Eigen::Index i = 0; i < residual.size(); ++i) {
      if (output_of(i) == output) residual(i) -= (factor - 1.0) * in_own_range(i);
    }
    return log_normal(residual, factor_);
  }

  /// @param growing     Up to the amplitude in the last month.
  /// @param monthly_sd  By which the amplitude differs between months; the same for all points of a
  ///                    month, and of its own for what is followed by its level.
  [[nodiscard]] double with_direction(const ChangeCase& change, const Direction& direction,
                                      double amplitude, bool growing, double monthly_sd) const {
    const Eigen::VectorXd along = changes_along(direction);
    Eigen::VectorXd residual = residual_;
    for (Eigen::Index i = 0; i < residual.size(); ++i) {
      const double share = growing ? progress_at(change, point(i).month) : 1.0;
      residual(i) -= share * amplitude * along(i);
    }
    if (monthly_sd == 0.0) return log_normal(residual, factor_);
    Eigen::MatrixXd covariance = covariance_;
    for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
      for (Eigen::Index j = 0; j < covariance.cols(); ++j) {
        if (point(i).month != point(j).month) continue;
        covariance(i, j) += monthly_sd * monthly_sd * along(i) * along(j);
      }
    }
    return log_normal(residual, Eigen::LLT<Eigen::MatrixXd>{covariance});
  }

  /// Each output, or one, moved by a share of itself that is not quite the same in all months.
  /// @param only  -1: each.
  [[nodiscard]] double with_unknown(double sd, int only, double monthly_sd) const {
    Eigen::MatrixXd covariance = covariance_;
    for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
      for (Eigen::Index j = 0; j < covariance.cols(); ++j) {
        if (output_of(i) != output_of(j) || (only >= 0 && output_of(i) != only)) continue;
        const double share = sd * sd + (i == j ? monthly_sd * monthly_sd : 0.0);
        covariance(i, j) += share * in_own_range(i) * in_own_range(j);
      }
    }
    return log_normal(residual_, Eigen::LLT<Eigen::MatrixXd>{covariance});
  }

  [[nodiscard]] bool has(int output) const {
    for (Eigen::Index i = 0; i < std::ssize(ahead_); ++i) {
      if (output_of(i) == output) return true;
    }
    return false;
  }

 private:
  [[nodiscard]] const Eigen::VectorXd& all_residuals(const Eigen::VectorXd& theta) {
    return posterior_.residual_at({theta.data(), static_cast<std::size_t>(theta.size())});
  }
  [[nodiscard]] const calibration::PointIndex& point(Eigen::Index i) const {
    const auto row = static_cast<std::size_t>(ahead_[static_cast<std::size_t>(i)]);
    return posterior_.data().points[row];
  }
  [[nodiscard]] int output_of(Eigen::Index i) const { return point(i).output; }
  /// One value for each point since the change, on the normalised scale, for an amplitude of 1.
  [[nodiscard]] Eigen::VectorXd changes_along(const Direction& direction) const {
    const auto months = static_cast<std::size_t>(posterior_.data().month_inputs.rows());
    Eigen::VectorXd along(std::ssize(ahead_));
    for (Eigen::Index i = 0; i < along.size(); ++i) {
      const auto output = static_cast<std::size_t>(output_of(i));
      const auto at = output * months + static_cast<std::size_t>(point(i).month);
      along(i) = direction.change[at] / posterior_.data().scales[output].range();
    }
    return along;
  }
  /// What was modelled, in the output's unit over its range.
  [[nodiscard]] double in_own_range(Eigen::Index i) const {
    const auto& scale = posterior_.data().scales[static_cast<std::size_t>(output_of(i))];
    return modelled_(i) + scale.min / scale.range();
  }

  Posterior& posterior_;
  std::vector<Eigen::Index> ahead_;
  std::vector<Eigen::Index> behind_;
  Eigen::VectorXd theta_;
  Eigen::VectorXd shift_;
  Eigen::VectorXd residual_;
  Eigen::VectorXd modelled_;
  Eigen::MatrixXd covariance_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

/// The kinds with their members, before anything is tried.
std::vector<Contest> contests_of(const ChangeCase& change, const CauseOptions& options,
                                 const std::vector<int>& meters) {
  std::vector<Contest> contests{{CauseKind::nothing, 0, options.nothing},
                                {CauseKind::unknown, -1, 0.5 * options.unknown}};
  const std::size_t building = change.parameters.size() + change.directions.size();
  for (std::size_t j = 0; j < change.parameters.size(); ++j) {
    contests.push_back({CauseKind::parameter, static_cast<int>(j),
                        options.building / static_cast<double>(building)});
  }
  for (std::size_t d = 0; d < change.directions.size(); ++d) {
    contests.push_back({CauseKind::direction, static_cast<int>(d),
                        options.building / static_cast<double>(building)});
  }
  for (const int output : meters) {
    const auto count = static_cast<double>(meters.size());
    contests.push_back({CauseKind::unknown, output, 0.5 * options.unknown / count});
    contests.push_back({CauseKind::meter, output, options.meters / count});
  }
  return contests;
}

/// Everything that one particle says of all causes.
class Trial {
 public:
  Trial(const ChangeCase& change, const CauseOptions& options, MonthsSinceChange& since,
        const std::vector<LevelBlock>& blocks)
      : change_(change), options_(options), since_(since), blocks_(blocks) {}

  void run(Contest& contest, Rng& rng) {
    switch (contest.kind) {
      case CauseKind::nothing:
        contest.log_likelihoods.push_back(since_.unchanged() + of_levels(-1, 0.0));
        return;
      case CauseKind::unknown:
        contest.log_likelihoods.push_back(with_unknown(contest.index));
        return;
      case CauseKind::parameter:
        return try_values(contest, rng, [&](double u) {
          const Prior& prior = change_.parameters[static_cast<std::size_t>(contest.index)].prior;
          const double value = prior.quantile(u);
          return std::pair{value, since_.with_parameter(contest.index, value) + of_levels(-1, 0.0)};
        });
      case CauseKind::direction:
        for (const Course course : kCourses) {
          try_values(contest, rng, [&](double u) {
            const double amplitude = factor_at(u) - 1.0;
            const double mean = course == Course::growing ? mean_progress(change_) : 1.0;
            return std::pair{1.0 + mean * amplitude,
                             with_direction(contest.index, amplitude, course)};
          });
        }
        return;
      case CauseKind::meter:
        return try_values(contest, rng, [&](double u) {
          const double factor = factor_at(u);
          return std::pair{factor, since_.with_factor(contest.index, factor) +
                                       of_levels(contest.index, factor - 1.0)};
        });
      case CauseKind::effect:
        return;  // The hours put names to causes, later.
    }
  }

 private:
  [[nodiscard]] double factor_at(double u) const {
    return std::exp(options_.factor_sd * boost::math::quantile(boost::math::normal{}, u));
  }
  [[nodiscard]] double with_direction(int index, double amplitude, Course course) const {
    const bool growing = course == Course::growing;
    const double uneven =
        course == Course::uneven ? options_.uneven_share * std::abs(amplitude) : 0.0;
    double sum = since_.with_direction(change_, change_.directions[static_cast<std::size_t>(index)],
                                       amplitude, growing, uneven);
    for (const LevelBlock& block : blocks_) {
      const Eigen::ArrayXd moved =
          growing ? Eigen::ArrayXd(amplitude * block.progress.array())
                  : Eigen::ArrayXd::Constant(block.differences.size(), amplitude);
      sum += log_likelihood(block, moved, 0.0, uneven);
    }
    return sum;
  }
  [[nodiscard]] double with_unknown(int only) const {
    const double sd = only < 0 ? options_.unknown_sd : options_.factor_sd;
    const double monthly_sd = only < 0 ? 0.0 : options_.monthly_sd;
    double sum = since_.with_unknown(sd, only, monthly_sd);
    for (const LevelBlock& block : blocks_) {
      const bool moved = only < 0 || block.output == only;
      sum += log_likelihood(block, 0.0, moved ? sd : 0.0, moved ? monthly_sd : 0.0);
    }
    return sum;
  }
  /// @param output  That moved; -1: none.
  [[nodiscard]] double of_levels(int output, double moved_by) const {
    double sum = 0.0;
    for (const LevelBlock& block : blocks_) {
      sum += log_likelihood(block, block.output == output ? moved_by : 0.0);
    }
    return sum;
  }
  /// Values spread evenly over their prior, begun anywhere.
  template <class Try>
  void try_values(Contest& contest, Rng& rng, Try attempt) {
    const double start = rng.uniform();
    for (int g = 0; g < options_.values; ++g) {
      const auto [value, likelihood] = attempt((g + start) / options_.values);
      contest.values.push_back(value);
      contest.log_likelihoods.push_back(
          std::isnan(likelihood) ? -std::numeric_limits<double>::infinity() : likelihood);
    }
  }

  const ChangeCase& change_;
  const CauseOptions& options_;
  MonthsSinceChange& since_;
  const std::vector<LevelBlock>& blocks_;
};

/// Points from the first month that counts to the last one that is known.
PosteriorData known_points(const ChangeCase& change) {
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < change.data.points.size(); ++i) {
    const int month = change.data.points[i].month;
    if (change.first <= month && month <= change.until)
      rows.push_back(static_cast<Eigen::Index>(i));
  }
  return select_points(change.data, rows);
}

std::vector<int> meters_of(const ChangeCase& change, const MonthsSinceChange& since,
                           const std::vector<LevelBlock>& blocks) {
  std::vector<int> meters;
  for (int output = 0; output < std::ssize(change.data.scales); ++output) {
    const bool is_level = std::ranges::find(blocks, output, &LevelBlock::output) != blocks.end();
    if (since.has(output) || is_level) meters.push_back(output);
  }
  return meters;
}

}  // namespace

Result<std::vector<Eigen::VectorXd>> known_before(const ChangeCase& change,
                                                  const CauseOptions& options, std::uint64_t seed,
                                                  const std::function<bool()>& proceed) {
  SequentialCalibration before{change.model, change.parameters,  change.data, change.prior,
                               {},           {.particles = 512}, seed};
  std::vector<int> months(static_cast<std::size_t>(std::max(0, change.since - change.first)));
  std::iota(months.begin(), months.end(), change.first);
  if (months.empty()) {
    return failure(ErrorCode::not_enough_data, "there is no month before the change");
  }
  TRY(before.learn(std::move(months), proceed));
  if (!before.has_begun()) {
    return failure(ErrorCode::not_enough_data, "there are too few months before the change");
  }
  return before.spread(options.particles);
}

Result<std::vector<Cause>> weigh_causes(const ChangeCase& change,
                                        const std::vector<Eigen::VectorXd>& before,
                                        const CauseOptions& options, std::uint64_t seed) {
  auto posterior =
      TRY(Posterior::make(change.model, change.parameters, known_points(change), change.prior));

  const std::vector<LevelBlock> blocks = level_blocks(change);
  MonthsSinceChange since{posterior, change.since};
  std::vector<Contest> contests = contests_of(change, options, meters_of(change, since, blocks));
  Trial trial{change, options, since, blocks};
  Rng rng{seed, streams::kCauses.first};
  Eigen::VectorXd theta(posterior.parameter_count());
  calibration::Hyperparameters hyper{0.0, 0.0, Eigen::VectorXd(posterior.kernel_dimension())};
  for (const Eigen::VectorXd& position : before) {
    posterior.to_natural(position, theta, hyper);
    if (!since.place(theta, hyper)) continue;
    for (Contest& contest : contests) trial.run(contest, rng);
  }
  if (contests.front().log_likelihoods.empty()) {
    return failure(ErrorCode::not_positive_definite,
                   "no particle has a covariance with a Cholesky factor");
  }

  std::vector<Cause> causes;
  Eigen::VectorXd logs(std::ssize(contests));
  for (std::size_t i = 0; i < contests.size(); ++i) {
    causes.push_back(cause_of(contests[i]));
    logs(static_cast<Eigen::Index>(i)) = causes.back().log_evidence + std::log(contests[i].prior);
  }
  const double total = calibration::log_sum(logs);
  for (std::size_t i = 0; i < causes.size(); ++i) {
    causes[i].probability = std::exp(logs(static_cast<Eigen::Index>(i)) - total);
  }
  std::ranges::stable_sort(causes, std::ranges::greater{}, &Cause::probability);
  return causes;
}

}  // namespace recald::drift
