#include "core/model/parameter_library.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/sample_building.hpp"

namespace recald::model {
namespace {

using ::testing::HasSubstr;
using testing::sample_building;

TEST(ParameterLibrary, SeedsRangesForThisBuilding) {
  const Building building = sample_building();
  const auto people = make_parameter(**find_parameter("occupancy_density"), building);
  ASSERT_TRUE(people.has_value());
  EXPECT_EQ(people->prior, (Prior{0.0, 0.05, 0.1}));
  const auto air = make_parameter(**find_parameter("outdoor_airflow"), building);
  EXPECT_DOUBLE_EQ(air->prior.min(), 0.3 * 6.0);
  EXPECT_DOUBLE_EQ(air->prior.max(), 1.2 * 6.0);
  const auto set_point = make_parameter(**find_parameter("cooling_setpoint"), building);
  EXPECT_EQ(set_point->prior, (Prior{20.0, 24.0, 27.8}));
}

TEST(ParameterLibrary, MisspeltNameNamesTheNearest) {
  const auto found = find_parameter("cooling_setpiont");
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().code, ErrorCode::not_found);
  EXPECT_THAT(found.error().message, HasSubstr("did you mean 'cooling_setpoint'"));
}

TEST(ParameterLibrary, DynamicSimulationsParameterIsRefused) {
  const auto found = find_parameter("visible_reflectance_scale");
  ASSERT_FALSE(found.has_value());
  EXPECT_EQ(found.error().code, ErrorCode::unsupported);
}

// Shops and halls leak more than the seed's offices: the drawings know better than the library.
TEST(ParameterLibrary, DesignOutsideTheUsualRangeWidensIt) {
  Building building = sample_building();
  building.leakage_cm2_m2 = 9.0;
  const auto leaky = make_parameter(**find_parameter("leakage_area"), building);
  ASSERT_TRUE(leaky.has_value()) << leaky.error().message;
  EXPECT_EQ(leaky->prior.min(), 0.26);
  EXPECT_EQ(leaky->prior.mode(), 9.0);
  EXPECT_DOUBLE_EQ(leaky->prior.max(), 9.0 + 0.25 * (4.94 - 0.26));
  building.leakage_cm2_m2 = 0.1;
  const auto tight = make_parameter(**find_parameter("leakage_area"), building);
  ASSERT_TRUE(tight.has_value()) << tight.error().message;
  EXPECT_EQ(tight->prior.min(), 0.0);
  EXPECT_EQ(tight->prior.max(), 4.94);
}

TEST(ParameterLibrary, APriorOfTheSiteIsTakenAsFarAsPhysicsGoes) {
  const Building building = sample_building();
  const auto& leakage = **find_parameter("leakage_area");
  EXPECT_TRUE(make_parameter(leakage, building, Prior{1.0, 12.0, 40.0}).has_value());
  const auto negative = make_parameter(leakage, building, Prior{-1.0, 2.0, 4.0});
  ASSERT_FALSE(negative.has_value());
  EXPECT_EQ(negative.error().message, "leakage_area cannot be -1 cm2/m2; it is at least 0 cm2/m2");
  const auto share = make_parameter(**find_parameter("night_fan"), building, Prior{0.0, 0.5, 1.5});
  ASSERT_FALSE(share.has_value());
  EXPECT_EQ(share.error().message, "night_fan cannot be 1.5; it is at most 1");
  const auto open = make_parameter(leakage, building, Prior{TruncatedNormalPrior{2.0, 3.0}});
  ASSERT_TRUE(open.has_value()) << open.error().message;
  EXPECT_EQ(open->prior.min(), 0.0);
  EXPECT_TRUE(make_parameter(**find_parameter("stop_late"), building, Prior{-3.0, 0.0, 1.0}));
}

TEST(ParameterLibrary, RelativeRangeOfNothingAsksForOne) {
  Building building = sample_building();
  building.base_heat_kW = 0.0;
  EXPECT_FALSE(make_parameter(**find_parameter("base_heat"), building).has_value());
}

// What the standard has not got must be neutral until it is calibrated.
TEST(ParameterLibrary, RoomsHoldHeatAsTheStandardSaysUntilToldOtherwise) {
  Building building = sample_building();
  const auto value_of = [&](std::string_view name) {
    return (*find_parameter(name))->get(building);
  };
  EXPECT_EQ(value_of("mass_coupling"), 1.0);
  EXPECT_EQ(value_of("core_mass"), 1.0);
  EXPECT_EQ(value_of("air_capacity"), 0.0);
  EXPECT_EQ(value_of("night_fan"), 0.0);
  EXPECT_EQ(value_of("chiller_lift"), 0.0);
  (*find_parameter("air_capacity"))->set(building, 35.0);
  EXPECT_DOUBLE_EQ(building.air_capacity_J_m2K, 35e3);
  (*find_parameter("night_fan"))->set(building, 0.4);
  EXPECT_DOUBLE_EQ(building.air->night_fan_share, 0.4);
  building.air.reset();
  (*find_parameter("night_fan"))->set(building, 0.4);
  EXPECT_EQ(value_of("night_fan"), 0.0);
}

TEST(ParameterLibrary, SettleKeepsTheDeadBand) {
  Building building = sample_building();
  (*find_parameter("cooling_setpoint"))->set(building, 20.0);
  settle(building);
  EXPECT_DOUBLE_EQ(building.set_points.cooling_occupied_C, 20.0);
  EXPECT_DOUBLE_EQ(building.set_points.heating_occupied_C, 19.0);
  EXPECT_DOUBLE_EQ(building.set_points.cooling_unoccupied_C, 24.0);
}

TEST(ParameterLibrary, FloorAreaScalesHorizontalPartsFullyAndWallsByTheSide) {
  Building building = sample_building();
  const double wall_m2 = building.surfaces[0].area_m2;
  (*find_parameter("floor_area"))->set(building, 4.0 * building.floor_area_m2);
  EXPECT_DOUBLE_EQ(building.surfaces[0].area_m2, 2.0 * wall_m2);
  EXPECT_DOUBLE_EQ(building.surfaces.back().area_m2, 4.0 * 1667.0);
}

}  // namespace
}  // namespace recald::model
