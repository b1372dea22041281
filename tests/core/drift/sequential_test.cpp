#include "core/drift/sequential.hpp"

#include <gmock/gmock.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "core/calibration/samplers/log_sum.hpp"
#include "core/calibration/samplers/smc.hpp"
#include "core/drift/watch/calibration_check.hpp"
#include "tests/core/calibration/small_case.hpp"

namespace recald::drift {
namespace {

using calibration::Particles;
using calibration::Posterior;
using calibration::PosteriorData;
using calibration::RampModel;

constexpr int kMonths = 24;

SequentialCalibration sequence_of(const Posterior& posterior, PosteriorData data,
                                  Window window = {}, SequentialOptions options = {}) {
  return {RampModel{kMonths}, posterior.parameters(), std::move(data),
          posterior.prior(),  std::move(window),      options,
          std::uint64_t{17}};
}

struct Moments {
  Eigen::VectorXd mean;
  Eigen::VectorXd sd;
};

Moments moments_of(const Particles& particles) {
  const Eigen::VectorXd weights =
      (particles.log_weight.array() - calibration::log_sum(particles.log_weight)).exp();
  Moments found;
  found.mean = particles.positions * weights;
  found.sd = ((particles.positions.colwise() - found.mean).array().square().matrix() * weights)
                 .cwiseSqrt();
  return found;
}

// Month after month leads where all months at once lead, which quadrature knows.
TEST(SequentialCalibration, ArrivesAtThePosteriorOfAllMonths) {
  const Posterior posterior = calibration::small_posterior(0.03);
  const calibration::Quadrature exact = integrate(posterior, {31, 31, 41, 41});
  SequentialCalibration sequence =
      sequence_of(posterior, posterior.data(), {}, {.anew_every_months = 1000});
  int moves = 0;
  double log_score = 0.0;
  for (int month = 0; month < kMonths; ++month) {
    const auto taken = sequence.take(month);
    ASSERT_TRUE(taken.has_value()) << taken.error().message;
    moves += taken->moved ? 1 : 0;
    log_score += taken->log_score;
  }
  EXPECT_GT(moves, 1);
  const Moments found = moments_of(sequence.particles());
  for (Eigen::Index c = 0; c < 4; ++c) {
    EXPECT_NEAR(found.mean(c), exact.mean(c), 0.15 * exact.sd(c)) << c;
    EXPECT_NEAR(found.sd(c), exact.sd(c), 0.12 * exact.sd(c)) << c;
  }
  // Scores of the months are the evidence, less that of the first three, which began together.
  PosteriorData beginning = posterior.data();
  beginning.points.resize(3);
  beginning.values.conservativeResize(3);
  beginning.extra_variances.conservativeResize(3);
  beginning.common_errors.resize(3, 0);
  const Posterior start =
      Posterior::make(RampModel{kMonths}, posterior.parameters(), beginning, posterior.prior())
          .value();
  const double begun = integrate(start, {31, 31, 41, 41}).log_evidence;
  EXPECT_NEAR(log_score, exact.log_evidence - begun, 0.6);
}

/// Whether the 90 % interval of the only parameter has the truth.
bool covers(const SequentialCalibration& sequence, double truth) {
  Eigen::VectorXd draws = sequence.draw_parameters(200).col(0);
  std::sort(draws.begin(), draws.end());
  return draws(9) <= truth && truth <= draws(190);
}

// Draws the truth from the prior and the months from the truth: then the forecasts have to be true,
// and intervals of the parameter have it as often as they say, early and late.
TEST(SequentialCalibration, ForecastsAreCalibratedWhereTheModelIsTrue) {
  const Posterior shape = calibration::small_posterior(0.0);
  std::vector<double> surprises;
  constexpr int kWorlds = 40;
  std::map<int, int> covered;  // by month
  for (std::uint64_t world = 0; world < kWorlds; ++world) {
    Rng rng{400, world};
    PosteriorData data = shape.data();
    Posterior truth = shape;
    const Eigen::VectorXd point = truth.draw_start(rng);
    Eigen::VectorXd theta(1);
    calibration::Hyperparameters hyper{0.0, 0.0, Eigen::VectorXd(1)};
    truth.to_natural(point, theta, hyper);
    ASSERT_TRUE(truth.set_hyperparameters(hyper));
    Eigen::MatrixXd precision(kMonths, kMonths);
    truth.precision(precision);
    const Eigen::MatrixXd factor = precision.inverse().llt().matrixL();
    Eigen::VectorXd noise(kMonths);
    for (double& one : noise) one = rng.normal();
    data.values = factor * noise;
    const RampModel model{kMonths};
    for (int i = 0; i < kMonths; ++i) {
      data.values(i) += theta(0) * model.slope(static_cast<std::size_t>(i));
    }
    SequentialCalibration sequence =
        sequence_of(shape, data, {}, {.particles = 256, .forecast_particles = 128});
    for (int month = 0; month < kMonths; ++month) {
      if (sequence.has_begun()) {
        const auto forecast = sequence.forecast(month);
        ASSERT_TRUE(forecast.has_value()) << forecast.error().message;
        surprises.push_back(surprise_of(forecast->front(), data.values(month)).standardised);
      }
      ASSERT_TRUE(sequence.take(month).has_value());
      if (month == 5 || month == 11 || month + 1 == kMonths) {
        covered[month] += covers(sequence, theta(0)) ? 1 : 0;
      }
    }
  }
  for (const auto& [month, count] : covered) {
    // Three standard errors of 90 % of forty.
    EXPECT_GE(count, 30) << "after month " << month;
    RecordProperty("covered_after_" + std::to_string(month), count);
  }
  const auto check = check_calibration(surprises);
  ASSERT_TRUE(check.has_value());
  EXPECT_GT(check->pvalue, 0.001) << check->mean << " " << check->sd << " " << check->lag_one;
}

// A forecast must not know its month: another value there gives the same forecast.
TEST(SequentialCalibration, AForecastHasNotSeenItsMonth) {
  const Posterior posterior = calibration::small_posterior(0.03);
  PosteriorData other = posterior.data();
  other.values(20) = 77.0;
  std::vector<double> means;
  for (const PosteriorData& data : {posterior.data(), other}) {
    SequentialCalibration sequence = sequence_of(posterior, data, {}, {.particles = 256});
    for (int month = 0; month < 20; ++month) ASSERT_TRUE(sequence.take(month).has_value());
    means.push_back(sequence.forecast(20)->front().mean());
  }
  EXPECT_EQ(means[0], means[1]);
}

TEST(SequentialCalibration, ASlidingWindowForgetsWhatItHasLeft) {
  const Posterior posterior = calibration::small_posterior(0.0);
  PosteriorData jumped = posterior.data();
  const RampModel model{kMonths};
  for (int i = 12; i < kMonths; ++i) {  // theta steps from 0.5 to 0.8
    jumped.values(i) += 0.3 * model.slope(static_cast<std::size_t>(i));
  }
  const auto level_after = [&](const Window& window) {
    SequentialCalibration sequence = sequence_of(posterior, jumped, window, {.particles = 1024});
    for (int month = 0; month < kMonths; ++month) EXPECT_TRUE(sequence.take(month).has_value());
    return sequence.draw_parameters(512).col(0).mean();
  };
  EXPECT_NEAR(level_after({"12 months", 12, 0.0}), 0.8, 0.06);
  EXPECT_LT(level_after({}), 0.76);
  const double forgetting = level_after({"forgetting", 0, 3.0});
  EXPECT_GT(forgetting, level_after({}));
}

TEST(SequentialCalibration, HalfLivesOfForeverForgetNothing) {
  const Posterior posterior = calibration::small_posterior(0.03);
  const auto last = [&](const Window& window) {
    SequentialCalibration sequence =
        sequence_of(posterior, posterior.data(), window, {.particles = 256});
    for (int month = 0; month < 10; ++month) EXPECT_TRUE(sequence.take(month).has_value());
    return sequence.particles().positions;
  };
  EXPECT_LT((last({"forgetting", 0, 1e15}) - last({})).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_EQ(last({"24 months", 24, 0.0}), last({}));
}

TEST(SequentialCalibration, MissingMonthsChangeNothing) {
  const Posterior posterior = calibration::small_posterior(0.03);
  PosteriorData gaps = posterior.data();
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < kMonths; ++i) {
    if (i < 10 || i > 12) kept.push_back(i);
  }
  gaps.points.erase(gaps.points.begin() + 10, gaps.points.begin() + 13);
  gaps.values = Eigen::VectorXd(posterior.data().values(kept));
  gaps.extra_variances = Eigen::VectorXd(posterior.data().extra_variances(kept));
  gaps.common_errors.resize(gaps.values.size(), 0);
  SequentialCalibration sequence = sequence_of(posterior, gaps, {}, {.particles = 512});
  for (int month = 0; month < kMonths; ++month) {
    const auto taken = sequence.take(month);
    ASSERT_TRUE(taken.has_value());
    if (month >= 10 && month <= 12) {
      EXPECT_NEAR(taken->log_score, 0.0, 1e-9) << month;
    }
  }
  EXPECT_NEAR(sequence.draw_parameters(256).col(0).mean(), 0.5, 0.05);
}

TEST(SequentialCalibration, AWindowThatHasLostItsMonthsBeginsAgain) {
  const Posterior posterior = calibration::small_posterior(0.03);
  PosteriorData gaps = posterior.data();
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < kMonths; ++i) {
    if (i < 6 || i > 12) kept.push_back(i);
  }
  gaps.points.erase(gaps.points.begin() + 6, gaps.points.begin() + 13);
  gaps.values = Eigen::VectorXd(posterior.data().values(kept));
  gaps.extra_variances = Eigen::VectorXd(posterior.data().extra_variances(kept));
  gaps.common_errors.resize(gaps.values.size(), 0);
  SequentialCalibration sequence =
      sequence_of(posterior, gaps, {"6 months", 6, 0.0}, {.particles = 256});
  for (int month = 0; month < kMonths; ++month) {
    if (sequence.has_begun()) {
      ASSERT_TRUE(sequence.forecast(month).has_value()) << month;
    }
    ASSERT_TRUE(sequence.take(month).has_value()) << month;
    if (month == 12) {
      EXPECT_FALSE(sequence.has_begun());
    }
  }
  EXPECT_TRUE(sequence.has_begun());
}

TEST(SequentialCalibration, SameSeedSameBytes) {
  const Posterior posterior = calibration::small_posterior(0.03);
  const auto run = [&] {
    SequentialCalibration sequence =
        sequence_of(posterior, posterior.data(), {}, {.particles = 128});
    for (int month = 0; month < kMonths; ++month) EXPECT_TRUE(sequence.take(month).has_value());
    return sequence.particles().positions;
  };
  EXPECT_EQ(run(), run());
}

TEST(SequentialCalibration, StopsWhenToldToAndIsAsItWas) {
  const Posterior posterior = calibration::small_posterior(0.03);
  SequentialCalibration sequence =
      sequence_of(posterior, posterior.data(), {}, {.particles = 128, .effective_share = 1.0});
  for (int month = 0; month < 8; ++month) ASSERT_TRUE(sequence.take(month).has_value());
  const Eigen::MatrixXd before = sequence.particles().positions;
  const auto stopped = sequence.take(8, [] { return false; });
  ASSERT_FALSE(stopped.has_value());
  EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
  EXPECT_EQ(sequence.particles().positions, before);
  EXPECT_TRUE(sequence.take(8).has_value());
}

}  // namespace
}  // namespace recald::drift
