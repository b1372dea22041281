#include "core/drift/sequential.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "core/calibration/covariance/conditional.hpp"
#include "core/calibration/samplers/log_sum.hpp"
#include "core/calibration/samplers/smc.hpp"
#include "core/random/streams.hpp"

namespace recald::drift {
namespace {

using calibration::Particles;
using calibration::Posterior;
using calibration::PosteriorData;

/// Fewer effective particles than this share stand for nothing that moves could repair.
constexpr double kHopelessShare = 0.02;

/// log likelihood of every particle under a posterior.
Result<Eigen::VectorXd> log_likelihoods(Posterior& posterior, const Particles& particles) {
  Eigen::VectorXd values(particles.count());
  Eigen::VectorXd position;
  for (Eigen::Index i = 0; i < particles.count(); ++i) {
    position = particles.positions.col(i);
    const auto density = TRY(posterior.log_density(position));
    values(i) = std::isnan(density) ? -std::numeric_limits<double>::infinity()
                                    : density - particles.log_prior(i);
  }
  return values;
}

/// Weights the particles by their rise. @return the log of the weighted mean rise.
double reweight(Particles& particles, const Eigen::VectorXd& log_likelihood) {
  const double before = calibration::log_sum(particles.log_weight);
  for (Eigen::Index i = 0; i < particles.count(); ++i) {
    // A particle that was impossible stays so; its rise would be no number.
    const bool was_possible = std::isfinite(particles.log_likelihood(i));
    particles.log_weight(i) += was_possible ? log_likelihood(i) - particles.log_likelihood(i)
                                            : -std::numeric_limits<double>::infinity();
  }
  particles.log_likelihood = log_likelihood;
  return calibration::log_sum(particles.log_weight) - before;
}

double effective_share(const Particles& particles) {
  return calibration::effective_count(particles.log_weight) /
         static_cast<double>(particles.count());
}

/// `count` of the particles, evenly by weight, in their order.
std::vector<Eigen::Index> spread_over(const Particles& particles, int count) {
  const double total = calibration::log_sum(particles.log_weight);
  std::vector<Eigen::Index> chosen;
  double reached = 0.0;
  for (Eigen::Index i = 0; i < particles.count(); ++i) {
    reached += std::exp(particles.log_weight(i) - total) * count;
    while (static_cast<double>(chosen.size()) + 0.5 <= reached && std::ssize(chosen) < count) {
      chosen.push_back(i);
    }
  }
  while (std::ssize(chosen) < count) chosen.push_back(chosen.empty() ? 0 : chosen.back());
  return chosen;
}

}  // namespace

PosteriorData select_points(const PosteriorData& data, const std::vector<Eigen::Index>& rows) {
  PosteriorData selected = data;
  selected.points.clear();
  for (const Eigen::Index row : rows) {
    selected.points.push_back(data.points[static_cast<std::size_t>(row)]);
  }
  selected.values = data.values(rows);
  selected.extra_variances = data.extra_variances(rows);
  if (data.common_errors.cols() > 0) selected.common_errors = data.common_errors(rows, Eigen::all);
  return selected;
}

std::vector<Eigen::Index> rows_without(const PosteriorData& data, int output, int since) {
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const bool is_doubted = data.points[i].output == output && data.points[i].month >= since;
    if (!is_doubted) rows.push_back(static_cast<Eigen::Index>(i));
  }
  return rows;
}

SequentialCalibration::SequentialCalibration(const MonthlyModel& model,
                                             std::vector<Parameter> parameters, PosteriorData all,
                                             calibration::HyperPrior prior, Window window,
                                             const SequentialOptions& options, std::uint64_t seed)
    : model_(model.clone()),
      parameters_(std::move(parameters)),
      all_(std::move(all)),
      prior_(std::move(prior)),
      window_(std::move(window)),
      options_(options),
      seed_(seed) {
  assert(options.particles >= 16 && options.forecast_particles >= 1);
  prior_variances_ = all_.extra_variances.array() + 1.0 / prior_.discrepancy_precision.mean() +
                     1.0 / prior_.error_precision.mean();
}

