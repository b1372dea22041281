#include "simulators/building/building.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "simulators/feed/recording.hpp"

namespace recald::simulators {
namespace {

using namespace std::chrono;

/// Truth with the parameters of the drawings, so that a test does not hang on one draw.
Truth nominal_truth() {
  Truth truth = draw_truth(1);
  truth.occupancy_density_person_m2 = drawings::occupancy_person_m2;
  for (double& flow_m3_s : truth.outdoor_m3_s) {
    flow_m3_s *= drawings::outdoor_air_m3_s / truth.outdoor_airflow_m3_s;
  }
  truth.outdoor_airflow_m3_s = drawings::outdoor_air_m3_s;
  truth.cooling_setpoint_C = drawings::cooling_setpoint_C;
  truth.heating_setpoint_C = drawings::heating_setpoint_C;
  return truth;
}

struct Year {
  UtilityPower energy_kWh_m2;  ///< The members hold kWh/m² here.
  UtilityPower january_kWh_m2;
  UtilityPower july_kWh_m2;
};

Year run_year(const Truth& truth, std::uint64_t seed = 7) {
  const auto recording = record(truth, {2021, 1}, seed);
  EXPECT_TRUE(recording.has_value());
  Year year;
  const auto add = [](UtilityPower& sum, const UtilityPower& power) {
    constexpr double share = 0.25 / drawings::floor_area_m2;
    sum.electricity_kW += share * power.electricity_kW;
    sum.chilled_water_kW += share * power.chilled_water_kW;
    sum.steam_kW += share * power.steam_kW;
  };
  for (std::size_t slot = 0; slot < recording->power.size(); ++slot) {
    add(year.energy_kWh_m2, recording->power[slot]);
    const year_month_day date{floor<days>(recording->start_of(slot))};
    if (date.month() == January) add(year.january_kWh_m2, recording->power[slot]);
    if (date.month() == July) add(year.july_kWh_m2, recording->power[slot]);
  }
  return year;
}

TEST(Building, HeatBalanceOfAllZonesClosesOverAWeek) {
  const auto calendar = metering::LocalCalendar::open(drawings::time_zone);
  ASSERT_TRUE(calendar.has_value());
  WeatherGenerator weather(hot_humid_climate(drawings::place), sys_days{2021y / July / 1},
                           stream_of(1, Stream::weather));
  Building building(draw_truth(1), 1);
  double stored_before_J = 0.0;
  for (const Zone& zone : building.zones()) stored_before_J += zone.stored_J();
  double imbalance_J = 0.0;
  for (auto now = metering::Instant{sys_days{2021y / July / 1}}; now < sys_days{2021y / July / 8};
       now += kStep) {
    building.advance(weather.advance(), calendar->local_time(now));
    imbalance_J += std::abs(building.heat_imbalance_J());
  }
  EXPECT_LT(imbalance_J, 1e-9 * stored_before_J);
}

// Laboratories of the hot-humid south-east with reheat: the ranges are wide on purpose.
TEST(Building, AnnualUseIsThatOfALaboratoryInAtlanta) {
  const Year year = run_year(nominal_truth());
  EXPECT_GT(year.energy_kWh_m2.electricity_kW, 150.0);
  EXPECT_LT(year.energy_kWh_m2.electricity_kW, 300.0);
  EXPECT_GT(year.energy_kWh_m2.chilled_water_kW, 150.0);
  EXPECT_LT(year.energy_kWh_m2.chilled_water_kW, 350.0);
  EXPECT_GT(year.energy_kWh_m2.steam_kW, 70.0);
  EXPECT_LT(year.energy_kWh_m2.steam_kW, 250.0);
  // Summer cools, winter heats, and reheat never stops.
  EXPECT_GT(year.july_kWh_m2.chilled_water_kW, 5.0 * year.january_kWh_m2.chilled_water_kW);
  EXPECT_GT(year.january_kWh_m2.steam_kW, 1.8 * year.july_kWh_m2.steam_kW);
  EXPECT_GT(year.july_kWh_m2.steam_kW, 2.0);
  EXPECT_GT(year.january_kWh_m2.chilled_water_kW, 1.0);
}

TEST(Building, RespondsToItsParametersAsPhysicsDemands) {
  const Truth base_truth = nominal_truth();
  const Year base = run_year(base_truth);

  Truth sealed = base_truth;
  for (double& flow_m3_s : sealed.outdoor_m3_s) flow_m3_s *= 0.5;
  const Year less_air = run_year(sealed);
  EXPECT_LT(less_air.july_kWh_m2.chilled_water_kW, 0.85 * base.july_kWh_m2.chilled_water_kW);
  EXPECT_LT(less_air.january_kWh_m2.steam_kW, base.january_kWh_m2.steam_kW);

  Truth warmer = base_truth;
  warmer.cooling_setpoint_C += 2.0;
  const Year less_cold = run_year(warmer);
  EXPECT_LT(less_cold.energy_kWh_m2.chilled_water_kW, 0.98 * base.energy_kWh_m2.chilled_water_kW);

  Truth crowded = base_truth;
  crowded.occupancy_density_person_m2 *= 2.0;
  const Year more_people = run_year(crowded);
  EXPECT_GT(more_people.july_kWh_m2.chilled_water_kW, base.july_kWh_m2.chilled_water_kW);
  EXPECT_LT(more_people.energy_kWh_m2.steam_kW, base.energy_kWh_m2.steam_kW);
}

TEST(Building, ZonesStayWithinTheirThermostatsInWorkingHours) {
  const auto calendar = metering::LocalCalendar::open(drawings::time_zone);
  ASSERT_TRUE(calendar.has_value());
  const Truth truth = nominal_truth();
  WeatherGenerator weather(hot_humid_climate(drawings::place), sys_days{2021y / January / 1},
                           stream_of(3, Stream::weather));
  Building building(truth, 3);
  int hours = 0;
  int unmet = 0;
  for (auto now = metering::Instant{sys_days{2021y / January / 1}};
       now < sys_days{2022y / January / 1}; now += kStep) {
    const metering::LocalTime local = calendar->local_time(now);
    building.advance(weather.advance(), local);
    const bool working = day_kind(local.date) == DayKind::workday && local.minute_of_day >= 540 &&
                         local.minute_of_day < 1020;
    if (!working || now < sys_days{2021y / January / 20}) continue;
    for (std::size_t zone = 0; zone < drawings::zones; ++zone) {
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
  const auto recording = record(nominal_truth(), {2024, 1}, 1);
  ASSERT_TRUE(recording.has_value());
  EXPECT_EQ(metering::to_string(recording->begin), "2024-01-01T05:00:00Z");
  EXPECT_EQ(recording->power.size(), 366u * 96u);
  EXPECT_EQ(recording->weather.size(), recording->power.size());
  for (const UtilityPower& power : recording->power) {
    ASSERT_TRUE(std::isfinite(power.electricity_kW) && power.electricity_kW > 0.0);
    ASSERT_TRUE(std::isfinite(power.chilled_water_kW) && power.chilled_water_kW > 0.0);
    ASSERT_TRUE(std::isfinite(power.steam_kW) && power.steam_kW > 0.0);
  }
}

}  // namespace
}  // namespace recald::simulators
