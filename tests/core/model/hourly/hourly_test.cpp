#include "core/model/hourly/hourly.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/model/epc/epc.hpp"
#include "core/model/hourly/air_handlers.hpp"
#include "core/weather/psychrometrics.hpp"
#include "tests/support/allocations.hpp"
#include "tests/support/sample_building.hpp"

namespace recald::model::hourly::hourly_test {
namespace {

using testing::sample_building;
using testing::sample_drivers;

using Alterations = std::span<const Alteration* const>;

std::vector<MeterMap> meters() {
  return {*default_meter_map(metering::Utility::electricity),
          *default_meter_map(metering::Utility::chilled_water),
          *default_meter_map(metering::Utility::steam)};
}

Eigen::ArrayXXd power_of(Hourly& hourly, const Building& building, Alterations alterations = {}) {
  Eigen::ArrayXXd power_kW(hourly.step_count(), 3);
  hourly.run(building, alterations, meters(), power_kW);
  return power_kW;
}

std::vector<EndUseEnergy> end_uses_of(Hourly& hourly, const Building& building,
                                      Alterations alterations = {}) {
  std::vector<EndUseEnergy> months(hourly.drivers().months.size());
  hourly.run_end_uses(building, alterations, months);
  return months;
}

Hourly make_hourly(int months, int steps_per_hour = 1) {
  return Hourly{std::make_shared<const Drivers>(sample_drivers(sample_building(), months)),
                {.steps_per_hour = steps_per_hour}};
}

double heat_kWh(const EndUseEnergy& e) {
  return e[EndUse::zone_heating] + e[EndUse::reheat] + e[EndUse::preheat];
}

TEST(Hourly, PlantThatIsOffUsesNothing) {
  Building building = sample_building();
  building.seasons = {{.first = std::chrono::June / 1,
                       .last = std::chrono::August / 31,
                       .occupied_fraction = {},
                       .heating = false},
                      {.first = std::chrono::December / 1,
                       .last = std::chrono::February / 15,
                       .occupied_fraction = {},
                       .cooling = false}};
  Hourly on = make_hourly(12);
  Hourly off{std::make_shared<const Drivers>(sample_drivers(building, 12)), {.steps_per_hour = 1}};
  const auto with = end_uses_of(on, sample_building());
  const auto without = end_uses_of(off, building);
  const auto cold_kWh = [](const EndUseEnergy& e) {
    return e[EndUse::sensible_cooling] + e[EndUse::latent_cooling];
  };
  for (std::size_t month = 5; month <= 7; ++month) {
    EXPECT_GT(heat_kWh(with[month]), 0.0);
    EXPECT_EQ(heat_kWh(without[month]), 0.0);
    EXPECT_GT(without[month][EndUse::hot_water], 0.0);
    // Rooms that nobody reheats need less cold.
    EXPECT_LT(cold_kWh(without[month]), cold_kWh(with[month]));
  }
  EXPECT_GT(cold_kWh(with[0]), 0.0);
  EXPECT_EQ(cold_kWh(without[0]), 0.0);
  EXPECT_EQ(cold_kWh(without[11]), 0.0);
  EXPECT_DOUBLE_EQ(heat_kWh(without[3]), heat_kWh(with[3]));
}

/// An alteration of one hook, given as a function.
struct Operating final : Alteration {
  explicit Operating(std::function<void(const DriverHour&, StepOperation&)> change)
      : change_(std::move(change)) {}
  void operate(const DriverHour& hour, StepOperation& operation) const override {
    change_(hour, operation);
  }
  std::function<void(const DriverHour&, StepOperation&)> change_;
};

Eigen::ArrayXXd with_operation(Hourly& hourly, const Building& building,
                               std::function<void(const DriverHour&, StepOperation&)> change) {
  const Operating operating{std::move(change)};
  const Alteration* const list[] = {&operating};
  return power_of(hourly, building, list);
}

/// Passes through all hooks and changes nothing that counts.
struct Neutral final : Alteration {
  void rebuild(Building& building) const override { building.heat_capacity_J_m2K *= 1.0; }
  void operate(const DriverHour&, StepOperation& operation) const override {
    operation.infiltration_factor *= 1.0;
    operation.zone_gain_W += 0.0;
  }
  void supply(const Building&, const DriverHour&, const StepOperation&,
              StepLoads& loads) const override {
    loads.cooling_cost_factor *= 1.0;
  }
  void record(std::span<const DriverHour>, int, std::span<double> power_kW) const override {
    for (double& power : power_kW) power *= 1.0;
  }
};

TEST(Hourly, NeutralAlterationsChangeNoBit) {
  for (const int steps : {1, 4}) {
    Hourly hourly = make_hourly(3, steps);
    const Neutral neutral;
    const Alteration* const list[] = {&neutral, &neutral};
    const Eigen::ArrayXXd plain = power_of(hourly, sample_building());
    EXPECT_TRUE((plain == power_of(hourly, sample_building(), list)).all());
    EXPECT_TRUE((plain == power_of(hourly, sample_building())).all()) << "a run leaves traces";
  }
}

TEST(Hourly, AnAlterationWithADateLeavesThePastAlone) {
  Hourly hourly = make_hourly(3);
  const Building building = sample_building();
  const int date = 50;
  const Eigen::ArrayXXd plain = power_of(hourly, building);
  const Eigen::ArrayXXd changed =
      with_operation(hourly, building, [&](const DriverHour& hour, StepOperation& operation) {
        if (hour.day_index >= date) operation.heating_unoccupied_C = 21.0;
      });
  const auto& hours = hourly.drivers().hours;
  Eigen::Index first = 0;
  while (hours[static_cast<std::size_t>(first)].day_index < date) ++first;
  EXPECT_TRUE((plain.topRows(first) == changed.topRows(first)).all());
  EXPECT_GT((changed - plain).bottomRows(plain.rows() - first).col(2).sum(), 100.0);
}

TEST(Hourly, EveryHookActs) {
  struct All final : Alteration {
    void rebuild(Building& building) const override { building.use.exterior_kW += 1.0; }
    void operate(const DriverHour&, StepOperation& o) const override { o.exterior_W += 2e3; }
    void supply(const Building&, const DriverHour&, const StepOperation&,
                StepLoads& loads) const override {
      loads.exterior_W += 4e3;
    }
    void record(std::span<const DriverHour>, int meter, std::span<double> power_kW) const override {
      if (meter != 0) return;
      for (double& power : power_kW) power += 8.0;
    }
  };
  Hourly hourly = make_hourly(1);
  const All all;
  const Alteration* const list[] = {&all};
  const Eigen::ArrayXXd change =
      power_of(hourly, sample_building(), list) - power_of(hourly, sample_building());
  EXPECT_NEAR(change.col(0).minCoeff(), 14.0, 1e-9);  // by day lamps outdoors are off
  EXPECT_NEAR(change.col(0).maxCoeff(), 15.0, 1e-9);
  EXPECT_EQ(change.rightCols(2).abs().maxCoeff(), 0.0);
}

TEST(Hourly, AgreesWithTheEpcOverTwoYears) {
  const Building building = sample_building();
  const auto drivers = std::make_shared<const Drivers>(sample_drivers(building, 24));
  Hourly hourly{drivers};
  const auto months = end_uses_of(hourly, building);
  epc::Epc epc{std::make_shared<const epc::ClimateClasses>(
      epc::make_climate_classes(*drivers, epc::kClassesPerState))};
  std::vector<EndUseEnergy> expected(24);
  epc.evaluate(building, expected);
  const auto mean = [](const std::vector<EndUseEnergy>& all, auto value) {
    double sum = 0.0;
    for (const EndUseEnergy& month : all) sum += value(month);
    return sum / 24.0;
  };
  const auto compare = [&](const char* what, auto value, double tolerance) {
    EXPECT_NEAR(mean(months, value) / mean(expected, value), 1.0, tolerance) << what;
  };
  // Warm water is drawn by the days of the week, of which a year has not quite as many.
  compare(
      "hot water", [](const EndUseEnergy& e) { return e[EndUse::hot_water]; }, 2e-3);
  for (const EndUse use : {EndUse::lighting, EndUse::plugs}) {
    compare(
        kEndUseNames[static_cast<std::size_t>(use)].data(),
        [use](const EndUseEnergy& e) { return e[use]; }, 1e-6);
  }
  for (const EndUse use : {EndUse::fans, EndUse::pumps, EndUse::sensible_cooling,
                           EndUse::latent_cooling, EndUse::reheat, EndUse::preheat}) {
    compare(
        kEndUseNames[static_cast<std::size_t>(use)].data(),
        [use](const EndUseEnergy& e) { return e[use]; }, 0.10);
  }
  compare("heat", heat_kWh, 0.10);
}

TEST(Hourly, PowerSumsToTheEndUses) {
  Hourly hourly = make_hourly(2, 4);
  const Eigen::ArrayXXd power_kW = power_of(hourly, sample_building());
  const auto months = end_uses_of(hourly, sample_building());
  const auto maps = meters();
  for (std::size_t m = 0; m < maps.size(); ++m) {
    const double expected = maps[m].sum_kWh(months[0]) + maps[m].sum_kWh(months[1]);
    EXPECT_NEAR(power_kW.col(static_cast<Eigen::Index>(m)).sum() / 4.0, expected, 1e-6 * expected);
  }
}

TEST(Hourly, QuarterHoursGiveTheSameDays) {
  Hourly hourly = make_hourly(12);
  Hourly quarterly = make_hourly(12, 4);
  const Eigen::ArrayXXd coarse = power_of(hourly, sample_building());
  const Eigen::ArrayXXd fine = power_of(quarterly, sample_building());
  for (Eigen::Index m = 0; m < 3; ++m) {
    const double mean_kWh = 24.0 * coarse.col(m).mean();
    for (Eigen::Index hour = 0; hour + 24 <= coarse.rows(); hour += 24) {
      const double day_kWh = coarse.col(m).segment(hour, 24).sum();
      const double fine_kWh = fine.col(m).segment(4 * hour, 96).sum() / 4.0;
      ASSERT_NEAR(fine_kWh, day_kWh, 0.02 * std::max(day_kWh, mean_kWh))
          << "meter " << m << ", day " << hour / 24;
    }
  }
}

TEST(Hourly, InsulationNeverRaisesWinterHeat) {
  Hourly hourly = make_hourly(1);
  double before_kWh = std::numeric_limits<double>::infinity();
  for (const double factor : {2.0, 1.5, 1.0, 0.7, 0.4, 0.1}) {
    Building building = sample_building();
    for (Surface& s : building.surfaces) s.u_W_m2K *= factor;
    const double kWh = heat_kWh(end_uses_of(hourly, building)[0]);
    EXPECT_LT(kWh, before_kWh) << factor;
    before_kWh = kWh;
  }
}

// Between the middles of two hours the dry bulb goes straight: quarters lie at -3/8, -1/8, 1/8,
// 3/8.
TEST(Hourly, QuarterHoursMeetWeatherBetweenTheHours) {
  Hourly hourly = make_hourly(1, 4);
  const auto& hours = hourly.drivers().hours;
  std::vector<double> met_C;
  with_operation(hourly, sample_building(), [&](const DriverHour& hour, StepOperation& operation) {
    if (&hour == &hours[100]) met_C.push_back(operation.dry_bulb_C);
  });
  ASSERT_EQ(met_C.size(), 8u);  // in the warm-up and in the run
  const double here_C = hours[100].dry_bulb_C;
  const double before_C = hours[99].dry_bulb_C;
  const double after_C = hours[101].dry_bulb_C;
  EXPECT_NEAR(met_C[4], here_C + 0.375 * (before_C - here_C), 1e-12);
  EXPECT_NEAR(met_C[5], here_C + 0.125 * (before_C - here_C), 1e-12);
  EXPECT_NEAR(met_C[6], here_C + 0.125 * (after_C - here_C), 1e-12);
  EXPECT_NEAR(met_C[7], here_C + 0.375 * (after_C - here_C), 1e-12);
}

TEST(Hourly, AJumpInTimeStartsAfresh) {
  const Building building = sample_building();
  const auto calendar = *metering::LocalCalendar::open("America/New_York");
  const auto begin = std::chrono::sys_days{std::chrono::year{2020} / 12 / 31};
  const auto weather = testing::sample_weather(begin, 24 * 735);
  const auto year = testing::months_of_2021_22(12);
  const auto hourly_of = [&](const std::vector<metering::Month>& months) {
    return Hourly{std::make_shared<const Drivers>(
                      *make_drivers(months, calendar, {}, building, testing::sample_loads(),
                                    testing::sample_location(), weather)),
                  {.steps_per_hour = 4}};
  };
  Hourly both = hourly_of({year[0], year[6]});
  Hourly january = hourly_of({year[0]});
  Hourly july = hourly_of({year[6]});
  const Eigen::ArrayXXd first = power_of(january, building);
  const Eigen::ArrayXXd second = power_of(july, building);
  const Eigen::ArrayXXd all = power_of(both, building);
  EXPECT_TRUE((all.topRows(first.rows()) == first).all());
  EXPECT_TRUE((all.bottomRows(second.rows()) == second).all());
}

TEST(Hourly, BuildingsWithoutGainsOrAirStayFinite) {
  Building building = sample_building();
  building.use = {};
  building.leakage_cm2_m2 = 0.0;
  for (Surface& s : building.surfaces) s.shgc = s.solar_absorptance = 0.0;
  Hourly hourly = make_hourly(2);
  EXPECT_TRUE(power_of(hourly, building).isFinite().all());
  building.air.reset();
  EXPECT_TRUE(power_of(hourly, building).isFinite().all());
  building.surfaces.clear();
  EXPECT_TRUE(power_of(hourly, building).isFinite().all());
}

TEST(Hourly, PartlyServedRoomsLieBetweenAndBeginWithoutAJump) {
  Hourly hourly = make_hourly(2);
  for (const double always : {0.0, 0.4}) {
    Building building = sample_building();
    building.air->outdoor_air_unoccupied_fraction = always;
    const auto night = [&](double share) {
      return with_operation(hourly, building,
                            [share](const DriverHour& hour, StepOperation& o) {
                              if (!hour.occupied) o.daytime_share = share;
                            })
          .colwise()
          .sum()
          .eval();
    };
    const Eigen::ArrayXXd none = night(0.0);
    const Eigen::ArrayXXd half = night(0.5);
    const Eigen::ArrayXXd whole = night(1.0);
    EXPECT_TRUE((none < half).all() && (half < whole).all()) << always;
    EXPECT_LT(((night(1e-6) - none) / none).abs().maxCoeff(), 1e-4) << always;
  }
  // Served round the clock by its own description, or by the day that never ends.
  Building always = sample_building();
  always.air->outdoor_air_unoccupied_fraction = 1.0;
  const Eigen::ArrayXXd endless =
      with_operation(hourly, sample_building(),
                     [](const DriverHour&, StepOperation& o) { o.daytime_share = 1.0; });
  EXPECT_LT((power_of(hourly, always) - endless).abs().maxCoeff(), 1e-9);
}

TEST(Hourly, AnEconomiserSavesCoolingAndItsShareScalesTheSaving) {
  Hourly hourly = make_hourly(6);
  Building building = sample_building();
  const double without_kWh = power_of(hourly, building).col(1).sum();
  building.air->economiser_lockout_C = 18.0;
  const double with_kWh = power_of(hourly, building).col(1).sum();
  EXPECT_LT(with_kWh, 0.97 * without_kWh);
  const double broken_kWh =
      with_operation(hourly, building,
                     [](const DriverHour&, StepOperation& o) { o.economiser_share = 0.0; })
          .col(1)
          .sum();
  EXPECT_NEAR(broken_kWh, without_kWh, 1e-9 * without_kWh);
}

TEST(Hourly, AnOwnChillerPaysByElectricity) {
  Hourly hourly = make_hourly(8);
  Building building = sample_building();
  const Eigen::ArrayXXd district = power_of(hourly, building);
  building.chiller_cop = 4.0;
  const Eigen::ArrayXXd own = power_of(hourly, building);
  EXPECT_LT((own.col(0) - district.col(0) - district.col(1) / 4.0).abs().maxCoeff(), 1e-9);
}

TEST(Hourly, ACoolingPlantThatRunsIdlesWhateverItsLoad) {
  Hourly hourly = make_hourly(8);
  Building building = sample_building();
  building.chiller_cop = 4.0;
  const Eigen::ArrayXXd without = power_of(hourly, building);
  building.cooling_idle_kW = 30.0;
  const Eigen::ArrayXXd with = power_of(hourly, building);
  double fewest_kW = 1e9;
  double most_kW = 0.0;
  for (Eigen::Index row = 0; row < with.rows(); ++row) {
    const double idle_kW = with(row, 0) - without(row, 0);
    // A tenth of its idle power's worth of cooling keeps it on.
    ASSERT_NEAR(idle_kW, std::min(30.0, 10.0 * with(row, 1) / 4.0), 1e-9) << row;
    fewest_kW = std::min(fewest_kW, idle_kW);
    most_kW = std::max(most_kW, idle_kW);
  }
  EXPECT_LT(fewest_kW, 1.0);
  EXPECT_NEAR(most_kW, 30.0, 1e-9);
  EXPECT_TRUE((with.rightCols(2) == without.rightCols(2)).all());
  building.chiller_cop.reset();  // Whoever sells the cooling pays for it.
  const Eigen::ArrayXXd district = power_of(hourly, building);
  building.cooling_idle_kW = 0.0;
  EXPECT_TRUE((district == power_of(hourly, building)).all());
}

TEST(Hourly, AnOwnChillerPaysForEachKelvinFromChilledWaterToWetBulb) {
  Hourly hourly = make_hourly(8);
  const Drivers& drivers = hourly.drivers();
  for (const double warmer_K : {0.0, 2.0}) {
    SCOPED_TRACE(warmer_K);
    Building building = sample_building();
    building.chiller_lift_per_K = 0.03;
    building.chilled_water_C = kRatedChilledWater_C + warmer_K;
    const Eigen::ArrayXXd district = power_of(hourly, building);
    building.chiller_cop = 4.0;
    const Eigen::ArrayXXd own = power_of(hourly, building);
    for (std::size_t i = 0; i < drivers.hours.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const double wet_C = weather::wet_bulb_C(
          drivers.hours[i].dry_bulb_C, drivers.hours[i].humidity_ratio, drivers.pressure_Pa);
      const double cost = std::max(1.0 + 0.03 * (wet_C - 22.0 - warmer_K), 0.4);
      ASSERT_NEAR(own(row, 0) - district(row, 0), cost * district(row, 1) / 4.0, 1e-9) << i;
    }
    EXPECT_TRUE((own.rightCols(2) == district.rightCols(2)).all());
  }
}

TEST(Hourly, NightFansRunWhileRoomsAreHeatedAndOnlyThen) {
  Hourly hourly = make_hourly(8);
  Building building = sample_building();
  building.air->outdoor_air_unoccupied_fraction = 0.0;
  const Eigen::ArrayXXd plain = power_of(hourly, building);
  building.air->night_fan_share = 0.5;
  const Eigen::ArrayXXd fanned = power_of(hourly, building);
  const auto& hours = hourly.drivers().hours;
  double winter_kW = 0.0;
  for (std::size_t i = 0; i < hours.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double more_kW = fanned(row, 0) - plain(row, 0);
    if (hours[i].occupied || hours[i].month == 6) {
      ASSERT_EQ(more_kW, 0.0) << i;
    } else {
      winter_kW = std::max(winter_kW, more_kW);
    }
  }
  EXPECT_NEAR(winter_kW, 0.5 * 35.0, 1e-9);  // a cold night: the whole hour
  EXPECT_TRUE((fanned.rightCols(2) == plain.rightCols(2)).all());
}

// Pressure in the ducts is kept up however little air flows.
TEST(Hourly, FansKeepAShareOfTheirPower) {
  Hourly hourly = make_hourly(12);
  Building building = sample_building();
  const Eigen::ArrayXXd plain = power_of(hourly, building);
  building.air->fan_idle_share = 0.2;
  const Eigen::ArrayXXd idle = power_of(hourly, building);
  const auto& hours = hourly.drivers().hours;
  const double least_share =
      building.air->supply_flow_min_m3_s / building.air->supply_flow_design_m3_s;
  const double most_kW = 0.2 * building.air->fan_design_kW;
  double largest_kW = 0.0;
  for (std::size_t i = 0; i < hours.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double more_kW = idle(row, 0) - plain(row, 0);
    ASSERT_GE(more_kW, -1e-9) << i;
    largest_kW = std::max(largest_kW, more_kW);
  }
  EXPECT_LT(largest_kW, most_kW);
  EXPECT_GT(largest_kW, most_kW * (1.0 - least_share));
}

TEST(Hourly, IdleHandlersThatLeakCostHeat) {
  Hourly hourly = make_hourly(1);
  Building building = sample_building();
  const double tight_kWh = power_of(hourly, building).col(2).sum();
  const double leaky_kWh = with_operation(hourly, building,
                                          [](const DriverHour&, StepOperation& o) {
                                            o.idle_outdoor_air_m3_s = 0.2 * o.outdoor_air_m3_s;
                                          })
                               .col(2)
                               .sum();
  EXPECT_GT(leaky_kWh, 1.02 * tight_kWh);
}

// Eigen's arrays in the model have fixed sizes, so operator new sees every allocation.
TEST(Hourly, ASecondRunDoesNotAllocate) {
  Hourly hourly = make_hourly(2);
  const Building building = sample_building();
  const auto maps = meters();
  Eigen::ArrayXXd power_kW(hourly.step_count(), 3);
  const Neutral neutral;
  const Alteration* const list[] = {&neutral};
  hourly.run(building, list, maps, power_kW);
  const long before = testing::allocation_count();
  hourly.run(building, list, maps, power_kW);
  EXPECT_EQ(testing::allocation_count(), before);
}

Building with_room_units() {
  Building building = sample_building();
  building.air->has_reheat_boxes = false;
  return building;
}

TEST(RoomUnits, HeatOrCoolButNeverReheat) {
  Hourly hourly = make_hourly(12);
  const auto boxes = end_uses_of(hourly, sample_building());
  const auto units = end_uses_of(hourly, with_room_units());
  for (std::size_t month = 0; month < 12; ++month) {
    EXPECT_EQ(units[month][EndUse::reheat] + units[month][EndUse::preheat], 0.0) << month;
    EXPECT_GT(boxes[month][EndUse::reheat], 0.0) << month;
  }
  EXPECT_GT(units[0][EndUse::zone_heating], 0.0);
  EXPECT_GT(units[6][EndUse::sensible_cooling], 0.0);
  EXPECT_LT(heat_kWh(units[6]), 0.1 * heat_kWh(boxes[6]));
}

TEST(RoomUnits, FansRunAtOneSpeedByScheduleAndOnCallAtNight) {
  Hourly hourly = make_hourly(2);
  Building still = with_room_units();
  still.air->outdoor_air_unoccupied_fraction = 0.0;
  still.air->pump_design_kW = 0.0;
  const Eigen::ArrayXXd fanned = power_of(hourly, still);
  still.air->fan_design_kW = 0.0;
  const Eigen::ArrayXXd none = power_of(hourly, still);
  for (Eigen::Index i = 0; i < fanned.rows(); ++i) {
    const double fans_kW = fanned(i, 0) - none(i, 0);
    if (hourly.drivers().hours[static_cast<std::size_t>(i)].occupied) {
      ASSERT_NEAR(fans_kW, 35.0, 1e-9) << i;
    } else {
      ASSERT_LT(fans_kW, 35.0) << i;
    }
  }
  EXPECT_LT(fanned.col(2).sum(), none.col(2).sum()) << "their heat stays in the rooms";
}

TEST(RoomUnits, OutdoorAirMeetsTheRoomsAndRecoverySparesHeat) {
  Hourly hourly = make_hourly(2);
  Building building = with_room_units();
  const double plain_kWh = power_of(hourly, building).col(2).sum();
  building.air->heat_recovery = 0.5;
  const double recovered_kWh = power_of(hourly, building).col(2).sum();
  building.air->heat_recovery = 0.0;
  building.air->outdoor_air_m3_s *= 0.5;
  EXPECT_LT(recovered_kWh, plain_kWh);
  EXPECT_NEAR(power_of(hourly, building).col(2).sum(), recovered_kWh, 1e-9 * recovered_kWh);
}

TEST(RoomUnits, AnEconomiserSavesCoolingAndItsShareScalesTheSaving) {
  Hourly hourly = make_hourly(6);
  Building building = with_room_units();
  const double without_kWh = power_of(hourly, building).col(1).sum();
  building.air->economiser_lockout_C = 18.0;
  const auto at_share = [&](double share) {
    return with_operation(
               hourly, building,
               [share](const DriverHour&, StepOperation& o) { o.economiser_share = share; })
        .col(1)
        .sum();
  };
  EXPECT_NEAR(at_share(0.0), without_kWh, 1e-9 * without_kWh);
  EXPECT_LT(at_share(1.0), at_share(0.1));
  EXPECT_LT(at_share(0.1), 0.99 * without_kWh);
}

// 2 m3/s of outdoor air, 50 kW of cooling over 11 K, 1 kW of people's moisture. With
// h_fg / c_p = 2487.6 K the outdoor air carries 5.970 MW per unit of humidity ratio and the coils
// 11.307 MW, so 20.19 kW condense.
TEST(RoomUnits, WorkedHour) {
  const AirSystem air{.has_reheat_boxes = false,
                      .outdoor_air_m3_s = 2.0,
                      .supply_flow_design_m3_s = 10.0,
                      .fan_design_kW = 4.0,
                      .pump_design_kW = 3.0};
  ZoneTotals zones;
  zones.cooling_W = 50e3;
  StepOperation operation{};
  operation.dry_bulb_C = 30.0;
  operation.humidity_ratio = 0.014;
  operation.outdoor_air_m3_s = 2.0;
  operation.economiser_lockout_C = -100.0;
  operation.coil_humidity_ratio = 0.009;
  operation.latent_share = 1.0;
  StepLoads loads{};
  add_room_units(air, 11.0, 1200.0, 1.0, zones, 1000.0, operation, loads);
  EXPECT_NEAR(loads.latent_cooling_W, 20190.3, 1.0);
  EXPECT_EQ(loads.sensible_cooling_W, 50e3);
  EXPECT_EQ(loads.fans_W, 4000.0);
  EXPECT_NEAR(loads.pumps_W, 3000.0 * 50e3 / (1200.0 * 10.0 * 11.0), 1e-9);
  zones.cooling_W = 0.0;
  zones.zone_heating_W = 66e3;
  add_room_units(air, 11.0, 1200.0, 0.0, zones, 0.0, operation, loads = {});
  EXPECT_EQ(loads.fans_W, 2000.0) << "called for half the design load";
  EXPECT_EQ(loads.latent_cooling_W, 0.0);
}

TEST(RoomUnits, PumpsKnowThatHeatingGoesOnWhereCoolingIsOff) {
  Building building = with_room_units();
  const auto pumps_kWh = [](const Building& of) {
    Hourly hourly{std::make_shared<const Drivers>(sample_drivers(of, 2)), {.steps_per_hour = 1}};
    return end_uses_of(hourly, of)[0][EndUse::pumps];
  };
  const double with_kWh = pumps_kWh(building);
  building.seasons = {{.first = std::chrono::December / 1,
                       .last = std::chrono::February / 28,
                       .occupied_fraction = {},
                       .cooling = false}};
  EXPECT_NEAR(pumps_kWh(building), with_kWh, 0.3 * with_kWh);
}

TEST(RoomUnits, CoilsDryWhatPassesThroughThem) {
  Hourly hourly = make_hourly(8);
  const auto units = end_uses_of(hourly, with_room_units());
  Building empty = with_room_units();
  empty.use.latent_W_person = 0.0;
  const auto no_people = end_uses_of(hourly, empty);
  EXPECT_GT(units[6][EndUse::latent_cooling], no_people[6][EndUse::latent_cooling]);
  EXPECT_EQ(no_people[0][EndUse::latent_cooling], 0.0) << "dry winter air";
  Building warm = with_room_units();
  warm.set_points.cooling_occupied_C = warm.set_points.cooling_unoccupied_C = 60.0;
  const auto uncooled = end_uses_of(hourly, warm);
  EXPECT_EQ(uncooled[6][EndUse::sensible_cooling] + uncooled[6][EndUse::latent_cooling], 0.0);
}

}  // namespace
}  // namespace recald::model::hourly::hourly_test
