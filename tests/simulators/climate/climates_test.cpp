#include "simulators/climate/climates.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "simulators/climate/climate_statistics.hpp"

namespace recald::simulators::climates_test {
namespace {

using namespace std::chrono_literals;

double total(const Monthly& monthly) {
  return std::accumulate(monthly.begin(), monthly.end(), 0.0);
}

TEST(Climates, HaveTheNamesOfScenarios) {
  EXPECT_EQ(name_of(ClimateKind::hot_humid), "hot-humid");
  EXPECT_EQ(name_of(ClimateKind::marine), "marine");
}

// Twelve years against the normals. A January mean of one year strays by 2 K (hot-humid) to 3 K
// (cold), a July mean by 0.7 K: the bounds are two and a half standard errors of twelve years, plus
// what two harmonics cannot follow (0.6 K). Radiation and wind hardly stray.
TEST(Climates, MonthlyMeansMeetPublishedNormals) {
  for (const ClimateKind kind : kClimateKinds) {
    SCOPED_TRACE(name_of(kind));
    const Normals simulated = simulated_normals(kind, 12, 1, 15min);
    const Normals& published = normals_of(kind);
    for (std::size_t m = 0; m < 12; ++m) {
      SCOPED_TRACE(m + 1);
      const double winter = winter_at((static_cast<double>(m) + 0.5) / 12.0);
      const double bound_K = 1.2 + (kind == ClimateKind::cold ? 1.6 : 0.8) * winter;
      EXPECT_NEAR(simulated.dry_bulb_C[m], published.dry_bulb_C[m], bound_K);
      EXPECT_NEAR(simulated.dew_point_C[m], published.dew_point_C[m], bound_K + 0.7);
      EXPECT_NEAR(simulated.daily_range_K[m], published.daily_range_K[m], 1.8);
      EXPECT_NEAR(simulated.wind_m_s[m], published.wind_m_s[m], 0.5);
      EXPECT_NEAR(simulated.global_kWh_m2_day[m], published.global_kWh_m2_day[m],
                  0.1 + 0.1 * published.global_kWh_m2_day[m]);
    }
    EXPECT_NEAR(annual_mean(simulated.dry_bulb_C), annual_mean(published.dry_bulb_C), 0.7);
    EXPECT_NEAR(annual_mean(simulated.dew_point_C), annual_mean(published.dew_point_C), 1.0);
    EXPECT_NEAR(annual_mean(simulated.daily_range_K), annual_mean(published.daily_range_K), 0.6);
    EXPECT_NEAR(annual_mean(simulated.wind_m_s), annual_mean(published.wind_m_s), 0.2);
    EXPECT_NEAR(annual_mean(simulated.global_kWh_m2_day), annual_mean(published.global_kWh_m2_day),
                0.25);
  }
}

TEST(Climates, DegreeDaysAndExtremesAreThoseOfTheCity) {
  for (const ClimateKind kind : kClimateKinds) {
    SCOPED_TRACE(name_of(kind));
    const Normals simulated = simulated_normals(kind, 12, 1, 15min);
    const Normals& published = normals_of(kind);
    EXPECT_NEAR(simulated.heating_K_days, published.heating_K_days,
                80.0 + 0.05 * published.heating_K_days);
    EXPECT_NEAR(simulated.cooling_K_days, published.cooling_K_days,
                80.0 + 0.05 * published.cooling_K_days);
    EXPECT_NEAR(simulated.heating_design_C, published.heating_design_C, 2.8);
    EXPECT_NEAR(simulated.cooling_design_C, published.cooling_design_C, 1.2);
    EXPECT_NEAR(simulated.annual_minimum_C, published.annual_minimum_C, 3.2);
    EXPECT_NEAR(simulated.annual_maximum_C, published.annual_maximum_C, 2.0);
  }
}

// One year's precipitation strays by 22 %, in the desert by 47 %: bounds are three standard errors
// of 25 years. Snowfall depends on a few degrees in a few hours.
TEST(Climates, PrecipitationMeetsPublishedNormals) {
  for (const ClimateKind kind : kClimateKinds) {
    SCOPED_TRACE(name_of(kind));
    const Normals simulated = simulated_normals(kind, 25, 1, 15min);
    const Normals& published = normals_of(kind);
    const double published_mm = total(published.precipitation_mm);
    const double share = kind == ClimateKind::hot_dry ? 0.3 : 0.14;
    EXPECT_NEAR(total(simulated.precipitation_mm), published_mm, share * published_mm);
    EXPECT_NEAR(simulated.wet_days, published.wet_days, 0.12 * published.wet_days);
    EXPECT_NEAR(simulated.snowfall_mm, published.snowfall_mm, 12.0 + 0.3 * published.snowfall_mm);
  }
}

// Another step draws other weather. Radiation, wind and range hardly differ between two runs of
// six years; the mean temperature does by 0.3 K (cold), precipitation by 11 % (desert: 24 %), one
// standard error.
TEST(Climates, StatisticsDoNotDependOnTheStep) {
  for (const ClimateKind kind : kClimateKinds) {
    SCOPED_TRACE(name_of(kind));
    const Normals fine = simulated_normals(kind, 6, 5, 5min);
    const Normals coarse = simulated_normals(kind, 6, 5, 15min);
    EXPECT_NEAR(annual_mean(fine.dry_bulb_C), annual_mean(coarse.dry_bulb_C), 0.8);
    EXPECT_NEAR(annual_mean(fine.dew_point_C), annual_mean(coarse.dew_point_C), 0.9);
    EXPECT_NEAR(annual_mean(fine.daily_range_K), annual_mean(coarse.daily_range_K), 0.35);
    EXPECT_NEAR(annual_mean(fine.wind_m_s), annual_mean(coarse.wind_m_s), 0.1);
    EXPECT_NEAR(annual_mean(fine.global_kWh_m2_day), annual_mean(coarse.global_kWh_m2_day), 0.08);
    EXPECT_NEAR(fine.wet_days, coarse.wet_days, 0.15 * coarse.wet_days);
    EXPECT_NEAR(total(fine.precipitation_mm), total(coarse.precipitation_mm),
                (kind == ClimateKind::hot_dry ? 0.75 : 0.35) * total(coarse.precipitation_mm));
  }
}

}  // namespace
}  // namespace recald::simulators::climates_test
