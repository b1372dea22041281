#include "core/drift/prequential.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "tests/core/calibration/small_case.hpp"

namespace recald::drift {
namespace {

using calibration::Posterior;
using calibration::PosteriorData;
using calibration::RampModel;

constexpr int kLong = 36;

/// The ramp at 0.5 with noise of 0.01, over three years, in units of 10 to 60; from month 24 on
/// `step` more of theta.
struct Case {
  PosteriorData data;
  calibration::HyperPrior prior{"test", {10.0, 0.1}, {2.0, 0.0032}, {1.0, 0.3}};
  std::vector<Parameter> parameters{{"level", "-", {0.0, 0.5, 1.0}}};

  explicit Case(double step) {
    Rng rng{4};
    const RampModel model{12};
    data.month_inputs.resize(kLong, 1);
    data.values.resize(kLong);
    for (int i = 0; i < kLong; ++i) {
      data.month_inputs(i, 0) = (i % 12) / 11.0;
      data.points.push_back({0, i});
      data.values(i) = (i < 24 ? 0.5 : 0.5 + step) * slope(i) + 0.01 * rng.normal();
    }
    data.extra_variances.setZero(kLong);
    data.common_errors.resize(kLong, 0);
    data.scales = {{10.0, 60.0}};
    data.weights = {1.0};
  }
  static double slope(int month) { return 0.5 + 0.5 * (month % 12) / 11.0; }
};

/// RampModel of a year, year after year, in units.
class YearlyRamp final : public MonthlyModel {
 public:
  /// @param outputs  All but the first are of no account.
  explicit YearlyRamp(int outputs = 1) : outputs_(outputs) {}
  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override {
    return std::make_unique<YearlyRamp>(*this);
  }
  [[nodiscard]] int parameter_count() const override { return 1; }
  [[nodiscard]] int output_count() const override { return outputs_; }
  [[nodiscard]] int month_count() const override { return kLong; }
  void evaluate(std::span<const double> theta, std::span<double> outputs) override {
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      outputs[i] = 10.0 + 50.0 * theta[0] * Case::slope(static_cast<int>(i) % kLong);
    }
  }

