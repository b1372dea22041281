/// Catalogue entries of schedules, people, outdoor air and the air system.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include "core/diagnosis/effects/support/effect.hpp"
#include "core/model/hourly/hourly.hpp"
#include "tests/support/sample_building.hpp"

namespace recald::diagnosis::effects {
Effect after_hours();
Effect constant_flow_pumps();
Effect constant_speed_fans();
Effect damper_stuck_open();
Effect deep_drying();
Effect demand_ventilation();
Effect early_start();
Effect economiser_changeover();
Effect economiser_failed();
Effect humidifier();
Effect hybrid_work();
Effect missing_holidays();
Effect night_setback_missing();
Effect outdoor_air_amount();
Effect round_the_clock_zone();
Effect semester_calendar();
Effect simultaneous_heating_cooling();
Effect supply_reset_missing();
Effect vacancy();
Effect weekend_operation();
}  // namespace recald::diagnosis::effects

namespace recald::diagnosis::effects_operation_test {
namespace {

using metering::Utility;
using model::DayType;
using model::DriverHour;
using model::hourly::Alteration;
using model::hourly::StepLoads;
using model::hourly::StepOperation;

constexpr std::array kUtilities = {Utility::electricity, Utility::chilled_water, Utility::heating};

/// Fans off at night, so that schedules and idle handlers show; free cooling below 20 °C.
model::Building building_of_office() {
  model::Building building = testing::sample_building();
  building.air->outdoor_air_unoccupied_fraction = 0.0;
  building.air->economiser_lockout_C = 20.0;
  return building;
}

/// The sample office over 2021 with all three meters; runs and facts of it.
class Office {
 public:
  Office() {
    for (const Utility utility : kUtilities) {
      meters_.push_back(*model::default_meter_map(utility));
    }
  }

  [[nodiscard]] SiteFacts facts() const {
    return {building_,
            *drivers_,
            {kUtilities.begin(), kUtilities.end()},
            /*mean_kW=*/{100.0, 200.0, 50.0}};
  }
  [[nodiscard]] const model::Drivers& drivers() const { return *drivers_; }

  [[nodiscard]] std::unique_ptr<Alteration> bind(const Effect& effect,
                                                 std::vector<double> values) const {
    return effect.bind(facts(), values, -1);
  }

  /// Hourly power, kW (hours x meters: electricity, chilled water, heat).
  [[nodiscard]] Eigen::ArrayXXd run(const Alteration* alteration) const {
    model::hourly::Hourly hourly(drivers_);
    Eigen::ArrayXXd power_kW(hourly.step_count(), static_cast<Eigen::Index>(meters_.size()));
    std::vector<const Alteration*> alterations;
    if (alteration != nullptr) alterations.push_back(alteration);
    hourly.run(building_, alterations, meters_, power_kW);
    return power_kW;
  }

  /// Power with the effect over power without, kW.
  [[nodiscard]] Eigen::ArrayXXd change_kW(const Effect& effect, std::vector<double> values) const {
    static const Eigen::ArrayXXd base_kW = run(nullptr);
    return run(bind(effect, std::move(values)).get()) - base_kW;
  }