PosteriorData SequentialCalibration::points_seen_from(int newest, int added) const {
  const int oldest = window_.months > 0 ? std::max(oldest_, newest - window_.months + 1) : oldest_;
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < all_.points.size(); ++i) {
    const int month = all_.points[i].month;
    const bool is_held = month >= oldest && std::ranges::binary_search(taken_, month);
    if (is_held || month == added) rows.push_back(static_cast<Eigen::Index>(i));
  }
  PosteriorData data = select_points(all_, rows);
  if (window_.half_life_months <= 0.0) return data;
  for (Eigen::Index i = 0; i < data.extra_variances.size(); ++i) {
    const int age = std::max(0, newest - data.points[static_cast<std::size_t>(i)].month);
    data.extra_variances(i) += (std::exp2(age / window_.half_life_months) - 1.0) *
                               prior_variances_(rows[static_cast<std::size_t>(i)]);
  }
  return data;
}

Result<Posterior> SequentialCalibration::posterior_of(PosteriorData data) const {
  return Posterior::make(*model_, parameters_, std::move(data), prior_);
}

Result<std::vector<Forecast>> SequentialCalibration::forecast(int month) {
  assert(has_begun() && !std::ranges::binary_search(taken_, month));
  PosteriorData data = points_seen_from(taken_.back(), month);
  std::vector<Eigen::Index> ahead;
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (data.points[i].month != month) continue;
    ahead.push_back(row);
    data.values(row) = 0.0;  // then the residual there is -f, and nobody has looked
  }
  auto joint = TRY(posterior_of(std::move(data)));

  const auto chosen = spread_over(*particles_, options_.forecast_particles);
  const auto n = static_cast<Eigen::Index>(chosen.size());
  std::vector<Forecast> forecasts(
      ahead.size(), Forecast{Eigen::VectorXd(n), Eigen::VectorXd(n),
                             Eigen::VectorXd::Constant(n, 1.0 / static_cast<double>(n))});
  Eigen::VectorXd theta(joint.parameter_count());
  calibration::Hyperparameters hyper{0.0, 0.0, Eigen::VectorXd(joint.kernel_dimension())};
  const Eigen::Index m = joint.point_count();
  Eigen::MatrixXd precision(m, m);
  for (Eigen::Index k = 0; k < n; ++k) {
    joint.to_natural(particles_->positions.col(chosen[static_cast<std::size_t>(k)]), theta, hyper);
    if (!joint.set_hyperparameters(hyper)) {
      return failure(ErrorCode::not_positive_definite,
                     "a particle of the posterior has a covariance without a Cholesky factor");
    }
    const Eigen::VectorXd& residual =
        joint.residual_at({theta.data(), static_cast<std::size_t>(theta.size())});
    joint.precision(precision);
    const auto given = calibration::condition(precision, residual, precision * residual, ahead);
    for (std::size_t i = 0; i < ahead.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      forecasts[i].means(k) = given.mean(row) - residual(ahead[i]);
      forecasts[i].sds(k) = std::sqrt(given.covariance(row, row));
    }
  }
  return forecasts;
}

