/// What hidden changes do to a building's year, without EnergyPlus.
#include "simulators/energyplus/changes/hidden_change.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "simulators/energyplus/model_edits.hpp"
#include "simulators/energyplus/small_office.hpp"
#include "simulators/energyplus/true_building.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::simulators::energyplus::hidden_change_test {
namespace {

using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using std::chrono::sys_days;
using ::testing::HasSubstr;

constexpr int kYear = 2021;  // It begins on a Friday.
constexpr std::size_t kMonday = 10;
constexpr std::size_t kSaturday = 8;
constexpr std::size_t kSunday = 9;

YearAround year_around() {
  YearAround around;
  around.year = kYear;
  around.holidays = {metering::Day{std::chrono::year{kYear} / 1 / 1}};
  around.floor_m2 = 384.0;
  const std::size_t hours = days_of(kYear).size() * 24;
  for (std::size_t hour = 0; hour < hours; ++hour) {
    WeatherHour at{};
    at.at_end.air = {hour < hours / 2 ? 0.0 : 25.0, 0.004};
    around.hours.push_back(at);
  }
  return around;
}

/// 1 from 8 to 18 h on working days, else 0.
Quarters working_hours(const std::vector<metering::Day>& days, double within, double without) {
  Quarters quarters;
  for (const metering::Day day : days) {
    const unsigned weekday = std::chrono::weekday{sys_days{day}}.iso_encoding();
    for (std::size_t quarter = 0; quarter < kQuartersPerDay; ++quarter) {
      quarters.push_back(weekday < 6 && quarter >= 32 && quarter < 72 ? within : without);
    }
  }
  return quarters;
}

/// The small office with fans that stop and rooms that are set back.
class AYear : public ::testing::Test {
 protected:
  static BuildingYear building(const YearAround& around) {
    Json model = small_office_model({});
    const auto days = days_of(kYear);
    model["Fan:OnOff"]["Fan"] = {{"availability_schedule_name", "Fans"}};
    model["AvailabilityManager:Scheduled"]["Manager"] = {{"schedule_name", "Fans"}};
    model["DesignSpecification:OutdoorAir"]["Outdoor air"]["outdoor_air_schedule_name"] = "Fans";
    ScheduleYear schedules;
    schedules["FANS"] = working_hours(days, 1.0, 0.0);
    schedules["HEATING SET-POINT"] = working_hours(days, 21.0, 17.0);
    schedules["COOLING SET-POINT"] = working_hours(days, 24.0, 29.0);
    schedules["OFFICE PRESENCE"] = working_hours(days, 0.8, 0.0);
    schedules["OFFICE LIGHTS ON"] = working_hours(days, 0.9, 0.1);
    schedules["OFFICE EQUIPMENT ON"] = working_hours(days, 0.9, 0.3);
    return {std::move(model), std::move(schedules), around};
  }
  static Quarters of_day(const BuildingYear& year, const std::string& name, std::size_t day) {
    const auto first =
        year.schedule(name).begin() + static_cast<std::ptrdiff_t>(day * kQuartersPerDay);
    return {first, first + kQuartersPerDay};
  }
  static double hours_of(const Quarters& day) {
    return 0.25 * std::accumulate(day.begin(), day.end(), 0.0);
  }
  static void apply(BuildingYear& year, const char* id, double strength) {
    hidden_change(id)->apply(year, strength, Rng{1, 1});
  }

