#include "simulators/building/truth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace recald::simulators::truth_test {
namespace {

TEST(Truth, StaysInsideTheUsersPriors) {
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE(seed);
    const Truth truth = draw_truth({}, seed);
    ASSERT_GT(truth.occupancy_density_person_m2, 0.0);
    ASSERT_LT(truth.occupancy_density_person_m2, 0.10);
    ASSERT_GT(truth.outdoor_airflow_m3_s, 0.3 * Drawings{}.outdoor_air_m3_s());
    ASSERT_LT(truth.outdoor_airflow_m3_s, 1.2 * Drawings{}.outdoor_air_m3_s());
    ASSERT_GE(truth.cooling_setpoint_C, 21.2);
    ASSERT_LE(truth.cooling_setpoint_C, 27.0);
    ASSERT_LE(truth.heating_setpoint_C + truth.thermostat_band_K, truth.cooling_setpoint_C);
  }
}

TEST(Truth, AggregatesAreExactlyWhatTheirPartsMake) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const Truth truth = draw_truth({}, seed);
    EXPECT_NEAR(std::accumulate(truth.outdoor_m3_s.begin(), truth.outdoor_m3_s.end(), 0.0),
                truth.outdoor_airflow_m3_s, 1e-12);
    double offset_K = 0.0;
    for (std::size_t zone = 0; zone < Drawings{}.zones(); ++zone) {
      offset_K += truth.thermostat_offset_K[zone] * Drawings{}.zone_m2(zone % kZonesPerStorey);
    }
    EXPECT_NEAR(offset_K, 0.0, 1e-9);
  }
}

// Triangular(0, 0.05, 0.1) has mean 0.05 and standard deviation 0.0204; 500 seeds, 4 errors wide.
TEST(Truth, OccupancyIsSpreadAsItsPrior) {
  double sum = 0.0;
  double squares = 0.0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    const double density = draw_truth({}, seed).occupancy_density_person_m2;
    sum += density;
    squares += density * density;
  }
  const double mean = sum / 500.0;
  EXPECT_NEAR(mean, 0.05, 4.0 * 0.0204 / std::sqrt(500.0));
  EXPECT_NEAR(std::sqrt(squares / 500.0 - mean * mean), 0.0204, 0.003);
}

// Ten storeys: the lowest, one for the eight between, the highest.
TEST(Drawings, OneStoreyStandsForAllThatAreAlike) {
  Drawings tower;
  tower.storeys = 10;
  EXPECT_EQ(tower.storeys_simulated(), 3u);
  EXPECT_EQ(tower.storey_weight(0) + tower.storey_weight(1) + tower.storey_weight(2), 10.0);
  EXPECT_EQ(tower.storey_weight(1), 8.0);
  Truth truth = draw_truth(tower, 3);
  double outdoor_m3_s = 0.0;
  for (std::size_t i = 0; i < truth.outdoor_m3_s.size(); ++i) {
    outdoor_m3_s += tower.storey_weight(i / 2) * truth.outdoor_m3_s[i];
  }
  EXPECT_NEAR(outdoor_m3_s, truth.outdoor_airflow_m3_s, 1e-9);
  tower.storeys = 2;
  EXPECT_EQ(tower.zones(), 12u);
  EXPECT_EQ(tower.storey_weight(1), 1.0);
}

TEST(Drawings, ZonesFillTheFloor) {
  const Drawings drawings;
  double sum_m2 = 0.0;
  for (std::size_t side = south; side <= special; ++side) sum_m2 += drawings.zone_m2(side);
  EXPECT_NEAR(sum_m2, drawings.storey_m2(), 1e-9);
  EXPECT_NEAR(drawings.floor_area_m2(), 7800.0, 1e-9);
}

}  // namespace
}  // namespace recald::simulators::truth_test
