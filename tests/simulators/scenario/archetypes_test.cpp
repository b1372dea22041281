#include "simulators/scenario/archetypes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "simulators/feed/meters.hpp"
#include "simulators/feed/recording.hpp"

namespace recald::simulators::archetypes_test {
namespace {

using namespace std::chrono;

/// Truth with the parameters of the drawings, so that a test does not hang on one draw.
Truth as_drawn(const Drawings& drawings) {
  Truth truth = draw_truth(drawings, 1);
  truth.occupancy_density_person_m2 = drawings.occupancy_person_m2;
  for (double& flow_m3_s : truth.outdoor_m3_s) {
    flow_m3_s *= drawings.outdoor_air_m3_s() / truth.outdoor_airflow_m3_s;
  }
  truth.outdoor_airflow_m3_s = drawings.outdoor_air_m3_s();
  truth.cooling_setpoint_C = drawings.cooling_setpoint_C;
  truth.heating_setpoint_C = drawings.heating_setpoint_C;
  return truth;
}

/// kWh/m² a year that meters of such buildings show: electricity with own cooling, and all of it.
struct Published {
  Use use;
  double electricity_least, electricity_most;
  double all_least, all_most;
  friend void PrintTo(const Published& published, std::ostream* out) {
    *out << to_string(published.use);
  }
};

// Between the lower and the higher of two stocks, and a third more either way: site energy of
// ENERGY STAR's Technical Reference "U.S. Energy Use Intensity by Property Type" (medians of CBECS
// 2012 and others) and of CIBSE TM46:2008 (electricity + fossil); electricity of CBECS 2012 table
// C14 and TM46.
//   shop        electricity 165 (mercantile; general retail 165, large non-food 70)   all 162; 240
//   hotel       electricity 165 (lodging; 105)                                        all 199; 435
//   clinic      electricity 200 (outpatient; clinic 70, hospital 90)  all 196 (outpatient); 510
//   (hospital) warehouse   electricity 71 (35) all 72; 195 restaurant  electricity 483 (food
//   service; 90)                                    all 1027; 460 gym         electricity 155
//   (public assembly; 160)                                all 160; 600
constexpr auto kPublished = std::to_array<Published>({{Use::shop, 49.0, 215.0, 113.0, 312.0},
                                                      {Use::hotel, 74.0, 215.0, 139.0, 566.0},
                                                      {Use::clinic, 49.0, 260.0, 137.0, 663.0},
                                                      {Use::warehouse, 24.0, 92.0, 50.0, 254.0},
                                                      {Use::restaurant, 63.0, 628.0, 322.0, 1335.0},
                                                      {Use::gym, 108.0, 208.0, 112.0, 780.0}});

class EveryNewUse : public ::testing::TestWithParam<Published> {
 protected:
  static Drawings drawings_in(ClimateKind climate) {
    Brief brief = typical_brief(GetParam().use);
    brief.climate = climate;
    return draw_up(brief);
  }
};

TEST_P(EveryNewUse, UsesWhatSuchBuildingsUse) {
  const Published& published = GetParam();
  for (const ClimateKind climate : {ClimateKind::hot_humid, ClimateKind::cold}) {
    SCOPED_TRACE(name_of(climate));
    const Drawings drawings = drawings_in(climate);
    Building building(as_drawn(drawings), kInterval, 7, {});
    const auto recording = record(building, {2022, 1}, 7);
    ASSERT_TRUE(recording.has_value()) << recording.error().message;
    double electricity_kWh_m2 = 0.0;
    double heat_kWh_m2 = 0.0;
    for (const UtilityPower& power : recording->power) {
      electricity_kWh_m2 += 0.25 * power.electricity_kW / drawings.floor_area_m2();
      heat_kWh_m2 += 0.25 * power.heat_kW / drawings.floor_area_m2();
    }
    EXPECT_GT(electricity_kWh_m2, published.electricity_least);
    EXPECT_LT(electricity_kWh_m2, published.electricity_most);
    EXPECT_GT(electricity_kWh_m2 + heat_kWh_m2, published.all_least);
    EXPECT_LT(electricity_kWh_m2 + heat_kWh_m2, published.all_most);
  }
}

// From an hour after the air handlers began until they stop, no more than three in a hundred zone
// hours lie outside the thermostats' bands.
TEST_P(EveryNewUse, RoomsHoldTheirSetPointsWhilePeopleAreThere) {
  for (const ClimateKind climate : {ClimateKind::hot_dry, ClimateKind::cold}) {
    SCOPED_TRACE(name_of(climate));
    const Drawings drawings = drawings_in(climate);
    const auto calendar = metering::LocalCalendar::open(drawings.time_zone);
    ASSERT_TRUE(calendar.has_value());
    const Truth truth = as_drawn(drawings);
    WeatherGenerator weather(climate_of(climate, drawings.place), sys_days{2022y / January / 1},
                             stream_of(3, Stream::weather), kInterval);
    Building building(truth, kInterval, 3, {});
    const Calendar days_of(drawings.calendar);
    int hours = 0;
    int warm = 0;
    int cold = 0;
    for (auto now = metering::Instant{sys_days{2022y / January / 1}};
         now < sys_days{2023y / January / 1}; now += kInterval) {
      const metering::LocalTime local = calendar->local_time(now);
      building.advance(weather.advance(), now, local);
      const double hour = local.minute_of_day / 60.0;
      const bool served = is_open(drawings.open_days, days_of.kind_of(local.date)) &&
                          hour >= truth.occupied_from_h + 1.0 && hour < truth.occupied_to_h;
      if (!served || now < sys_days{2022y / January / 20}) continue;
      for (std::size_t zone = 0; zone < building.zones().size(); ++zone) {
        const double felt_C =
            building.zones()[zone].operative_C() - truth.thermostat_offset_K[zone];
        ++hours;
        warm += felt_C > truth.cooling_setpoint_C + truth.thermostat_band_K ? 1 : 0;
        cold += felt_C < truth.heating_setpoint_C - truth.thermostat_band_K ? 1 : 0;
      }
    }
    EXPECT_LT(warm + cold, 0.03 * hours) << warm << " too warm, " << cold << " too cold";
  }
}

INSTANTIATE_TEST_SUITE_P(Uses, EveryNewUse, ::testing::ValuesIn(kPublished),
                         [](const auto& tested) {
                           return std::string(to_string(tested.param.use));
                         });

TEST(Archetypes, DifferAsTheirUsesDo) {
  std::vector<Drawings> all;
  for (const Use use : kUses) all.push_back(draw_up({.use = use}));
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      SCOPED_TRACE(all[i].name + " and " + all[j].name);
      EXPECT_NE(all[i].presence_workday, all[j].presence_workday);
      EXPECT_NE(all[i].occupancy_person_m2 * all[i].outdoor_air_m3_s(),
                all[j].occupancy_person_m2 * all[j].outdoor_air_m3_s());
    }
  }
}

