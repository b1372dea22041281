#include "core/model/epc/epc.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/model/epc/epc_model.hpp"
#include "core/model/hourly/hourly.hpp"
#include "core/weather/psychrometrics.hpp"
#include "tests/support/allocations.hpp"
#include "tests/support/sample_building.hpp"

namespace recald::model::epc::epc_test {
namespace {

using testing::allocation_count;
using testing::sample_building;
using testing::sample_drivers;

std::shared_ptr<const ClimateClasses> classes_of(const Building& building, int per_state,
                                                 int months = 24) {
  return std::make_shared<const ClimateClasses>(
      make_climate_classes(sample_drivers(building, months), per_state));
}

std::vector<EndUseEnergy> evaluate(const Building& building, int per_state = kClassesPerState) {
  const auto climate = classes_of(building, per_state);
  std::vector<EndUseEnergy> months(climate->months.size());
  Epc{climate}.evaluate(building, months);
  return months;
}

double year_kWh(const std::vector<EndUseEnergy>& months, std::initializer_list<EndUse> uses) {
  double sum = 0.0;
  for (const EndUseEnergy& month : months) {
    for (const EndUse use : uses) sum += month[use];
  }
  return sum;
}

using enum EndUse;
const std::initializer_list<EndUse> kCooling = {sensible_cooling, latent_cooling};
const std::initializer_list<EndUse> kHeating = {zone_heating, reheat, preheat, humidification};

// The classes stand for the hours: with every hour its own class the same equations give the plain
// hourly sum.
TEST(Epc, ClassesAgreeWithHourlySums) {
  const Building building = sample_building();
  const auto by_class = evaluate(building);
  const auto by_hour = evaluate(building, 0);
  const double mean_cooling_kWh = year_kWh(by_hour, kCooling) / 24.0;
  for (std::size_t i = 0; i < by_hour.size(); ++i) {
    SCOPED_TRACE(::testing::Message() << "month " << i);
    const double cooling_kWh = year_kWh({by_hour[i]}, kCooling);
    const double heating_kWh = year_kWh({by_hour[i]}, kHeating);
    EXPECT_NEAR(year_kWh({by_class[i]}, kCooling), cooling_kWh, 0.005 * mean_cooling_kWh);
    EXPECT_NEAR(year_kWh({by_class[i]}, kHeating), heating_kWh, 0.025 * heating_kWh);
    EXPECT_NEAR(by_class[i][fans], by_hour[i][fans], 0.006 * by_hour[i][fans]);
    EXPECT_NEAR(by_class[i][lighting], by_hour[i][lighting], 1e-9 * by_hour[i][lighting]);
  }
  EXPECT_NEAR(year_kWh(by_class, kHeating), year_kWh(by_hour, kHeating),
              0.01 * year_kWh(by_hour, kHeating));
}

/// Off from June to the middle of September.
Building with_boiler_off() {
  Building building = sample_building();
  building.seasons = {{.first = std::chrono::June / 1,
                       .last = std::chrono::September / 15,
                       .occupied_fraction = {},
                       .heating = false}};
  return building;
}

TEST(Epc, PlantThatIsOffUsesNothing) {
  const auto on = evaluate(sample_building());
  const auto off = evaluate(with_boiler_off());
  for (std::size_t month = 0; month < 12; ++month) {
    SCOPED_TRACE(month);
    const double share = month >= 5 && month <= 7 ? 0.0 : month == 8 ? 0.5 : 1.0;
    EXPECT_NEAR(year_kWh({off[month]}, kHeating), share * year_kWh({on[month]}, kHeating), 1e-6);
    EXPECT_DOUBLE_EQ(off[month][hot_water], on[month][hot_water]);
    EXPECT_DOUBLE_EQ(year_kWh({off[month]}, kCooling), year_kWh({on[month]}, kCooling));
  }
}

TEST(Epc, LatentPrefixSumsEqualThePlainSum) {
  const auto climate = classes_of(sample_building(), kClassesPerState, 2);
  const ClimateState& state = climate->months[1].occupied;
  for (const double cut : {-0.001, 0.0, 0.004, 0.0089, 0.03}) {
    double above = 0.0;
    double below = 0.0;
    for (const double w : state.humidity_ratio) {
      above += std::max(w - cut, 0.0);
      below += std::max(cut - w, 0.0);
    }
    EXPECT_NEAR(state.excess_over(cut), above, 1e-12);
    EXPECT_NEAR(state.shortfall_under(cut), below, 1e-12);
  }
}

// By hand for one class: 60 people at 55 W, 1.5 m³/s at 15 g/kg against a coil at 8.9 g/kg with
// ρ = 1.2 and half the air recirculated gives 29 116.5 W in the worked example of the air side.
TEST(Epc, PeoplesMoistureMeetsTheCoilOnlyThroughRecirculation) {
  const double outdoor_W = 1.2 * 1.5 * weather::kVaporisationHeat_J_kg;
  const double share = 1.5 / 3.030303;
  const double people_W = (1.0 - share) * 55.0 * 60.0;
  ClimateState state;
  state.hours = 1.0;
  state.humidity_ratio = {0.015};
  state.humidity_ratio_sum = {0.0, 0.015};
  EXPECT_NEAR(outdoor_W * state.excess_over(0.0089 - people_W / outdoor_W), 29116.5, 0.5);
}

TEST(Epc, MonotoneInWhatEverybodyKnows) {
  const Building base = sample_building();
  const auto cooling = [](const Building& b) { return year_kWh(evaluate(b), kCooling); };
  const auto heating = [](const Building& b) { return year_kWh(evaluate(b), kHeating); };
  Building changed = base;
  changed.set_points.heating_occupied_C = 22.0;
  changed.set_points.heating_unoccupied_C = 18.0;
  EXPECT_GT(heating(changed), heating(base)) << "warmer rooms";
  changed = base;
  changed.set_points.cooling_occupied_C = 26.0;
  EXPECT_LT(cooling(changed), cooling(base)) << "warmer rooms";
  changed = base;
  for (Surface& surface : changed.surfaces) surface.u_W_m2K *= 1.5;
  EXPECT_GT(heating(changed), heating(base)) << "worse insulation";
  changed = base;
  changed.air->outdoor_air_m3_s *= 1.3;
  EXPECT_GT(cooling(changed), cooling(base)) << "more outdoor air in a hot climate";
  changed = base;
  changed.use.occupancy_person_m2 *= 1.5;
  EXPECT_GT(cooling(changed), cooling(base)) << "more people";
  EXPECT_LT(heating(changed), heating(base)) << "more people";
  changed = base;
  for (Surface& surface : changed.surfaces) surface.shgc *= 1.3;
  EXPECT_GT(cooling(changed), cooling(base)) << "clearer glass";
}

TEST(Epc, ExtremesStayFinite) {
  Building building = sample_building();
  const auto expect_finite = [](const Building& b) {
    for (const EndUseEnergy& month : evaluate(b)) {
      for (std::size_t i = 0; i < kEndUses; ++i) {
        EXPECT_TRUE(std::isfinite(month[static_cast<EndUse>(i)])) << kEndUseNames[i];
        EXPECT_GE(month[static_cast<EndUse>(i)], 0.0) << kEndUseNames[i];
      }
    }
  };
  building.heat_capacity_J_m2K = 1e-3;
  expect_finite(building);
  building.heat_capacity_J_m2K = 1e12;
  expect_finite(building);
  building = sample_building();
  building.air->outdoor_air_m3_s = 0.0;
  building.air->outdoor_air_unoccupied_fraction = 0.0;
  building.use.occupancy_person_m2 = 0.0;
  building.leakage_cm2_m2 = 0.0;
  expect_finite(building);
}

TEST(Epc, GasHeatedBuildingWithoutAirHandlers) {
  Building building = sample_building();
  building.air.reset();
  building.ventilation_m3_s = 3.0;
  const auto months = evaluate(building);
  EXPECT_GT(months[0][zone_heating], 0.0);
  EXPECT_EQ(months[0][reheat], 0.0);
  EXPECT_EQ(months[0][fans], 0.0);
  Building more_air = building;
  more_air.ventilation_m3_s = 4.0;
  EXPECT_GT(evaluate(more_air)[0][zone_heating], months[0][zone_heating]);
}

TEST(Epc, ChillerDrawsWhatDistrictCoolingDelivers) {
  Building building = sample_building();
  const auto district = evaluate(building);
  building.chiller_cop = 4.0;
  const auto own = evaluate(building);
  EXPECT_NEAR(own[6][chiller], (district[6][sensible_cooling] + district[6][latent_cooling]) / 4.0,
              1e-9);
}

TEST(Epc, HotWaterByHand) {
  Building building = sample_building();
  building.hot_water = {.volume_m3_day = 2.0,
                        .temperature_C = 55.0,
                        .mains_C = 15.0,
                        .mains_amplitude_K = 0.0,
                        .efficiency = 0.8};
  building.heating_efficiency = 0.9;
  // 2 m³ · 31 days · 1.163 kWh/(m³K) · 40 K / 0.72
  EXPECT_NEAR(evaluate(building)[0][hot_water], 2.0 * 31.0 * 1.163 * 40.0 / 0.72, 1e-9);
}

TEST(EpcModel, DailyAveragesAreMonthsOverDays) {
  const Building building = sample_building();
  const auto climate = classes_of(building, kClassesPerState, 2);
  const auto map = *default_meter_map(metering::Utility::chilled_water);
  EpcModel model{building, {*find_parameter("cooling_setpoint")}, {map}, climate};
  const double theta[] = {24.0};
  std::vector<double> outputs(2);
  model.evaluate(theta, outputs);
  const auto energy = model.end_uses(theta);
  EXPECT_NEAR(outputs[1], (energy[1][sensible_cooling] + energy[1][latent_cooling]) / 28.0, 1e-9);
}

TEST(EpcModel, ThetaLeavesNoTrace) {
  const Building building = sample_building();
  const auto climate = classes_of(building, kClassesPerState, 12);
  std::vector<const ParameterDefinition*> parameters;
  for (const auto& definition : parameter_library()) {
    if (definition.is_modelled()) parameters.push_back(&definition);
  }
  std::vector<double> nominal;
  std::vector<double> moved;
  for (const auto* p : parameters) {
    nominal.push_back(p->get(building));
    moved.push_back(p->get(building) * 1.1);
  }
  EpcModel model{building, parameters, {*default_meter_map(metering::Utility::steam)}, climate};
  std::vector<double> first(12), second(12), third(12);
  model.evaluate(nominal, first);
  model.evaluate(moved, second);
  model.evaluate(nominal, third);
  EXPECT_NE(first, second);
  EXPECT_EQ(first, third);
}

// Lamps that take less use less themselves, and leave less to cool and more to heat.
TEST(EpcModel, LightsAndPlugsFollowTheirParameters) {
  const Building building = sample_building();
  const auto climate = classes_of(building, kClassesPerState, 12);
  EpcModel model{building,
                 {*find_parameter("lighting_use"), *find_parameter("electric_use")},
                 {*default_meter_map(metering::Utility::electricity)},
                 climate};
  const auto year = [&](double lights, double all, std::initializer_list<EndUse> uses) {
    const double theta[] = {lights, all};
    const auto energy = model.end_uses(theta);
    return year_kWh({energy.begin(), energy.end()}, uses);
  };
  EXPECT_NEAR(year(0.6, 0.5, {lighting}), 0.3 * year(1.0, 1.0, {lighting}), 1e-6);
  EXPECT_NEAR(year(0.6, 0.5, {plugs}), 0.5 * year(1.0, 1.0, {plugs}), 1e-6);
  EXPECT_LT(year(0.6, 1.0, {sensible_cooling}), year(1.0, 1.0, {sensible_cooling}));
  EXPECT_GT(year(0.6, 1.0, {zone_heating, reheat}), year(1.0, 1.0, {zone_heating, reheat}));
}

TEST(EpcModel, EvaluationDoesNotAllocate) {
  const Building building = sample_building();
  const auto climate = classes_of(building, kClassesPerState);
  EpcModel model{building,
                 {*find_parameter("occupancy_density"), *find_parameter("outdoor_airflow"),
                  *find_parameter("cooling_setpoint")},
                 {*default_meter_map(metering::Utility::chilled_water),
                  *default_meter_map(metering::Utility::steam)},
                 climate};
  const double theta[] = {0.06, 5.0, 23.0};
  std::vector<double> outputs(48);
  model.evaluate(theta, outputs);  // the first call may size the scratch
  const long before = allocation_count();
  model.evaluate(theta, outputs);
  EXPECT_EQ(allocation_count() - before, 0);
}

/// Both models' months of the building with units in its rooms.
struct BothModels {
  std::vector<EndUseEnergy> monthly, hourly;
};
BothModels with_room_units(Building building) {
  building.air->has_reheat_boxes = false;
  hourly::Hourly hourly{std::make_shared<const Drivers>(sample_drivers(building, 24)),
                        {.steps_per_hour = 1}};
  BothModels both{evaluate(building), std::vector<EndUseEnergy>(24)};
  hourly.run_end_uses(building, {}, both.hourly);
  return both;
}

// What units add, apart from how well a month uses gains: where these are large beside the losses,
// the monthly method needs a third more heat than the hours, without units too (34 to 44 % here).
// So: plant that never stops, and fans that warm nothing.
TEST(Epc, RoomUnitsAgreeWithTheHourlyModel) {
  for (const bool has_economiser : {false, true}) {
    SCOPED_TRACE(has_economiser);
    Building building = sample_building();
    building.air->outdoor_air_unoccupied_fraction = 1.0;
    building.air->fan_design_kW = 0.0;
    if (has_economiser) building.air->economiser_lockout_C = 18.0;
    const BothModels both = with_room_units(building);
    const double heat_kWh = year_kWh(both.hourly, kHeating);
    const double cold_kWh = year_kWh(both.hourly, kCooling);
    EXPECT_NEAR(year_kWh(both.monthly, kHeating), heat_kWh, 0.05 * heat_kWh);
    EXPECT_NEAR(year_kWh(both.monthly, kCooling), cold_kWh, 0.12 * cold_kWh);
    EXPECT_EQ(year_kWh(both.monthly, {reheat, preheat}), 0.0);
  }
}

TEST(Epc, FansOfRoomUnitsAgreeWithTheHourlyModel) {
  const BothModels both = with_room_units(sample_building());
  const double fans_kWh = year_kWh(both.hourly, {fans});
  EXPECT_NEAR(year_kWh(both.monthly, {fans}), fans_kWh, 0.1 * fans_kWh);
  EXPECT_LT(year_kWh(both.monthly, {fans}), fans_kWh) << "those on call are left out";
}

}  // namespace
}  // namespace recald::model::epc::epc_test
