#include "core/screening/screen.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "tests/core/regression/design_folder.hpp"
#include "tests/core/regression/made_design.hpp"
#include "tests/support/data_folders.hpp"

namespace recald::screening {
namespace {

using regression::DesignData;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

/// One output of 12 months and 8 parameters: 0 acts always, 1 adds in summer what it saves in
/// winter, 2 acts through its square alone, the others not at all.
DesignData seasonal_design(std::uint64_t seed) {
  Rng rng(seed);
  DesignData design;
  design.outputs = {"steam_daily_kwh"};
  design.theta.resize(100, 8);
  for (double& x : design.theta.reshaped()) x = rng.uniform();
  for (int j = 0; j < 8; ++j) design.parameters.push_back("p" + std::to_string(j));
  design.values.resize(100, 12);
  for (int i = 0; i < 12; ++i) {
    design.months.push_back(std::to_string(i + 1));
    const double season = std::cos(2.0 * 3.14159265358979 * i / 12.0);
    for (int r = 0; r < 100; ++r) {
      const auto t = design.theta.row(r);
      design.values(r, i) = 1000.0 + 500.0 * season + 100.0 * t(0) + 100.0 * season * t(1) +
                            200.0 * (t(2) - 0.5) * (t(2) - 0.5) + 5.0 * rng.normal();
    }
  }
  return design;
}

TEST(Screen, FindsSeasonalAndCurvedEffects) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    Rng rng(seed);
    const auto screening = screen(seasonal_design(seed), {}, rng);
    ASSERT_TRUE(screening.has_value()) << screening.error().message;
    EXPECT_THAT(screening->influential(), UnorderedElementsAre("p0", "p1", "p2"));
    for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(screening->parameters[j].frequency, 1.0);
  }
}

// A uniform parameter has sd 1/sqrt(12): 100 * sd = 28.9 for p0 in all months; p1 swings between
// the same with both signs and cancels over the year. Shares: p0 and p1 differ by the mean square
// of the season, one half.
TEST(Screen, MeasuresEffectsInUnits) {
  Rng rng(1);
  const auto screening = screen(seasonal_design(1), {}, rng);
  ASSERT_TRUE(screening.has_value());
  const ParameterEffect& steady = screening->parameters[0].effects[0];
  const ParameterEffect& seasonal = screening->parameters[1].effects[0];
  EXPECT_NEAR(steady.change_mean, 28.9, 2.0);
  EXPECT_NEAR(seasonal.change_mean, 0.0, 1.0);
  EXPECT_NEAR(seasonal.change_least, -28.9, 3.0);
  EXPECT_NEAR(seasonal.change_most, 28.9, 3.0);
  EXPECT_NEAR(steady.share / seasonal.share, 2.0, 0.3);
  EXPECT_TRUE(steady.selected);
  EXPECT_EQ(screening->parameters[7].verdict == Verdict::influential, false);
}

// Straight part and square of a skewed parameter are freed of each other, so that their shares add
// up: one parameter that explains everything has share one.
TEST(Screen, SharesAddUpForASkewedParameter) {
  DesignData design = seasonal_design(2);
  design.theta.col(3) = design.theta.col(3).array().cube();
  for (int i = 0; i < 12; ++i) {
    design.values.col(i) = 50.0 * i + design.theta.col(3).array().square();
  }
  Rng rng(2);
  const auto screening = screen(design, {}, rng);
  ASSERT_TRUE(screening.has_value()) << screening.error().message;
  EXPECT_NEAR(screening->parameters[3].share, 1.0, 1e-6);
}

TEST(Screen, SameSeedSameResult) {
  Rng first(5);
  Rng second(5);
  const auto a = screen(seasonal_design(1), {}, first);
  const auto b = screen(seasonal_design(1), {}, second);
  for (std::size_t j = 0; j < a->parameters.size(); ++j) {
    EXPECT_EQ(a->parameters[j].effects[0].frequency, b->parameters[j].effects[0].frequency);
    EXPECT_EQ(a->parameters[j].share, b->parameters[j].share);
  }
}

TEST(Screen, SelectsNothingForAnOutputThatOnlyTheWeatherMoves) {
  DesignData design = seasonal_design(1);
  design.outputs.push_back("water_daily_m3");
  design.values.conservativeResize(Eigen::NoChange, 24);
  for (int i = 0; i < 12; ++i) design.values.col(12 + i).setConstant(0.1 * i);
  Rng rng(1);
  const auto screening = screen(design, {}, rng);
  ASSERT_TRUE(screening.has_value()) << screening.error().message;
  EXPECT_EQ(screening->outputs[1].selected, 0);
  EXPECT_EQ(screening->parameters[0].effects[1].share, 0.0);
  EXPECT_THAT(screening->influential(), UnorderedElementsAre("p0", "p1", "p2"));
}

TEST(Screen, ChecksTheDesignFirst) {
  DesignData design = seasonal_design(1);
  design.theta.col(3) = design.theta.col(0);
  Rng rng(1);
  const auto screening = screen(design, {}, rng);
  ASSERT_FALSE(screening.has_value());
  EXPECT_THAT(screening.error().message, HasSubstr("parameter 'p3' is determined"));
}

// 25 candidates of which six have wide priors; the other nineteen are known to a few per cent.
TEST(Screen, FindsTheWideParametersOfTheSeedcase) {
  const auto folder = recald::testing::own_data("seedcase");
  const DesignData design = regression::read_design(folder, "screen_");
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Rng rng(seed);
    const auto screening = screen(design, {}, rng);
    ASSERT_TRUE(screening.has_value()) << screening.error().message;
    EXPECT_THAT(screening->influential(), UnorderedElementsAre("t_cool", "occ_office", "occ_class",
                                                               "oa_office", "oa_class", "oa_lab"));
  }
}

}  // namespace
}  // namespace recald::screening