// Thirty years of codes: less through walls, roofs and windows, less light, better machines.
TEST(Archetypes, OlderBuildingsLoseMoreAndYoungerLess) {
  const auto of = [](Vintage vintage) {
    return draw_up({.use = Use::clinic,
                    .cooling = CoolingPlant::chiller,
                    .heating = HeatingPlant::boiler,
                    .vintage = vintage});
  };
  const Drawings old = of(Vintage::of_1980s);
  const Drawings usual = of(Vintage::of_2000s);
  const Drawings young = of(Vintage::of_2010s);
  for (const auto member : {&Drawings::wall_u_W_m2K, &Drawings::roof_u_W_m2K,
                            &Drawings::window_u_W_m2K, &Drawings::leakage_cm2_m2}) {
    EXPECT_GT(old.*member, usual.*member);
    EXPECT_LT(young.*member, usual.*member);
  }
  for (const auto member : {&Drawings::chiller_cop, &Drawings::heating_efficiency}) {
    EXPECT_LT(old.*member, usual.*member);
    EXPECT_GT(young.*member, usual.*member);
  }
  EXPECT_GT(old.core_rooms.lighting_W_m2, usual.core_rooms.lighting_W_m2);
  EXPECT_GT(old.heating_design_kW, usual.heating_design_kW);
}

TEST(Archetypes, OnlyTightRoomsHoldTheirPressure) {
  const auto pressurised_Pa = [](Use use) { return draw_up(typical_brief(use)).pressurised_Pa; };
  EXPECT_EQ(pressurised_Pa(Use::office), 3.0);
  EXPECT_EQ(pressurised_Pa(Use::clinic), 3.0);
  EXPECT_EQ(pressurised_Pa(Use::gym), 3.0);
  EXPECT_LT(pressurised_Pa(Use::warehouse), 1.0);
  EXPECT_EQ(pressurised_Pa(Use::restaurant), 0.0);  // its hoods take all
}

TEST(Archetypes, PackagedUnitsHaveNoChilledWater) {
  Brief brief = typical_brief(Use::shop);
  const auto meters_of = [](const Drawings& drawings) {
    std::vector<std::string_view> ids;
    for (const MeterPlate& plate : plates_of(drawings)) ids.push_back(plate.id);
    return ids;
  };
  const Drawings packaged = draw_up(brief);
  EXPECT_EQ(meters_of(packaged), (std::vector<std::string_view>{"electricity", "gas"}));
  EXPECT_EQ(packaged.chilled_water_standing_kW, 0.0);
  brief.cooling = CoolingPlant::chiller;
  const Drawings chilled = draw_up(brief);
  EXPECT_EQ(meters_of(chilled),
            (std::vector<std::string_view>{"chilled_water", "electricity", "gas"}));
  EXPECT_LT(packaged.pump_kW, 0.6 * chilled.pump_kW);
  EXPECT_LT(packaged.chiller_cop, chilled.chiller_cop);
}

}  // namespace
}  // namespace recald::simulators::archetypes_test
