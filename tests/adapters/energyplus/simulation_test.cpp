/// Runs of programs that stand for EnergyPlus at its worst, and of EnergyPlus itself where it is.
#include "adapters/energyplus/run/simulation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "adapters/energyplus/run/meter_output.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::energyplus::simulation_test {
namespace {

using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using ::testing::HasSubstr;

metering::Day day(int year, unsigned month, unsigned date) {
  return std::chrono::year{year} / month / date;
}

class Simulation : public ::testing::Test {
 protected:
  Program program(const std::string& script) {
    const std::filesystem::path file = folder_ / "energyplus";
    write_text(file, "#!/bin/sh\n" + script);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    return {file, "25.2"};
  }
  Result<std::filesystem::path> run(const std::string& script, RunLimits limits = {},
                                    const std::function<bool()>& keep_going = {}) {
    return simulate(Json::object(), folder_ / "w.epw", folder_ / "run", program(script), limits,
                    keep_going);
  }
  TemporaryFolder folder_;
};

TEST_F(Simulation, AModelThatIsRefusedIsToldInEnergyPlusWords) {
  const auto run_folder =
      run("echo '   ** Severe  ** Zone=A has no floor.' > eplusout.err\n"
          "echo '   **  Fatal  ** Preceding errors.' >> eplusout.err\nexit 1\n");
  EXPECT_EQ(run_folder.error().code, ErrorCode::invalid_value);
  EXPECT_EQ(run_folder.error().message, "EnergyPlus says: Zone=A has no floor.");
}

TEST_F(Simulation, AFatalErrorWithStatusZeroIsAFailure) {
  EXPECT_FALSE(run("echo '   **  Fatal  ** No.' > eplusout.err\nexit 0\n").has_value());
}

TEST_F(Simulation, OneThatDiesWithoutAWordSaysHow) {
  EXPECT_THAT(run("kill -SEGV $$\n").error().message, HasSubstr("signal 11"));
  EXPECT_THAT(run("exit 3\n").error().message, HasSubstr("status 3"));
}

TEST_F(Simulation, OneThatHangsIsEnded) {
  const auto hung = run("sleep 600\n", {.time_max = std::chrono::seconds{1}});
  EXPECT_EQ(hung.error().code, ErrorCode::out_of_range);
  EXPECT_THAT(hung.error().message, HasSubstr("still running after 1 s"));
}

TEST_F(Simulation, StopsWhenAskedTo) {
  const auto stopped = run("sleep 600\n", {}, [] { return false; });
  EXPECT_EQ(stopped.error().code, ErrorCode::cancelled);
}

TEST(PreparedObjects, ReportWhatIsAskedForAndNothingElse) {
  Json objects = Json::parse(R"({
    "Output:Variable": {"a": {"variable_name": "Zone Air Temperature"}},
    "RunPeriod": {"r": {"begin_month": 1, "day_of_week_for_start_day": "Tuesday",
                        "use_weather_file_daylight_saving_period": "No"}},
    "SimulationControl": {"s": {"run_simulation_for_sizing_periods": "Yes"}}
  })");
  prepare_objects(
      {.first = day(2021, 2, 1), .last = day(2021, 3, 31), .meters = {"Electricity:Facility"}},
      objects);
  EXPECT_FALSE(objects.contains("Output:Variable"));
  EXPECT_EQ(objects["Output:Meter"]["recald 1"]["key_name"], "Electricity:Facility");
  const Json& period = objects["RunPeriod"]["recald"];
  EXPECT_EQ(period["begin_month"], 2);
  EXPECT_EQ(period["end_day_of_month"], 31);
  EXPECT_EQ(period["begin_year"], 2021);
  EXPECT_EQ(period["use_weather_file_daylight_saving_period"], "No");
  EXPECT_FALSE(period.contains("day_of_week_for_start_day"));
  EXPECT_EQ(objects["SimulationControl"]["s"]["run_simulation_for_sizing_periods"], "No");
}

TEST(FindProgram, SaysWhereItLooked) {
  TemporaryFolder folder;
  EXPECT_THAT(find_program(folder / "nowhere").error().message, HasSubstr("nowhere"));
  write_text(folder / "energyplus", "#!/bin/sh\necho 'EnergyPlus, Version 8.9.0-abc'\n");
  std::filesystem::permissions(folder / "energyplus", std::filesystem::perms::owner_all);
  EXPECT_THAT(find_program(folder.path()).error().message, HasSubstr("recald needs 9.0 or later"));
  write_text(folder / "energyplus", "#!/bin/sh\necho 'EnergyPlus, Version 25.2.0-abc'\n");
  const auto program = find_program(folder.path());
  ASSERT_TRUE(program.has_value()) << program.error().message;
  EXPECT_EQ(program->version, "25.2");
}

}  // namespace
}  // namespace recald::energyplus::simulation_test