 private:
  int outputs_;
};

/// @param levels  Of outputs after the first.
Prequential before_any_month(const Case& built, std::vector<LevelOutput> levels) {
  const YearlyRamp model{1 + static_cast<int>(levels.size())};
  SequentialCalibration calibration{model,      built.parameters,
                                    built.data, built.prior,
                                    {},         {.particles = 512, .forecast_particles = 256},
                                    17};
  return {std::move(calibration), built.data, std::move(levels), {}};
}

Prequential after_a_year(const Case& built, std::vector<LevelOutput> levels) {
  Prequential prequential = before_any_month(built, std::move(levels));
  std::vector<int> first(12);
  std::iota(first.begin(), first.end(), 0);
  EXPECT_TRUE(prequential.learn(first).has_value());
  return prequential;
}

std::vector<PrequentialMonth> record_of(const Case& built, int months = kLong) {
  Prequential prequential = before_any_month(built, {});
  std::vector<PrequentialMonth> record;
  for (int month = 0; month < months; ++month) {
    auto one = prequential.step(month);
    EXPECT_TRUE(one.has_value());
    record.push_back(std::move(*one));
  }
  return record;
}

TEST(Prequential, ForecastsAreInUnitsAndBeforehand) {
  const Case built{0.0};
  const auto record = record_of(built);
  EXPECT_FALSE(record[0].outputs[0].has_value());
  ASSERT_TRUE(record[30].outputs[0].has_value());
  const ForecastRecord& forecast = *record[30].outputs[0];
  EXPECT_NEAR(forecast.mean, 10.0 + 50.0 * 0.5 * Case::slope(30), 1.5);
  EXPECT_NEAR(forecast.measured, 10.0 + 50.0 * built.data.values(30), 1e-9);
  EXPECT_LT(forecast.q05, forecast.q50);
  EXPECT_LT(forecast.q50, forecast.q95);
  // What was said of a month does not change with what came after it.
  const auto shorter = record_of(built, 31);
  EXPECT_EQ(shorter[30].outputs[0]->mean, forecast.mean);
  EXPECT_EQ(shorter[30].outputs[0]->surprise.log_score, forecast.surprise.log_score);
}

TEST(Prequential, NothingHappensNoAlarm) {
  for (const PrequentialMonth& month : record_of(Case{0.0})) EXPECT_TRUE(month.alarms.empty());
}

TEST(Prequential, AStepOfTheBuildingIsNoticedAndDated) {
  std::vector<Alarm> alarms;
  for (const PrequentialMonth& month : record_of(Case{0.25})) {
    alarms.insert(alarms.end(), month.alarms.begin(), month.alarms.end());
  }
  ASSERT_FALSE(alarms.empty());
  EXPECT_LT(alarms[0].month, 30);
  EXPECT_EQ(alarms[0].direction, 1);
  EXPECT_LE(alarms[0].since_earliest, 24);
  EXPECT_NEAR(alarms[0].since, 24, 1);
}

TEST(Prequential, AMissingMonthHasNoForecastAndStopsNothing) {
  Case built{0.0};
  built.data.points.erase(built.data.points.begin() + 20);
  Eigen::VectorXd values(kLong - 1);
  values << built.data.values.head(20), built.data.values.tail(15);
  built.data.values = values;
  built.data.extra_variances.setZero(kLong - 1);
  built.data.common_errors.resize(kLong - 1, 0);
  const auto record = record_of(built);
  EXPECT_FALSE(record[20].outputs[0].has_value());
  EXPECT_TRUE(record[21].outputs[0].has_value());
}

// What a model was made from is no test of it.
TEST(Prequential, WhatIsLearntIsNotForecast) {
  const Case built{0.0};
  const auto make = [&] {
    return Prequential{{YearlyRamp{},
                        built.parameters,
                        built.data,
                        built.prior,
                        {},
                        {.particles = 512, .forecast_particles = 256},
                        17},
                       built.data,
                       {},
                       {}};
  };
  Prequential prequential = make();
  std::vector<int> months(12);
  std::iota(months.begin(), months.end(), 0);
  const auto learnt = prequential.learn(months);
  ASSERT_TRUE(learnt.has_value());
  EXPECT_TRUE(learnt->anew);
  // The same posterior as months taken in one by one, to what the particles know.
  Prequential stepped = make();
  for (int month = 0; month < 12; ++month) ASSERT_TRUE(stepped.step(month).has_value());
  EXPECT_NEAR(prequential.calibration().draw_parameters(256).mean(),
              stepped.calibration().draw_parameters(256).mean(), 0.02);
  const auto next = prequential.step(12);
  ASSERT_TRUE(next.has_value());
  EXPECT_TRUE(next->outputs[0].has_value());
}

// An output that no parameter moves is watched all the same.
TEST(Prequential, AnOutputWithoutParametersHasItsOwnForecasts) {
  Case built{0.0};
  built.data.scales.push_back({0.0, 1.0});
  built.data.weights.push_back(1.0);
  LevelOutput level{.output = 1, .modelled = {}, .measured = {}};
  Rng rng{8};
  for (int month = 0; month < kLong; ++month) {
    level.modelled.push_back(100.0 + month % 12);
    const double factor = (month < 24 ? 1.0 : 1.15) + 0.01 * rng.normal();
    level.measured.push_back(month == 15 ? std::nan("") : factor * level.modelled.back());
  }
  Prequential prequential = after_a_year(built, {level});
  std::vector<Alarm> alarms;
  for (int month = 12; month < kLong; ++month) {
    const auto one = prequential.step(month);
    ASSERT_TRUE(one.has_value());
    EXPECT_EQ(one->outputs[1].has_value(), month != 15);
    alarms.insert(alarms.end(), one->alarms.begin(), one->alarms.end());
  }
  ASSERT_FALSE(alarms.empty());
  EXPECT_EQ(alarms[0].output, 1);
  EXPECT_EQ(alarms[0].direction, 1);
  EXPECT_LE(alarms[0].month, 28);
  EXPECT_NEAR(alarms[0].since, 24, 1);
}

// Once it is known that the building has changed, months after the change are no surprise any more.
TEST(Prequential, AfterAChangeItBeginsAnew) {
  Case built{0.3};
  built.data.scales.push_back({0.0, 1.0});
  built.data.weights.push_back(1.0);
  LevelOutput level{.output = 1, .modelled = {}, .measured = {}};
  for (int month = 0; month < kLong; ++month) {
    level.modelled.push_back(100.0);
    level.measured.push_back(month < 24 ? 100.0 : 140.0);
  }
  Prequential prequential = after_a_year(built, {level});
  for (int month = 12; month < 28; ++month) ASSERT_TRUE(prequential.step(month).has_value());
  ASSERT_TRUE(prequential.begin_at(24).has_value());
  for (int month = 28; month < kLong; ++month) {
    const auto one = prequential.step(month);
    ASSERT_TRUE(one.has_value());
    EXPECT_TRUE(one->alarms.empty()) << month;
    for (const auto& output : one->outputs) {
      EXPECT_LT(std::abs(output->surprise.standardised), 2.5) << month;
    }
  }
}

// A meter that is doubted is not heard any more, and says nothing of the parameters.
TEST(Prequential, AMeterSetAsideIsNotForecast) {
  const Case built{0.3};
  Prequential prequential = after_a_year(built, {});
  for (int month = 12; month < 30; ++month) ASSERT_TRUE(prequential.step(month).has_value());
  const double misled = prequential.calibration().draw_parameters(256).mean();
  EXPECT_GT(std::abs(misled - 0.5), 0.03);
  ASSERT_TRUE(prequential.set_aside(0, 24).has_value());
  EXPECT_NEAR(prequential.calibration().draw_parameters(256).mean(), 0.5, 0.03);
  const auto next = prequential.step(30);
  ASSERT_TRUE(next.has_value());
  EXPECT_FALSE(next->outputs[0].has_value());
}

}  // namespace
}  // namespace recald::drift