Result<void> SequentialCalibration::begin_anew(Posterior& posterior, MonthTaken& taken,
                                               const std::function<bool()>& proceed) {
  Rng rng{seed_, streams::kMonths[2 * static_cast<std::uint64_t>(taken.month) + 1]};
  const auto chain =
      TRY(calibration::smc(posterior, {.iterations = options_.particles, .burn_in = 0}, rng,
                           [&](int, int) { return !proceed || proceed(); }));
  const Eigen::Index count = chain.draws.rows();
  Particles particles{chain.draws.transpose(), Eigen::VectorXd(count), Eigen::VectorXd(count),
                      Eigen::VectorXd::Zero(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    particles.log_prior(i) = posterior.log_prior(particles.positions.col(i));
    particles.log_likelihood(i) = chain.log_density(i) - particles.log_prior(i);
  }
  particles_ = std::move(particles);
  taken.anew = true;
  months_since_anew_ = 0;
  return {};
}

Result<MonthTaken> SequentialCalibration::learn(std::vector<int> months,
                                                const std::function<bool()>& proceed) {
  assert(taken_.empty() && !months.empty() && std::ranges::is_sorted(months));
  taken_ = std::move(months);
  auto learnt = learn_again(proceed);
  if (!learnt) taken_.clear();
  return learnt;
}

Result<MonthTaken> SequentialCalibration::learn_again(const std::function<bool()>& proceed) {
  MonthTaken taken{.month = taken_.back()};
  PosteriorData data = points_seen_from(taken.month, taken.month);
  if (data.points.size() < parameters_.size() + 2) {
    particles_.reset();
    return taken;
  }
  auto posterior = TRY(posterior_of(std::move(data)));
  TRY(begin_anew(posterior, taken, proceed));
  return taken;
}

Result<void> SequentialCalibration::begin_at(int month, const std::function<bool()>& proceed) {
  const int before = std::exchange(oldest_, std::max(oldest_, month));
  const auto learnt = learn_again(proceed);
  if (learnt) return {};
  oldest_ = before;
  return tl::unexpected(learnt.error());
}

Result<void> SequentialCalibration::set_aside(int output, int since,
                                              const std::function<bool()>& proceed) {
  const std::vector<Eigen::Index> rows = rows_without(all_, output, since);
  PosteriorData all = std::exchange(all_, select_points(all_, rows));
  Eigen::VectorXd variances =
      std::exchange(prior_variances_, Eigen::VectorXd{prior_variances_(rows)});
  const auto learnt = learn_again(proceed);
  if (learnt) return {};
  all_ = std::move(all);
  prior_variances_ = std::move(variances);
  return tl::unexpected(learnt.error());
}

Result<MonthTaken> SequentialCalibration::take(int month, const std::function<bool()>& proceed) {
  assert(!std::ranges::binary_search(taken_, month));
  MonthTaken taken{.month = month};
  const auto remember = [&] {
    taken_.insert(std::ranges::lower_bound(taken_, month), month);
    return taken;
  };
  PosteriorData data = points_seen_from(month, month);
  if (data.points.size() < parameters_.size() + 2) {
    particles_.reset();  // a window that has lost its months knows nothing any more
    return remember();
  }
  auto posterior = TRY(posterior_of(std::move(data)));
  const auto anew = [&]() -> Result<MonthTaken> {
    TRY(begin_anew(posterior, taken, proceed));
    return remember();
  };
  if (!particles_) return anew();

  Particles carried = *particles_;
  // What was believed before and the new month: how they rise by it is the month's score.
  auto before = TRY(posterior_of(points_seen_from(taken_.back(), month)));
  const auto beside = TRY(log_likelihoods(before, carried));
  taken.log_score = reweight(carried, beside);
  if (forgets()) {
    const auto after = TRY(log_likelihoods(posterior, carried));
    reweight(carried, after);
  }
  taken.effective_share = effective_share(carried);
  const int months_since_anew = months_since_anew_ + 1;
  if (months_since_anew >= options_.anew_every_months || taken.effective_share < kHopelessShare) {
    return anew();
  }
  if (taken.effective_share < options_.effective_share) {
    Rng rng{seed_, streams::kMonths[2 * static_cast<std::uint64_t>(month)]};
    calibration::ParticleMover mover(posterior, rng, carried.count(), {});
    const auto shaped = mover.set_shape(covariance(carried));
    if (!shaped) return anew();  // the population has collapsed
    resample(carried, rng);
    TRY(mover.move(carried, 1.0, proceed));
    taken.moved = true;
    taken.acceptance_rate = mover.acceptance_rate();
    if (taken.acceptance_rate < options_.acceptance_min) return anew();
  }
  particles_ = std::move(carried);
  months_since_anew_ = months_since_anew;
  return remember();
}

std::vector<Eigen::VectorXd> SequentialCalibration::spread(int count) const {
  assert(has_begun());
  std::vector<Eigen::VectorXd> positions;
  for (const Eigen::Index i : spread_over(*particles_, count)) {
    positions.emplace_back(particles_->positions.col(i));
  }
  return positions;
}

Eigen::MatrixXd SequentialCalibration::draw_parameters(int count) const {
  assert(has_begun());
  const auto chosen = spread_over(*particles_, count);
  Eigen::MatrixXd draws(count, static_cast<Eigen::Index>(parameters_.size()));
  for (Eigen::Index k = 0; k < draws.rows(); ++k) {
    const auto column = particles_->positions.col(chosen[static_cast<std::size_t>(k)]);
    for (Eigen::Index j = 0; j < draws.cols(); ++j) {
      draws(k, j) = parameters_[static_cast<std::size_t>(j)].prior.at_score(column(j)).value;
    }
  }
  return draws;
}

}  // namespace recald::drift
