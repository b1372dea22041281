/// What can be seen of models, truths, habits, weather and readings without EnergyPlus.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "simulators/energyplus/hidden_truth.hpp"
#include "simulators/energyplus/run_readings.hpp"
#include "simulators/energyplus/weather_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::simulators::energyplus::energyplus_files_test {
namespace {

using ::testing::HasSubstr;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(EnergyPlusTruth, DependsOnTheSeedAloneAndChangesTheModel) {
  const auto one = laboratory_truth(3);
  EXPECT_EQ(one.description, laboratory_truth(3).description);
  EXPECT_NE(one.description["parameters"], laboratory_truth(4).description["parameters"]);
  EXPECT_NE(laboratory_model(one.parameters), laboratory_model({}));
  EXPECT_NE(small_office_model(small_office_truth(3).parameters), small_office_model({}));
}

/// "Type/name/field" to a number that the truth has changed as it says.
void expect_targets(const Json& description, const Json& drawings, const Json& truth) {
  for (const auto& [name, quantity] : description["parameters"].items()) {
    SCOPED_TRACE(name);
    for (const std::string target : quantity["targets"]) {
      const auto first = target.find('/');
      const auto last = target.rfind('/');
      const std::string type = target.substr(0, first);
      const std::string field = target.substr(last + 1);
      ASSERT_TRUE(drawings.contains(type)) << target;
      if (field.find('*') != std::string::npos) continue;
      const std::string object = target.substr(first + 1, last - first - 1);
      const auto& objects = drawings[type];
      const bool is_pattern = object.find('*') != std::string::npos;
      ASSERT_TRUE(is_pattern || objects.contains(object)) << target;
      if (is_pattern) continue;
      const double by = quantity["by"];
      const double before = objects[object][field];
      const double expected = quantity["change"] == "scale" ? before * by : before + by;
      EXPECT_NEAR(truth[type][object][field], expected, 1e-9) << target;
    }
  }
}

TEST(EnergyPlusTruth, ItsTargetsLeadToWhatHasChanged) {
  const auto laboratory = laboratory_truth(5);
  expect_targets(laboratory.description, laboratory_model({}),
                 laboratory_model(laboratory.parameters));
  const auto office = small_office_truth(5);
  expect_targets(office.description, small_office_model({}), small_office_model(office.parameters));
}

TEST(EnergyPlusHabits, HaveEachHourOfTheYearAndVaryAboutTheDrawings) {
  const std::vector<PeopleSchedule> schedules = laboratory_schedules();
  const Habits habits = with_habits(laboratory_model({}), schedules, 2012,
                                    Calendar(Use::laboratory), 1, "habits.csv");
  const auto rows = lines_of(habits.csv);
  ASSERT_EQ(rows.size(), 1u + 8784u);
  EXPECT_EQ(habits.model["Schedule:File"]["Offices presence"]["number_of_hours_of_data"], 8784);
  EXPECT_FALSE(habits.model["Schedule:Compact"].contains("Offices presence"));
  // Tuesday 2012-05-15 at 11 h and the same hour a week later, by the drawings 0.79.
  const double one = std::stod(rows[1 + 24 * 135 + 11]);
  const double other = std::stod(rows[1 + 24 * 142 + 11]);
  EXPECT_NEAR(one, 0.79, 0.25);
  EXPECT_NE(one, other);
  EXPECT_LT(std::stod(rows[1 + 24 * 140 + 11]), 0.1) << "a Sunday";
}

TEST(EnergyPlusWeather, AYearOfHoursWithItsSummerTimeAndWeekday) {
  const auto calendar = metering::LocalCalendar::open("America/New_York").value();
  const Place place{33.65, -84.43, 308.0};
  const auto hours = simulate_hours(hot_humid_climate(place), 2011, 2, 1, calendar);
  ASSERT_EQ(hours.size(), 8760u + 8784u);
  const auto lines =
      lines_of(epw_text(hours, 2012, place, calendar,
                        Calendar(Use::laboratory).holidays_of(std::chrono::year{2012})));
  ASSERT_EQ(lines.size(), 8u + 8784u);
  EXPECT_THAT(lines[4], HasSubstr("HOLIDAYS/DAYLIGHT SAVINGS,Yes,3/11,11/3,"));
  EXPECT_THAT(lines[7], HasSubstr("DATA PERIODS,1,1,Data,Sunday,1/1/2012,12/31/2012"));
  EXPECT_THAT(lines[8], ::testing::StartsWith("2012,1,1,1,60,,"));
  EXPECT_THAT(lines.back(), ::testing::StartsWith("2012,12,31,24,60,,"));
  EXPECT_EQ(std::count(lines[8].begin(), lines[8].end(), ','), 34);
  // The sun: about noon, none at midnight, and what beam and diffuse sum up to.
  const WeatherHour& june_noon = hours[24 * 170 + 12];
  EXPECT_GT(june_noon.global_W_m2, 100.0);
  EXPECT_EQ(hours[24 * 170].global_W_m2, 0.0);
}

/// An eplusout.sql of one day: a reported meter of 3.6 MJ in each quarter of an hour.
std::filesystem::path run_of_a_day(const recald::testing::TemporaryFolder& folder) {
  const std::filesystem::path file = folder / "eplusout.sql";
  sqlite3* database = nullptr;
  sqlite3_open(file.c_str(), &database);
  std::string sql =
      "BEGIN;CREATE TABLE Time(TimeIndex INTEGER, Year INTEGER, Month INTEGER, Day INTEGER, Hour "
      "INTEGER, Minute INTEGER, Interval INTEGER, EnvironmentPeriodIndex INTEGER, WarmupFlag "
      "INTEGER);"
      "CREATE TABLE EnvironmentPeriods(EnvironmentPeriodIndex INTEGER, EnvironmentType INTEGER);"
      "CREATE TABLE ReportDataDictionary(ReportDataDictionaryIndex INTEGER, Name TEXT, "
      "ReportingFrequency TEXT);"
      "CREATE TABLE ReportData(TimeIndex INTEGER, ReportDataDictionaryIndex INTEGER, Value REAL);"
      "INSERT INTO EnvironmentPeriods VALUES(1,3);"
      "INSERT INTO ReportDataDictionary VALUES(7,'Electricity:Facility','Zone Timestep');";
  for (int slot = 1; slot <= 96; ++slot) {
    const std::string index = std::to_string(slot);
    sql += "INSERT INTO Time VALUES(" + index + ",2021,7,1," + std::to_string((slot - 1) / 4) +
           "," + std::to_string((slot - 1) % 4 * 15 + 15) +
           ",15,1,0);INSERT INTO ReportData VALUES(" + index + ",7,3.6e6);";
  }
  sql += "COMMIT;";
  sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr);
  sqlite3_close(database);
  return file;
}

