#include "core/model/parameter_library.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

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
  EXPECT_THAT(found.error().message, HasSubstr("this model has no such quantity"));
}

// A wall of U = 0.5 is 2 m2 K/W, of which the films are 0.17 and the wall 1.83.
TEST(ParameterLibrary, ConductivityChangesTheWallButNotItsFilmsNorTheGlass) {
  Building building = sample_building();
  building.surfaces = {{.name = "wall",
                        .kind = SurfaceKind::wall,
                        .area_m2 = 1.0,
                        .u_W_m2K = 0.5,
                        .orientation = {}},
                       {.name = "sheet",
                        .kind = SurfaceKind::roof,
                        .area_m2 = 1.0,
                        .u_W_m2K = 8.0,
                        .orientation = {}},
                       {.name = "pane",
                        .kind = SurfaceKind::window,
                        .area_m2 = 1.0,
                        .u_W_m2K = 2.0,
                        .orientation = {}}};
  (*find_parameter("conductivity_scale"))->set(building, 1.15);
  EXPECT_DOUBLE_EQ(building.surfaces[0].u_W_m2K, 1.0 / (0.17 + 1.83 / 1.15));
  EXPECT_DOUBLE_EQ(building.surfaces[1].u_W_m2K, 8.0);
  EXPECT_DOUBLE_EQ(building.surfaces[2].u_W_m2K, 2.0);
  (*find_parameter("thermal_resistance_scale"))->set(building, 1.15);
  EXPECT_DOUBLE_EQ(building.surfaces[0].u_W_m2K, 0.5);
  EXPECT_DOUBLE_EQ(building.surfaces[1].u_W_m2K, 8.0);
}

TEST(ParameterLibrary, DensityAndAbsorptanceAreOfTheFabric) {
  Building building = sample_building();
  const double capacity = building.heat_capacity_J_m2K;
  (*find_parameter("density_scale"))->set(building, 0.97);
  EXPECT_DOUBLE_EQ(building.heat_capacity_J_m2K, 0.97 * capacity);
  const Building before = building;
  (*find_parameter("thermal_absorptance_scale"))->set(building, 0.88);
  for (std::size_t i = 0; i < building.surfaces.size(); ++i) {
    const double factor = building.surfaces[i].kind == SurfaceKind::window ? 1.0 : 0.88;
    EXPECT_DOUBLE_EQ(building.surfaces[i].emissivity, factor * before.surfaces[i].emissivity);
  }
}

TEST(ParameterLibrary, ADesignValueMayComeFromAModelThatIsNoBuilding) {
  const auto library = parameter_library();
  const auto lights = std::ranges::find(library, "lighting_power", &ParameterDefinition::name);
  ASSERT_NE(lights, library.end());
  EXPECT_FALSE(lights->is_modelled());
  EXPECT_EQ(make_parameter(*lights, 10.0)->prior, (Prior{7.0, 10.0, 14.0}));
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