 private:
  model::Building building_ = building_of_office();
  std::shared_ptr<const model::Drivers> drivers_ =
      std::make_shared<model::Drivers>(testing::sample_drivers(building_, /*months=*/12));
  std::vector<model::MeterMap> meters_;
};

const Office& office() {
  static const Office value;
  return value;
}

/// First hour of the drivers that is this local hour of this day of 2021.
DriverHour hour_of(unsigned month, unsigned day, int local_hour) {
  const metering::Day date = std::chrono::year{2021} / month / day;
  for (const DriverHour& hour : office().drivers().hours) {
    if (hour.date == date && hour.local_hour == local_hour) return hour;
  }
  ADD_FAILURE() << "no such hour";
  return {};
}

/// A step as the drawings have it in this hour.
StepOperation drawn(const DriverHour& hour) {
  return {.dry_bulb_C = hour.dry_bulb_C,
          .humidity_ratio = hour.humidity_ratio,
          .wind_m_s = hour.wind_m_s,
          .solar_share = 1.0,
          .people_share = hour.occupied_fraction,
          .lights_W = hour.lights_W,
          .plugs_W = hour.plugs_W,
          .exterior_W = 3000.0,
          .daytime_share = hour.occupied ? 1.0 : 0.0,
          .cooling_occupied_C = 24.0,
          .cooling_unoccupied_C = 28.0,
          .heating_occupied_C = 21.0,
          .heating_unoccupied_C = 16.0,
          .outdoor_air_m3_s = 6.0,
          .idle_outdoor_air_m3_s = 0.0,
          .outdoor_share_min = 0.0,
          .supply_C = 13.0,
          .least_flow_m3_s = 9.0,
          .economiser_lockout_C = 20.0,
          .economiser_share = 1.0,
          .constant_fan_share = 0.0,
          .coil_humidity_ratio = 0.0089,
          .humidifier_kg_kg = 0.0,
          .latent_share = 1.0,
          .infiltration_factor = 1.0,
          .zone_gain_W = 0.0,
          .ground_C = 16.0};
}

StepOperation operated(const Effect& effect, std::vector<double> values, const DriverHour& hour,
                       StepOperation operation) {
  office().bind(effect, std::move(values))->operate(hour, operation);
  return operation;
}

StepOperation operated(const Effect& effect, std::vector<double> values, const DriverHour& hour) {
  return operated(effect, std::move(values), hour, drawn(hour));
}

StepLoads supplied(const Effect& effect, std::vector<double> values, const DriverHour& hour,
                   StepLoads loads) {
  office()
      .bind(effect, std::move(values))
      ->supply(office().facts().building, hour, drawn(hour), loads);
  return loads;
}

// Monday 4 January 2021, an ordinary week.
const auto night = [] { return hour_of(1, 5, 3); };
const auto morning = [] { return hour_of(1, 5, 10); };

TEST(EffectsOfOperation, NightSetBackMissingMovesNightSetPointsTowardsDay) {
  const StepOperation op = operated(effects::night_setback_missing(), {0.25}, night());
  EXPECT_DOUBLE_EQ(op.heating_unoccupied_C, 16.0 + 0.25 * 5.0);
  EXPECT_DOUBLE_EQ(op.cooling_unoccupied_C, 28.0 - 0.25 * 4.0);
}

TEST(EffectsOfOperation, WeekendOperationRunsEachDayByItself) {
  const Effect effect = effects::weekend_operation();
  EXPECT_EQ(operated(effect, {0.5, 0.2}, hour_of(1, 9, 10)).daytime_share, 0.5);   // Saturday
  EXPECT_EQ(operated(effect, {0.5, 0.2}, hour_of(1, 10, 10)).daytime_share, 0.2);  // Sunday
  EXPECT_EQ(operated(effect, {0.5, 0.2}, hour_of(1, 9, 19)).daytime_share, 0.0);
  EXPECT_EQ(operated(effect, {0.5, 0.2}, morning()).daytime_share, 1.0);
}

TEST(EffectsOfOperation, MissingHolidaysTurnsListedWorkdaysIntoSundays) {
  const Effect effect = effects::missing_holidays();
  // 25 November 2021 was Thanksgiving; workday lights 35 kW, Sunday's 5 kW; plugs 45 and 20.
  const StepOperation op = operated(effect, {0.5, 0.3, 1.0}, hour_of(11, 25, 10));
  EXPECT_EQ(op.daytime_share, 0.7);  // most of the plant goes on
  EXPECT_DOUBLE_EQ(op.people_share, 0.4);
  EXPECT_DOUBLE_EQ(op.lights_W, 20e3);
  EXPECT_DOUBLE_EQ(op.plugs_W, 32.5e3);
  EXPECT_EQ(operated(effect, {0.5, 0.3, 2.0}, hour_of(11, 25, 10)).daytime_share, 1.0);
}

TEST(EffectsOfOperation, MissingHolidaysKnowsTheRulesOfTheDates) {
  struct Case {
    double calendar;
    unsigned month, day;
    bool holiday;
  };
  // 2021: Easter on 4 April, 4 July on a Sunday.
  for (const Case& c : {Case{1.0, 1, 1, true},   Case{1.0, 1, 18, true},  Case{1.0, 5, 31, true},
                        Case{1.0, 7, 5, true},   Case{1.0, 7, 6, false},  Case{1.0, 9, 6, true},
                        Case{1.0, 11, 26, true}, Case{1.0, 4, 5, false},  Case{2.0, 4, 2, true},
                        Case{2.0, 4, 5, true},   Case{2.0, 5, 13, true},  Case{2.0, 5, 24, true},
                        Case{2.0, 7, 5, false},  Case{2.0, 12, 24, true}, Case{3.0, 4, 5, true},
                        Case{3.0, 5, 3, true},   Case{3.0, 5, 31, true},  Case{3.0, 8, 30, true},
                        Case{3.0, 5, 13, false}, Case{3.0, 12, 28, true}}) {
    SCOPED_TRACE(::testing::Message() << c.calendar << ": " << c.month << "/" << c.day);
    const double share =
        operated(effects::missing_holidays(), {1.0, 1.0, c.calendar}, hour_of(c.month, c.day, 10))
            .daytime_share;
    EXPECT_EQ(share, c.holiday ? 0.0 : 1.0);
  }
}

TEST(EffectsOfOperation, AfterHoursCoversPartOfItsLastHour) {
  const Effect effect = effects::after_hours();
  EXPECT_DOUBLE_EQ(operated(effect, {1.75}, hour_of(1, 5, 19)).daytime_share, 1.0);
  EXPECT_DOUBLE_EQ(operated(effect, {1.75}, hour_of(1, 5, 20)).daytime_share, 0.75);
  EXPECT_DOUBLE_EQ(operated(effect, {1.75}, hour_of(1, 5, 21)).daytime_share, 0.0);
  EXPECT_DOUBLE_EQ(operated(effect, {5.5}, hour_of(1, 9, 0)).daytime_share, 0.5);  // from Friday
}

TEST(EffectsOfOperation, EarlyStartGrowsWithCold) {
  DriverHour hour = hour_of(1, 5, 5);  // The plant starts at 7.
  hour.dry_bulb_C = 6.0;
  // 0.3 h + 0.1 h/K · 15 K = 1.8 h: the hour from 5 to 6 is covered by 0.8.
  EXPECT_NEAR(operated(effects::early_start(), {0.3, 0.1}, hour).daytime_share, 0.8, 1e-12);
  hour = hour_of(1, 5, 6);
  hour.dry_bulb_C = 25.0;
  EXPECT_NEAR(operated(effects::early_start(), {0.3, 0.1}, hour).daytime_share, 0.3, 1e-12);
}

TEST(EffectsOfOperation, RoundTheClockZoneServesAShareAtNight) {
  EXPECT_EQ(operated(effects::round_the_clock_zone(), {0.3}, night()).daytime_share, 0.3);
  EXPECT_EQ(operated(effects::round_the_clock_zone(), {0.3}, morning()).daytime_share, 1.0);
}

TEST(EffectsOfOperation, SemesterCalendarActsInBreaksOnly) {
  const Effect effect = effects::semester_calendar();
  // Lights 35 kW of which 5 kW are standby: 35 − 0.8·0.5·30 = 23 kW; plugs 45 − 0.4·25 = 35 kW.
  const StepOperation op = operated(effect, {0.5, 1.0}, hour_of(7, 1, 10));
  EXPECT_DOUBLE_EQ(op.people_share, 0.4);
  EXPECT_DOUBLE_EQ(op.lights_W, 23e3);
  EXPECT_DOUBLE_EQ(op.plugs_W, 35e3);
  EXPECT_EQ(op.daytime_share, 1.0);
  EXPECT_EQ(operated(effect, {0.5, 1.0}, hour_of(5, 20, 10)).people_share, 0.8);
  EXPECT_EQ(operated(effect, {0.5, 2.0}, hour_of(5, 20, 10)).people_share, 0.4);
  EXPECT_EQ(operated(effect, {0.5, 3.0}, hour_of(3, 1, 10)).people_share, 0.4);
}

TEST(EffectsOfOperation, VacancyLeavesStandbyLoads) {
  const StepOperation op = operated(effects::vacancy(), {1.0}, morning());
  EXPECT_EQ(op.people_share, 0.0);
  EXPECT_DOUBLE_EQ(op.lights_W, 35e3 - 0.8 * 30e3);
  EXPECT_EQ(operated(effects::vacancy(), {1.0}, night()).lights_W, 5e3);
  EXPECT_EQ(effects::vacancy().dating, Dating::window);
}

TEST(EffectsOfOperation, HybridWorkKeepsAShareAtHome) {
  double people = 0.0;
  double lights_W = 0.0;
  for (unsigned day = 4; day <= 8; ++day) {
    const StepOperation op =
        operated(effects::hybrid_work(), {0.25, 0.2, 0.1}, hour_of(1, day, 10));
    people += op.people_share;
    lights_W += op.lights_W;
  }
  EXPECT_NEAR(people, 5.0 * 0.8 * 0.75, 1e-12);
  EXPECT_NEAR(lights_W, 5.0 * (35e3 - 0.25 * 0.8 * 30e3), 1e-6);
  const StepOperation monday =
      operated(effects::hybrid_work(), {0.25, 0.2, 0.1}, hour_of(1, 4, 10));
  EXPECT_DOUBLE_EQ(monday.people_share, 0.8 * (1.0 - 0.25 - 1.5 * 0.2 + 0.1));
  EXPECT_EQ(operated(effects::hybrid_work(), {0.8, 0.3, 0.0}, hour_of(1, 4, 10)).people_share, 0.0);
}

TEST(EffectsOfOperation, OutdoorAirEffectsChangeTheirField) {
  const StepOperation stopped = operated(effects::damper_stuck_open(), {0.25, 1.0}, night());
  EXPECT_DOUBLE_EQ(stopped.idle_outdoor_air_m3_s, 1.5);
  EXPECT_EQ(stopped.outdoor_share_min, 0.0);
  const StepOperation running = operated(effects::damper_stuck_open(), {0.25, 0.0}, night());
  EXPECT_EQ(running.idle_outdoor_air_m3_s, 0.0);
  EXPECT_EQ(running.outdoor_share_min, 0.25);
  EXPECT_DOUBLE_EQ(operated(effects::outdoor_air_amount(), {-0.25}, morning()).outdoor_air_m3_s,
                   4.5);
  EXPECT_DOUBLE_EQ(operated(effects::economiser_failed(), {0.75}, morning()).economiser_share,
                   0.25);
  EXPECT_DOUBLE_EQ(
      operated(effects::economiser_changeover(), {-3.0}, morning()).economiser_lockout_C, 17.0);
}

// Absence 0.2 of the people, half of it followed: 6 · (1 − 0.5 · 0.2).
TEST(EffectsOfOperation, DemandVentilationFollowsPeople) {
  EXPECT_DOUBLE_EQ(operated(effects::demand_ventilation(), {0.5}, morning()).outdoor_air_m3_s, 5.4);
}

TEST(EffectsOfOperation, DemandVentilationSparesLaboratories) {
  model::Building building = building_of_office();
  building.air->outdoor_air_unoccupied_fraction = 0.4;
  const SiteFacts facts{building, office().drivers(), {}, {}};
  const auto alteration = effects::demand_ventilation().bind(facts, std::array{0.5}, -1);
  StepOperation by_night = drawn(night());
  StepOperation by_day = drawn(morning());
  alteration->operate(night(), by_night);
  alteration->operate(morning(), by_day);
  EXPECT_EQ(by_night.outdoor_air_m3_s, 6.0);
  EXPECT_DOUBLE_EQ(by_day.outdoor_air_m3_s, 6.0 * (1.0 - 0.5 * 0.2 * 0.6));
}

TEST(EffectsOfOperation, SimultaneousHeatingAndCoolingAddsTheSameToBothBeyondWhatIsWanted) {
  const auto with = [](double zone_heating_W, double reheat_W) {
    return supplied(effects::simultaneous_heating_cooling(), {20.0}, morning(),
                    {.sensible_cooling_W = 1e5,
                     .zone_heating_W = zone_heating_W,
                     .reheat_W = reheat_W,
                     .running_share = 0.5});
  };
  EXPECT_DOUBLE_EQ(with(1e3, 3e3).sensible_cooling_W, 1.06e5);
  EXPECT_DOUBLE_EQ(with(1e3, 3e3).reheat_W, 9e3);
  EXPECT_DOUBLE_EQ(with(0.0, 0.0).reheat_W, 1e4);
  // On a cold day the valve would be open anyway.
  EXPECT_DOUBLE_EQ(with(2e4, 1e3).sensible_cooling_W, 1e5);
  EXPECT_DOUBLE_EQ(with(2e4, 1e3).reheat_W, 1e3);
}

TEST(EffectsOfOperation, SupplyResetMissingCoolsDeeperInMildWeatherUpToItsLimit) {
  StepOperation op = drawn(morning());
  op.dry_bulb_C = 10.0;
  EXPECT_DOUBLE_EQ(operated(effects::supply_reset_missing(), {0.25, 18.0}, morning(), op).supply_C,
                   11.0);
  op.dry_bulb_C = -10.0;
  EXPECT_DOUBLE_EQ(operated(effects::supply_reset_missing(), {0.25, 18.0}, morning(), op).supply_C,
                   8.0);
  op.dry_bulb_C = 18.0;
  EXPECT_EQ(operated(effects::supply_reset_missing(), {0.25, 18.0}, morning(), op).supply_C, 13.0);
}

TEST(EffectsOfOperation, ConstantSpeedFansFillTheRestOfTheFans) {
  StepOperation op = drawn(morning());
  op.constant_fan_share = 0.2;
  EXPECT_DOUBLE_EQ(
      operated(effects::constant_speed_fans(), {0.5}, morning(), op).constant_fan_share, 0.6);
}

TEST(EffectsOfOperation, ConstantFlowPumpsRunInTheirSeason) {
  const Effect effect = effects::constant_flow_pumps();
  const auto pumps_W = [&](double season, unsigned month) {
    return supplied(effect, {4.0, season}, hour_of(month, 5, 3), {.pumps_W = 500.0}).pumps_W;
  };
  EXPECT_EQ(pumps_W(1.0, 1), 4500.0);
  EXPECT_EQ(pumps_W(2.0, 1), 500.0);
  EXPECT_EQ(pumps_W(2.0, 7), 4500.0);
  EXPECT_EQ(pumps_W(3.0, 1), 4500.0);
  EXPECT_EQ(pumps_W(3.0, 7), 500.0);
}

TEST(EffectsOfOperation, DeepDryingStopsAtTheDriestCoil) {
  const Effect effect = effects::deep_drying();
  EXPECT_DOUBLE_EQ(operated(effect, {0.0015}, morning()).coil_humidity_ratio, 0.0074);
  EXPECT_DOUBLE_EQ(operated(effect, {0.0200}, morning()).coil_humidity_ratio, 0.0030);
}

TEST(EffectsOfOperation, HumidifierHoldsItsShareAboveOutdoorAir) {
  const Effect effect = effects::humidifier();
  StepOperation op = drawn(morning());
  op.humidity_ratio = 0.002;
  EXPECT_DOUBLE_EQ(operated(effect, {0.5, 0.006}, morning(), op).humidifier_kg_kg, 0.004);
  op.humidifier_kg_kg = 0.005;  // More is drawn than found.
  EXPECT_DOUBLE_EQ(operated(effect, {0.5, 0.006}, morning(), op).humidifier_kg_kg, 0.005);
  op = drawn(morning());
  op.humidity_ratio = 0.008;
  EXPECT_EQ(operated(effect, {0.5, 0.006}, morning(), op).humidifier_kg_kg, 0.0);
}

TEST(EffectsOfOperation, PriorsScaleWithTheMeters) {
  const auto median = [](const Effect& effect) {
    return effect.parameters(office().facts())[0].prior.quantile(0.5);
  };
  constexpr double kHalfNormalMedian = 0.674490;  // of sd 1
  EXPECT_NEAR(median(effects::simultaneous_heating_cooling()), 20.0 * kHalfNormalMedian, 1e-4);
  EXPECT_NEAR(median(effects::constant_flow_pumps()), 5.0 * kHalfNormalMedian, 1e-4);
}

/// What an effect does to the year's energy of a meter.
enum class Sign { falls, same, rises, any };

struct Direction {
  Effect effect;
  std::vector<double> typical;
  std::vector<double> neutral;
  std::array<Sign, 3> signs;  ///< Electricity, chilled water, heat.
};

std::vector<Direction> directions() {
  using enum Sign;
  using namespace effects;  // NOLINT: twenty entries
  return {
      {night_setback_missing(), {0.5}, {0.0}, {any, rises, rises}},
      {weekend_operation(), {0.5, 0.5}, {0.0, 0.0}, {rises, rises, any}},
      {missing_holidays(), {0.5, 0.5, 1.0}, {0.0, 0.0, 1.0}, {falls, falls, any}},
      {after_hours(), {2.0}, {0.0}, {rises, rises, rises}},
      {early_start(), {1.5, 0.05}, {0.0, 0.0}, {rises, rises, rises}},
      {round_the_clock_zone(), {0.3}, {0.0}, {rises, rises, rises}},
      {semester_calendar(), {0.4, 2.0}, {0.0, 2.0}, {falls, falls, any}} /* less warm water, too */,
      {vacancy(), {0.5}, {0.0}, {falls, falls, any}},
      {hybrid_work(), {0.2, 0.15, 0.05}, {0.0, 0.0, 0.0}, {falls, falls, any}},
      {damper_stuck_open(), {0.3, 1.0}, {0.0, 1.0}, {any, any, rises}},
      {damper_stuck_open(), {0.6, 0.0}, {0.0, 0.0}, {any, any, rises}},
      {outdoor_air_amount(), {0.4}, {0.0}, {any, rises, rises}},
      {economiser_failed(), {1.0}, {0.0}, {same, rises, same}},
      {economiser_changeover(), {-4.0}, {0.0}, {same, rises, same}},
      {demand_ventilation(), {0.8}, {0.0}, {any, falls, falls}},
      {simultaneous_heating_cooling(), {20.0}, {0.0}, {same, rises, rises}},
      {supply_reset_missing(), {0.25, 18.0}, {0.0, 18.0}, {any, rises, rises}},
      {constant_speed_fans(), {0.5}, {0.0}, {rises, rises, any}},
      {constant_flow_pumps(), {5.0, 1.0}, {0.0, 1.0}, {rises, same, same}},
      {deep_drying(), {0.0015}, {0.0}, {same, rises, same}},
      {humidifier(), {0.5, 0.006}, {0.0, 0.006}, {same, same, rises}}};
}

TEST(EffectsOfOperation, MovesTheMetersAsTheCatalogueSays) {
  for (const Direction& d : directions()) {
    const Eigen::Array3d change_kWh =
        office().change_kW(d.effect, d.typical).colwise().sum().transpose();
    for (std::size_t m = 0; m < kUtilities.size(); ++m) {
      SCOPED_TRACE(std::string(d.effect.id) + ", " + std::string(to_string(kUtilities[m])));
      const double change = change_kWh[static_cast<Eigen::Index>(m)];
      switch (d.signs[m]) {
        case Sign::falls:
          EXPECT_LT(change, -100.0);
          break;
        case Sign::same:
          EXPECT_NEAR(change, 0.0, 1e-6);
          break;
        case Sign::rises:
          EXPECT_GT(change, 100.0);
          break;
        case Sign::any:
          break;
      }
    }
  }
}

TEST(EffectsOfOperation, NeutralValuesChangeNoBit) {
  for (const Direction& d : directions()) {
    SCOPED_TRACE(d.effect.id);
    EXPECT_TRUE((office().change_kW(d.effect, d.neutral) == 0.0).all());
    const auto parameters = d.effect.parameters(office().facts());
    ASSERT_EQ(parameters.size(), d.neutral.size());
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      EXPECT_TRUE(std::isnan(parameters[i].neutral) ? !parameters[i].scan.empty()
                                                    : parameters[i].neutral == d.neutral[i]);
      EXPECT_GT(parameters[i].prior.density(d.typical[i]), 0.0);
    }
  }
}

TEST(EffectsOfOperation, SimultaneousHeatingAndCoolingCostsBothMetersTheSame) {
  const Eigen::ArrayXXd change_kW =
      office().change_kW(effects::simultaneous_heating_cooling(), {20.0});
  const model::Building building = building_of_office();
  const double cooling_kWh = change_kW.col(1).sum() * (1.0 - building.cooling_loss_fraction);
  const double heating_kWh =
      change_kW.col(2).sum() * (1.0 - building.heating_loss_fraction) * building.heating_efficiency;
  EXPECT_NEAR(cooling_kWh / heating_kWh, 1.0, 0.03);
}

TEST(EffectsOfOperation, HybridWorkEchoesInChilledWater) {
  const Eigen::ArrayXXd change_kW = office().change_kW(effects::hybrid_work(), {0.0, 0.15, 0.0});
  Eigen::Array2d midweek_kWh = Eigen::Array2d::Zero();
  Eigen::Array2d fringe_kWh = Eigen::Array2d::Zero();
  const auto& hours = office().drivers().hours;
  for (std::size_t i = 0; i < hours.size(); ++i) {
    const Eigen::Array2d both = change_kW.row(static_cast<Eigen::Index>(i)).head(2).transpose();
    if (2 <= hours[i].weekday && hours[i].weekday <= 4) midweek_kWh += both;
    if (hours[i].weekday == 1 || hours[i].weekday == 5) fringe_kWh += both;
  }
  EXPECT_TRUE((midweek_kWh > 100.0).all());
  EXPECT_TRUE((fringe_kWh < -100.0).all());
}

}  // namespace
}  // namespace recald::diagnosis::effects_operation_test