TEST(EnergyPlusReadings, AreStampedAtTheirStartInUtc) {
  const recald::testing::TemporaryFolder folder;
  const auto text = readings_csv({.runs = {run_of_a_day(folder)},
                                  .meters = {{"electricity", "Electricity:Facility"}},
                                  .standard_offset = std::chrono::hours{-5},
                                  .noise_share = 0.0,
                                  .lost_share = 0.0});
  ASSERT_TRUE(text.has_value()) << text.error().message;
  const auto rows = lines_of(*text);
  ASSERT_EQ(rows.size(), 97u);
  EXPECT_EQ(rows[1], "2021-07-01T05:00:00Z,electricity,1.000,kWh");
  EXPECT_EQ(rows[96], "2021-07-02T04:45:00Z,electricity,1.000,kWh");
}

TEST(EnergyPlusReadings, NoiseIsTheSeeds) {
  const recald::testing::TemporaryFolder folder;
  ReadingOptions options{.runs = {run_of_a_day(folder)},
                         .meters = {{"electricity", "Electricity:Facility"}},
                         .standard_offset = {},
                         .noise_share = 0.02,
                         .lost_share = 0.0};
  const auto one = readings_csv(options);
  EXPECT_EQ(*one, *readings_csv(options));
  options.seed = 2;
  EXPECT_NE(*one, *readings_csv(options));
}

TEST(EnergyPlusReadings, AMeterThatWasNotReportedIsNamed) {
  const recald::testing::TemporaryFolder folder;
  const auto text = readings_csv({.runs = {run_of_a_day(folder)},
                                  .meters = {{"gas", "NaturalGas:Facility"}},
                                  .standard_offset = {}});
  ASSERT_FALSE(text.has_value());
  EXPECT_EQ(text.error().code, ErrorCode::not_found);
  EXPECT_THAT(text.error().message, HasSubstr("no meter NaturalGas:Facility"));
  EXPECT_EQ(readings_csv({.runs = {"/no/such.sql"},
                          .meters = {{"gas", "NaturalGas:Facility"}},
                          .standard_offset = {}})
                .error()
                .code,
            ErrorCode::io_failed);
}

}  // namespace
}  // namespace recald::simulators::energyplus::energyplus_files_test
