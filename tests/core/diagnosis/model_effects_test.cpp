#include "core/diagnosis/model_effects.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/sample_building.hpp"

namespace recald::diagnosis {
namespace {

/// The sample building's 2021 with its electricity and steam.
std::shared_ptr<const SiteProblem> sample_problem_site() {
  auto site = std::make_shared<SiteProblem>();
  site->nominal = recald::testing::sample_building();
  site->drivers =
      std::make_shared<const model::Drivers>(recald::testing::sample_drivers(site->nominal, 12));
  for (const auto& [id, utility] : {std::pair{"electricity", metering::Utility::electricity},
                                    std::pair{"steam", metering::Utility::steam}}) {
    site->meters.push_back({id, utility, *model::default_meter_map(utility)});
  }
  site->day_parts = make_day_parts(*site->drivers);
  site->measured_parts_kW = Eigen::ArrayXXd::Constant(site->day_parts.count(), 2, 50.0);
  return site;
}

EffectParameterRecord record(const std::string& name, const Prior& prior,
                             std::vector<double> draws) {
  EffectParameterRecord record{.name = name, .unit = "-", .prior = prior};
  record.draws = std::move(draws);
  record.mean = record.q50 = record.draws[record.draws.size() / 2];
  return record;
}

/// A scale fault of the steam meter since the 200th day of a record that began with July 2020.
AddedEffect scale_since_day_200() {
  AddedEffect added{.effect = "scale_fault",
                    .title = "Meter's scale is wrong",
                    .meter = "steam",
                    .from = {},
                    .to = {},
                    .physics = "",
                    .parameters = {},
                    .log_evidence_gain = 9.0,
                    .probability = 0.9};
  const auto site = sample_problem_site();
  const auto own = find_effect("scale_fault")->parameters(site->facts());
  added.parameters = {record(own[0].name, own[0].prior, {1.19, 1.2, 1.21}),
                      record("first_day", UniformPrior{21.0, 344.0}, {198.0, 200.0, 202.0})};
  added.from = metering::Day{std::chrono::sys_days{std::chrono::year{2020} / 7 / 1} +
                             std::chrono::days{201}};  // of the mode
  return added;
}

// Six months of 2020 lie before the record at hand: 184 days.
TEST(ModelEffects, BringsDaysFromTheRecordThatTheyWereCountedIn) {
  const auto effects = make_model_effects({scale_since_day_200()}, sample_problem_site());
  ASSERT_TRUE(effects.has_value()) << effects.error().message;
  ASSERT_EQ(effects->draws.cols(), 2);
  EXPECT_EQ(effects->draws(1, 0), 1.2);
  EXPECT_EQ(effects->draws(1, 1), 16.0);
  EXPECT_EQ(effects->parameters[0].name,
            "scale_fault_steam_" + scale_since_day_200().parameters[0].name);
  EXPECT_NEAR(effects->parameters[1].prior.mean(), 16.0, 0.1);
  EXPECT_EQ(effects->labels[1]->definition.label, "Meter's scale is wrong: first day");
  EXPECT_NEAR(effects->mean()[1], 16.0, 1e-9);
}

TEST(ModelEffects, MonthlyAndHourlyHaveTheSame) {
  const auto effects = make_model_effects({scale_since_day_200()}, sample_problem_site());
  ASSERT_TRUE(effects.has_value());
  const std::vector<double> eta{1.2, 16.0};
  std::vector<double> meters(24, 100.0);
  effects->monthly({}).front().apply({}, eta, meters);
  EXPECT_EQ(meters[0], 100.0);  // electricity
  EXPECT_NEAR(meters[12], 100.0 * (1.0 + 0.2 * 15.0 / 31.0), 1.0);
  EXPECT_NEAR(meters[13], 120.0, 1e-9);
  Predictor predictor{*effects->site, effects->alterations(eta)};
  Predictor plain{*effects->site};
  const Eigen::Index may = 24 * 130;
  EXPECT_NEAR((predictor.parts_kW({}), predictor.hours_kW()(may, 1)),
              1.2 * (plain.parts_kW({}), plain.hours_kW()(may, 1)), 1e-9);
}

TEST(ModelEffects, WhatDoesNotFitTheCatalogueOrTheSiteIsASentence) {
  const auto refused = [](AddedEffect added) {
    const auto effects = make_model_effects({std::move(added)}, sample_problem_site());
    return effects ? std::string{} : effects.error().message;
  };
  AddedEffect other_meter = scale_since_day_200();
  other_meter.meter = "gas";
  EXPECT_THAT(refused(other_meter), ::testing::HasSubstr("of meter 'gas', which is not modelled"));
  AddedEffect renamed = scale_since_day_200();
  renamed.parameters[0].name = "colour";
  EXPECT_THAT(refused(renamed), ::testing::HasSubstr("other parameters than the catalogue"));
  AddedEffect without_draws = scale_since_day_200();
  without_draws.parameters[0].draws.clear();
  EXPECT_THAT(refused(without_draws), ::testing::HasSubstr("has no posterior draws of"));
}

}  // namespace
}  // namespace recald::diagnosis
