#include "core/calibration/cut_sampling.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/model/model_adaptors.hpp"

namespace recald::calibration {
namespace {

constexpr int kMonths = 24;

/// One output: a season times θ + η. The data know their sum and nothing else.
class SumModel final : public MonthlyModel {
 public:
  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override {
    return std::make_unique<SumModel>(*this);
  }
  [[nodiscard]] int parameter_count() const override { return 2; }
  [[nodiscard]] int output_count() const override { return 1; }
  [[nodiscard]] int month_count() const override { return kMonths; }
  void evaluate(std::span<const double> theta, std::span<double> outputs) override {
    for (int i = 0; i < kMonths; ++i) {
      outputs[static_cast<std::size_t>(i)] = (3.0 + std::cos(0.5236 * i)) * (theta[0] + theta[1]);
    }
  }
};

/// θ + η was 10 when this was measured.
CalibrationProblem problem() {
  CalibrationProblem problem;
  problem.parameters = {{"theta", "-", UniformPrior{0.0, 20.0}}};
  OutputMeasurements output{.name = "heat", .unit = "kWh/day"};
  problem.inputs.names = {"dry_bulb_C"};
  problem.inputs.values.resize(kMonths, 1);
  for (int i = 0; i < kMonths; ++i) {
    problem.month_names.push_back(std::to_string(i + 1));
    output.values.push_back((3.0 + std::cos(0.5236 * i)) * 10.0 + 0.5 * std::sin(2.9 * i));
    problem.inputs.values(i, 0) = std::cos(0.5236 * i);
  }
  problem.outputs = {output};
  return problem;
}

struct CutCase {
  SumModel model;
  CalibrationProblem problem = recald::calibration::problem();
  Calibration base;
  Eigen::MatrixXd eta{40, 1};

  CutCase() {
    for (int i = 0; i < 40; ++i) eta(i, 0) = 2.0 + 0.05 * (i - 19.5);
    const FixedParametersModel at_mean{std::make_unique<SumModel>(), {0.0, 2.0}, {0}};
    auto calibrated = calibrate(at_mean, problem, {}, {});
    if (!calibrated) throw std::runtime_error(calibrated.error().message);
    base = std::move(*calibrated);
  }
};

constexpr CutOptions kOptions{.burn_in = 3000, .settle_each = 200, .kept_each = 20, .stride = 20};

// θ is what the data leave of the sum, so the cut's spread is that of θ at one η and of η together.
TEST(CutSampling, GivesThetaForEveryEtaAndLeavesEtaAlone) {
  const CutCase c;
  const auto cut = sample_given_eta(c.model, {}, c.base, c.problem, c.eta, kOptions, {});
  ASSERT_TRUE(cut.has_value()) << cut.error().message;
  ASSERT_EQ(cut->chains.size(), 4u);
  double sum = 0.0;
  double squares = 0.0;
  double n = 0.0;
  for (const ChainDraws& chain : cut->chains) {
    ASSERT_EQ(chain.theta.rows(), 800);
    ASSERT_EQ(chain.theta.cols(), 2);
    for (Eigen::Index row = 0; row < chain.theta.rows(); ++row) {
      EXPECT_EQ(chain.theta(row, 1), c.eta(row % 40, 0));
      sum += chain.theta(row, 0);
      squares += chain.theta(row, 0) * chain.theta(row, 0);
      n += 1.0;
    }
  }
  const double eta_variance = 0.05 * 0.05 * (40.0 * 40.0 - 1.0) / 12.0;
  const double at_one_eta = c.base.parameters[0].sd;
  const double expected_sd = std::sqrt(at_one_eta * at_one_eta + eta_variance);
  EXPECT_NEAR(sum / n, 8.0, 0.1 * expected_sd + std::abs(c.base.parameters[0].mean - 8.0));
  EXPECT_NEAR(std::sqrt(squares / n - sum / n * sum / n), expected_sd, 0.07 * expected_sd);
}

TEST(CutSampling, DoesNotDependOnTheExecutor) {
  const CutCase c;
  const CutOptions quick{.burn_in = 200, .settle_each = 10, .kept_each = 4, .stride = 2};
  const auto forwards = sample_given_eta(c.model, {}, c.base, c.problem, c.eta, quick, {});
  RunContext backwards;
  backwards.executor = [](std::size_t count, const std::function<void(std::size_t)>& body) {
    for (std::size_t i = count; i-- > 0;) body(i);
  };
  const auto other = sample_given_eta(c.model, {}, c.base, c.problem, c.eta, quick, backwards);
  ASSERT_TRUE(forwards.has_value());
  ASSERT_TRUE(other.has_value());
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(forwards->chains[k].theta, other->chains[k].theta);
  }
}

// Within one value of η too, which takes as long as it has iterations.
TEST(CutSampling, AsksAsOftenAsASamplerDoes) {
  const CutCase c;
  RunContext context;
  int asked = 0;
  context.observer = [&](const Progress&) { return ++asked < 2; };
  const CutOptions one_long{
      .burn_in = 100'000, .settle_each = 200, .kept_each = 20, .stride = 20, .chains = 1};
  const auto stopped = sample_given_eta(c.model, {}, c.base, c.problem, c.eta, one_long, context);
  ASSERT_FALSE(stopped.has_value());
  EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
  EXPECT_EQ(asked, 2);
}

// A polynomial in the place of the model: what it lacks is known to be uncertain.
TEST(CutSampling, TheErrorOfAnEmulatorWidensTheta) {
  const CutCase c;
  const auto sd_with = [&](const Eigen::VectorXd& error_sd) {
    const auto cut = sample_given_eta(c.model, error_sd, c.base, c.problem, c.eta, kOptions, {});
    double sum = 0.0, squares = 0.0, n = 0.0;
    for (const ChainDraws& chain : cut->chains) {
      for (const double theta : chain.theta.col(0)) {
        sum += theta;
        squares += theta * theta;
        n += 1.0;
      }
    }
    return std::sqrt(squares / n - sum / n * sum / n);
  };
  EXPECT_GT(sd_with(Eigen::VectorXd::Constant(kMonths, 10.0)), 1.5 * sd_with({}));
}

TEST(CutSampling, StopsWhenAsked) {
  const CutCase c;
  RunContext context;
  context.observer = [](const Progress& progress) { return progress.done < 3; };
  const auto stopped = sample_given_eta(c.model, {}, c.base, c.problem, c.eta, kOptions, context);
  ASSERT_FALSE(stopped.has_value());
  EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace recald::calibration