  YearAround around_ = year_around();
};

constexpr const char* kFans = "FANS FOR FANS";
constexpr const char* kOutdoorAir = "FANS FOR OUTDOOR AIR";

TEST(HiddenChanges, AreThoseOfTheCatalogueAndMore) {
  std::size_t in_catalogue = 0;
  for (const HiddenChange& change : hidden_changes()) {
    const auto kinds = effect_kinds();
    const auto kind = std::ranges::find(kinds, change.id, &EffectKind::id);
    ASSERT_NE(kind, kinds.end()) << change.id;
    in_catalogue += kind->group != EffectClass::outside_catalogue ? 1 : 0;
    EXPECT_LE(change.least, change.most) << change.id;
  }
  constexpr std::size_t kInMeters = 5;
  EXPECT_GE(in_catalogue + kInMeters, 30u);
  EXPECT_GE(hidden_changes().size() - in_catalogue, 8u);
}

TEST_F(AYear, GivesEachRoleItsOwnSchedule) {
  const BuildingYear year = building(around_);
  EXPECT_THAT(year.names_of(Role::fans), ::testing::ElementsAre(kFans));
  EXPECT_THAT(year.names_of(Role::outdoor_air), ::testing::ElementsAre(kOutdoorAir));
  EXPECT_EQ(year.model()["Fan:OnOff"]["Fan"]["availability_schedule_name"], kFans);
  EXPECT_EQ(year.schedule(kFans), year.schedule(kOutdoorAir));
}

TEST_F(AYear, IsWrittenAsAFileWithAColumnForEachSchedule) {
  const BuildingYear year = building(around_);
  const auto written = year.write("schedules.csv");
  EXPECT_EQ(written.model["People"]["Office people"]["number_of_people_schedule_name"],
            "OFFICE PRESENCE FOR PRESENCE");
  const Json& fans = written.model["Schedule:File"][kFans];
  EXPECT_EQ(fans["minutes_per_item"], 15);
  EXPECT_EQ(fans["number_of_hours_of_data"], 8760);
  EXPECT_EQ(std::ranges::count(written.csv, '\n'), 1 + 365 * 96);
  EXPECT_THAT(written.csv.substr(0, written.csv.find('\n')),
              HasSubstr("FANS FOR FANS,FANS FOR OUTDOOR AIR"));
}

TEST_F(AYear, KnowsConstantsThatEnergyPlusDoesNotTell) {
  Json model = small_office_model({});
  model["Fan:OnOff"]["Fan"] = {{"availability_schedule_name", "Activity"}};
  const BuildingYear year(std::move(model), {}, around_);
  EXPECT_THAT(year.names_of(Role::fans), ::testing::ElementsAre("ACTIVITY FOR FANS"));
  EXPECT_EQ(year.schedule("ACTIVITY FOR FANS").front(), 130.0);
}

TEST_F(AYear, RunsIntoTheEveningOfWorkingDaysAlone) {
  BuildingYear year = building(around_);
  const BuildingYear before = year;
  apply(year, "after_hours", 4.0);
  for (std::size_t day = 0; day < 28; ++day) {
    const double longer_h =
        hours_of(of_day(year, kFans, day)) - hours_of(of_day(before, kFans, day));
    if (year.kind_of(day) == DayKind::workday) {
      EXPECT_GE(longer_h, 0.0);
      EXPECT_EQ(of_day(year, kFans, day)[31], 0.0) << "not in the morning";
    } else {
      EXPECT_EQ(longer_h, 0.0) << day;
    }
  }
  double mean_h = 0.0;
  int workdays = 0;
  for (std::size_t day = 0; day < 365; ++day) {
    if (year.kind_of(day) != DayKind::workday) continue;
    mean_h += hours_of(of_day(year, kFans, day)) - 10.0;
    ++workdays;
  }
  EXPECT_NEAR(mean_h / workdays, 4.0, 0.5) << "on an average working day";
}

TEST_F(AYear, StartsEarlierTheColderItIs) {
  BuildingYear year = building(around_);
  apply(year, "early_start", 2.0);
  EXPECT_EQ(hours_of(of_day(year, kFans, kMonday + 1)), 10.0 + 3.0) << "at 0 degC";
  EXPECT_EQ(hours_of(of_day(year, kFans, 250)), 10.0) << "at 25 degC";
}

TEST_F(AYear, WorksOnWeekends) {
  BuildingYear year = building(around_);
  apply(year, "weekend_operation", 1.0);
  EXPECT_EQ(of_day(year, kFans, kSaturday), of_day(year, kFans, kMonday));
  EXPECT_EQ(hours_of(of_day(year, kFans, kSunday)), 0.0);
  apply(year, "weekend_operation", 2.0);
  EXPECT_EQ(of_day(year, kFans, kSunday), of_day(year, kFans, kMonday));
  EXPECT_EQ(hours_of(of_day(year, "OFFICE PRESENCE FOR PRESENCE", kSunday)), 0.0) << "nobody comes";
}

TEST_F(AYear, IsNotSetBack) {
  BuildingYear year = building(around_);
  apply(year, "night_setback_missing", 0.5);
  EXPECT_EQ(of_day(year, "HEATING SET-POINT FOR HEATING", kMonday)[0], 19.0);
  EXPECT_EQ(of_day(year, "HEATING SET-POINT FOR HEATING", kMonday)[48], 21.0);
  EXPECT_EQ(of_day(year, "COOLING SET-POINT FOR COOLING", kSunday)[48], 26.5);
}

TEST_F(AYear, LosesItsPeopleBetweenTermsAndKeepsWhatStands) {
  BuildingYear year = building(around_);
  apply(year, "semester_calendar", 1.0);
  const std::size_t july = 190;
  EXPECT_EQ(hours_of(of_day(year, "OFFICE PRESENCE FOR PRESENCE", july)), 0.0);
  EXPECT_NEAR(of_day(year, "OFFICE EQUIPMENT ON FOR EQUIPMENT", july)[48], 0.3, 1e-12);
  EXPECT_EQ(of_day(year, "OFFICE PRESENCE FOR PRESENCE", 101)[48], 0.8) << "in term";
}

TEST_F(AYear, BringsOutdoorAirWithItsPeople) {
  BuildingYear year = building(around_);
  year.change(Role::presence, [](std::size_t, std::size_t quarter, double value) {
    return quarter < 48 ? 0.5 * value : value;
  });
  apply(year, "demand_ventilation", 1.0);
  EXPECT_NEAR(of_day(year, kOutdoorAir, kMonday)[40], 0.5, 1e-12);
  EXPECT_NEAR(of_day(year, kOutdoorAir, kMonday)[60], 1.0, 1e-12);
  EXPECT_EQ(of_day(year, kFans, kMonday)[40], 1.0);
}

TEST_F(AYear, AddsLoadsThatTheModelDidNotHave) {
  BuildingYear year = building(around_);
  apply(year, "server_room", 3.0);
  EXPECT_EQ(year.model()["ElectricEquipment"]["Servers"]["watts_per_floor_area"], 3.0);
  apply(year, "steam_trap_leak", 2.0);
  const Json& leak = year.model()["Exterior:FuelEquipment"]["Pipes and traps"];
  EXPECT_EQ(leak["fuel_use_type"], "DistrictHeatingWater");
  EXPECT_EQ(leak["design_level"], 768.0);
  EXPECT_NE(year.write("s.csv").csv.find("PIPES AND TRAPS"), std::string::npos);
}

TEST_F(AYear, ChangesGlassAndNothingElse) {
  BuildingYear year = building(around_);
  const Json before = year.model();
  apply(year, "solar_gain_change", -0.5);
  const double gain =
      before["WindowMaterial:SimpleGlazingSystem"]["Glazing"]["solar_heat_gain_coefficient"];
  EXPECT_EQ(
      year.model()["WindowMaterial:SimpleGlazingSystem"]["Glazing"]["solar_heat_gain_coefficient"],
      0.5 * gain);
  Json after = year.model();
  after["WindowMaterial:SimpleGlazingSystem"] = before["WindowMaterial:SimpleGlazingSystem"];
  EXPECT_EQ(after, before);
}

TEST_F(AYear, IsImpossibleWhereThereIsNothingToChange) {
  const BuildingYear year = building(around_);
  EXPECT_FALSE(hidden_change("chiller_part_load")->possible(year)) << "no chiller";
  EXPECT_FALSE(hidden_change("economiser_failed")->possible(year)) << "no economiser";
  EXPECT_FALSE(hidden_change("supply_reset_missing")->possible(year)) << "no reset";
  EXPECT_TRUE(hidden_change("after_hours")->possible(year));
  EXPECT_TRUE(hidden_change("steam_trap_leak")->possible(year));
  EXPECT_EQ(hidden_change("scale_fault"), nullptr) << "that is in the meter";
}

TEST_F(AYear, OfTheTruthDiffersFromTheDrawingsAsItsParametersSay) {
  BuildingYear year = building(around_);
  const BuildingYear drawn = year;
  TrueParameters truth = draw_true_parameters(3);
  EXPECT_EQ(truth, draw_true_parameters(3));
  EXPECT_NE(truth, draw_true_parameters(4));
  truth["start_h"] = 0.5;
  truth["stop_h"] = -0.5;
  make_true(year, truth);
  const double drawn_W_m2 = drawn.model()["Lights"]["Office lights"]["watts_per_floor_area"];
  EXPECT_NEAR(year.model()["Lights"]["Office lights"]["watts_per_floor_area"],
              truth["lighting"] * drawn_W_m2, 1e-12);
  EXPECT_NEAR(of_day(year, "COOLING SET-POINT FOR COOLING", kMonday)[48],
              24.0 + truth["cooling_setpoint_K"], 1e-9);
  const Quarters fans = of_day(year, kFans, kMonday);
  EXPECT_EQ(fans[30], 1.0) << "half an hour earlier";
  EXPECT_EQ(fans[29], 0.0);
  EXPECT_EQ(fans[69], 1.0);
  EXPECT_EQ(fans[70], 0.0) << "half an hour sooner";
}

TEST_F(AYear, HasPeopleWhoseDaysDiffer) {
  BuildingYear year = building(around_);
  const TrueParameters truth = draw_true_parameters(3);
  BuildingYear again = year;
  follow_habits(year, truth, 9);
  follow_habits(again, truth, 9);
  EXPECT_EQ(year.schedule("OFFICE PRESENCE FOR PRESENCE"),
            again.schedule("OFFICE PRESENCE FOR PRESENCE"));
  EXPECT_NE(hours_of(of_day(year, "OFFICE PRESENCE FOR PRESENCE", kMonday)),
            hours_of(of_day(year, "OFFICE PRESENCE FOR PRESENCE", kMonday + 1)));
  EXPECT_LE(*std::ranges::max_element(year.schedule("OFFICE LIGHTS ON FOR LIGHTS")), 1.0);
}

TEST(Schedules, AreReadAsEnergyPlusUnderstoodThem) {
  TemporaryFolder folder;
  std::string day = "DaySchedule - Timestep,Day_dy_1,ANY,No,Values:";
  std::string off = "DaySchedule - Timestep,Day_dy_2,ANY,No,Values:";
  for (int i = 0; i < 96; ++i) {
    day += i < 32 ? ",0.00" : ",1.00";
    off += ",0.25";
  }
  write_text(
      folder / "eplusout.eio",
      "! <DaySchedule - Timestep>,Name\n" + day + "\n" + off +
          "\nWeekSchedule - Timestep,W1,Day_dy_2,Day_dy_1,Day_dy_1,Day_dy_1,Day_dy_1,Day_dy_1,"
          "Day_dy_2,Day_dy_2,Day_dy_1,Day_dy_1,Day_dy_1,Day_dy_1\n"
          "WeekSchedule - Timestep,W2,Day_dy_2,Day_dy_2,Day_dy_2,Day_dy_2,Day_dy_2,Day_dy_2,"
          "Day_dy_2,Day_dy_2,Day_dy_1,Day_dy_1,Day_dy_1,Day_dy_1\n"
          "Schedule - Timestep,Fans,ANY,Through Jun 30,W1,Through Dec 31,W2\n");
  const auto read = read_schedules(folder / "eplusout.eio", kYear,
                                   {metering::Day{std::chrono::year{kYear} / 1 / 11}});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  const Quarters& fans = read->at("FANS");
  ASSERT_EQ(fans.size(), 365u * 96u);
  EXPECT_EQ(fans[(kMonday + 1) * 96 + 31], 0.0);
  EXPECT_EQ(fans[(kMonday + 1) * 96 + 32], 1.0);
  EXPECT_EQ(fans[kMonday * 96 + 32], 0.25) << "a holiday";
  EXPECT_EQ(fans[kSunday * 96 + 50], 0.25);
  EXPECT_EQ(fans[200 * 96 + 50], 0.25) << "in July";
  EXPECT_EQ(read_schedules(folder / "nowhere.eio", kYear, {}).error().code, ErrorCode::io_failed);
}

}  // namespace
}  // namespace recald::simulators::energyplus::hidden_change_test
