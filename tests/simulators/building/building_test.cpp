#include "simulators/building/building.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "simulators/feed/recording.hpp"
#include "simulators/scenario/archetypes.hpp"

namespace recald::simulators::building_test {
namespace {

using namespace std::chrono;

/// Truth with the parameters of the drawings, so that a test does not hang on one draw.
Truth nominal_truth() {
  Truth truth = draw_truth({}, 1);
  truth.occupancy_density_person_m2 = truth.drawings.occupancy_person_m2;
  for (double& flow_m3_s : truth.outdoor_m3_s) {
    flow_m3_s *= truth.drawings.outdoor_air_m3_s() / truth.outdoor_airflow_m3_s;
  }
  truth.outdoor_airflow_m3_s = truth.drawings.outdoor_air_m3_s();
  truth.cooling_setpoint_C = truth.drawings.cooling_setpoint_C;
  truth.heating_setpoint_C = truth.drawings.heating_setpoint_C;
  return truth;
}

struct Year {
  UtilityPower energy_kWh_m2;  ///< The members hold kWh/m² here.
  UtilityPower january_kWh_m2;
  UtilityPower july_kWh_m2;
};

Year run_year(const Truth& truth, std::uint64_t seed = 7) {
  Building building(truth, kStep, seed, {});
  const auto recording = record(building, {2021, 1}, seed);
  EXPECT_TRUE(recording.has_value());
  Year year;
  const auto add = [](UtilityPower& sum, const UtilityPower& power) {
    const double share = 0.25 / Drawings{}.floor_area_m2();
    sum.electricity_kW += share * power.electricity_kW;
    sum.cooling_kW += share * power.cooling_kW;
    sum.heat_kW += share * power.heat_kW;
  };
  for (std::size_t slot = 0; slot < recording->power.size(); ++slot) {
    add(year.energy_kWh_m2, recording->power[slot]);
    const year_month_day date{floor<days>(recording->start_of(slot))};
    if (date.month() == January) add(year.january_kWh_m2, recording->power[slot]);
    if (date.month() == July) add(year.july_kWh_m2, recording->power[slot]);
  }
  return year;
}

/// A building a test looks into: use, climate, storeys, constructions, step.
struct Look {
  const char* name;
  Brief brief;
  seconds step;
  friend void PrintTo(const Look& look, std::ostream* out) { *out << look.name; }
};

class EveryZone : public ::testing::TestWithParam<Look> {};

// What each zone takes up from gains, air, neighbours and constructions is what it stores.
TEST_P(EveryZone, HeatBalanceClosesOverAWeek) {
  const Look& look = GetParam();
  const Drawings drawings = draw_up(look.brief);
  const auto calendar = metering::LocalCalendar::open(drawings.time_zone);
  ASSERT_TRUE(calendar.has_value());
  WeatherGenerator weather(climate_of(drawings.climate, drawings.place), sys_days{2021y / July / 1},
                           stream_of(1, Stream::weather), look.step);
  Building building(draw_truth(drawings, 1), look.step, 1, {});
  std::vector<double> imbalance_J(building.zones().size(), 0.0);
  double together_J = 0.0;
  for (auto now = metering::Instant{sys_days{2021y / July / 1}}; now < sys_days{2021y / July / 8};
       now += look.step) {
    building.advance(weather.advance(), now, calendar->local_time(now));
    for (std::size_t zone = 0; zone < imbalance_J.size(); ++zone) {
      imbalance_J[zone] += std::abs(building.heat_imbalance_J(zone));
    }
    together_J += std::abs(building.heat_imbalance_J());
  }
  double stored_J = 0.0;
  for (std::size_t zone = 0; zone < imbalance_J.size(); ++zone) {
    EXPECT_LT(imbalance_J[zone], 1e-9 * building.zones()[zone].stored_J()) << zone;
    stored_J += building.zones()[zone].stored_J();
  }
  EXPECT_LT(together_J, 1e-9 * stored_J);
}

INSTANTIATE_TEST_SUITE_P(
    Buildings, EveryZone,
    ::testing::Values(
        Look{"laboratory",
             {.use = Use::laboratory, .climate = ClimateKind::hot_humid, .storeys = 3},
             300s},
        Look{"tower", {.use = Use::office, .climate = ClimateKind::cold, .storeys = 12}, 900s},
        Look{"hall",
             {.use = Use::school,
              .climate = ClimateKind::hot_dry,
              .storeys = 1,
              .skylight_share = 0.1,
              .heavy = false},
             900s},
        Look{"shop", {.use = Use::shop, .storeys = 1, .cooling = CoolingPlant::packaged}, 900s},
        Look{"hotel", {.use = Use::hotel, .storeys = 5, .width_m = 18.0}, 900s},
        Look{"clinic", {.use = Use::clinic, .climate = ClimateKind::marine, .storeys = 2}, 900s},
        Look{"warehouse", {.use = Use::warehouse, .storeys = 1, .heavy = false}, 900s},
        Look{"restaurant", {.use = Use::restaurant, .storeys = 1, .length_m = 26.0}, 300s},
        Look{"gym", {.use = Use::gym, .climate = ClimateKind::hot_humid, .storeys = 1}, 900s}),
    [](const auto& tested) { return tested.param.name; });

// Laboratories of the hot-humid south-east with reheat: the ranges are wide on purpose.
TEST(Building, AnnualUseIsThatOfALaboratoryInAtlanta) {
  const Year year = run_year(nominal_truth());
  EXPECT_GT(year.energy_kWh_m2.electricity_kW, 150.0);
  EXPECT_LT(year.energy_kWh_m2.electricity_kW, 300.0);
  EXPECT_GT(year.energy_kWh_m2.cooling_kW, 150.0);
  EXPECT_LT(year.energy_kWh_m2.cooling_kW, 350.0);
  EXPECT_GT(year.energy_kWh_m2.heat_kW, 70.0);
  EXPECT_LT(year.energy_kWh_m2.heat_kW, 250.0);
  // Summer cools, winter heats, and reheat never stops.
  EXPECT_GT(year.july_kWh_m2.cooling_kW, 5.0 * year.january_kWh_m2.cooling_kW);
  EXPECT_GT(year.january_kWh_m2.heat_kW, 1.8 * year.july_kWh_m2.heat_kW);
  EXPECT_GT(year.july_kWh_m2.heat_kW, 2.0);
  EXPECT_GT(year.january_kWh_m2.cooling_kW, 1.0);
}

TEST(Building, RespondsToItsParametersAsPhysicsDemands) {
  const Truth base_truth = nominal_truth();
  const Year base = run_year(base_truth);

  Truth sealed = base_truth;
  for (double& flow_m3_s : sealed.outdoor_m3_s) flow_m3_s *= 0.5;
  const Year less_air = run_year(sealed);
  EXPECT_LT(less_air.july_kWh_m2.cooling_kW, 0.85 * base.july_kWh_m2.cooling_kW);
  EXPECT_LT(less_air.january_kWh_m2.heat_kW, base.january_kWh_m2.heat_kW);

  Truth warmer = base_truth;
  warmer.cooling_setpoint_C += 2.0;
  const Year less_cold = run_year(warmer);
  EXPECT_LT(less_cold.energy_kWh_m2.cooling_kW, 0.98 * base.energy_kWh_m2.cooling_kW);

  Truth crowded = base_truth;
  crowded.occupancy_density_person_m2 *= 2.0;
  const Year more_people = run_year(crowded);
  EXPECT_GT(more_people.july_kWh_m2.cooling_kW, base.july_kWh_m2.cooling_kW);
  EXPECT_LT(more_people.energy_kWh_m2.heat_kW, base.energy_kWh_m2.heat_kW);
}

TEST(Building, ZonesStayWithinTheirThermostatsInWorkingHours) {
  const auto calendar = metering::LocalCalendar::open(Drawings{}.time_zone);
  ASSERT_TRUE(calendar.has_value());
  const Truth truth = nominal_truth();
  WeatherGenerator weather(hot_humid_climate(Drawings{}.place), sys_days{2021y / January / 1},
                           stream_of(3, Stream::weather));
  Building building(truth, kStep, 3, {});
  int hours = 0;
  int unmet = 0;
  for (auto now = metering::Instant{sys_days{2021y / January / 1}};
       now < sys_days{2022y / January / 1}; now += kStep) {
    const metering::LocalTime local = calendar->local_time(now);
    building.advance(weather.advance(), now, local);
    const bool working = Calendar(Use::laboratory).kind_of(local.date) == DayKind::workday &&
                         local.minute_of_day >= 540 && local.minute_of_day < 1020;
    if (!working || now < sys_days{2021y / January / 20}) continue;
    for (std::size_t zone = 0; zone < building.zones().size(); ++zone) {
      const double felt_C = building.zones()[zone].operative_C() - truth.thermostat_offset_K[zone];
      ++hours;
      if (felt_C > truth.cooling_setpoint_C + truth.thermostat_band_K ||
          felt_C < truth.heating_setpoint_C - truth.thermostat_band_K) {
        ++unmet;
      }
    }
  }
  EXPECT_LT(unmet, 0.03 * hours);
}

TEST(Recording, CoversLocalYearsWithLeapDaysAndClockChanges) {
  Building building(nominal_truth(), kStep, 1, {});
  const auto recording = record(building, {2024, 1}, 1);
  ASSERT_TRUE(recording.has_value());
  EXPECT_EQ(metering::to_string(recording->begin), "2024-01-01T05:00:00Z");
  EXPECT_EQ(recording->power.size(), 366u * 96u);
  EXPECT_EQ(recording->weather.size(), recording->power.size());
  for (const UtilityPower& power : recording->power) {
    ASSERT_TRUE(std::isfinite(power.electricity_kW) && power.electricity_kW > 0.0);
    ASSERT_TRUE(std::isfinite(power.cooling_kW) && power.cooling_kW > 0.0);
    ASSERT_TRUE(std::isfinite(power.heat_kW) && power.heat_kW > 0.0);
  }
}

}  // namespace
}  // namespace recald::simulators::building_test
