/// A site on EnergyPlus itself: runs made, calibrated on, continued into a year that no run saw.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "adapters/energyplus/run/program.hpp"
#include "adapters/system/child_process.hpp"
#include "adapters/system/files/file_lock.hpp"
#include "command_line.hpp"
#include "simulators/energyplus/model_files.hpp"
#include "simulators/energyplus/run_readings.hpp"
#include "tampered_readings.hpp"
#include "tests/support/installed_energyplus.hpp"
#include "tests/support/sample_site.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::json;
using recald::testing::edited;
using recald::testing::read_text;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using ::testing::HasSubstr;
using testing::multiplied;
using ::testing::Not;
using testing::Outcome;
using testing::run;

constexpr int kFirstYear = 2021;
constexpr int kYears = 3;

constexpr std::string_view kSite = R"([site]
id = "office"
timezone = "America/New_York"
latitude_deg = 39.17
longitude_deg = -76.68
altitude_m = 45

[weather]
file = "weather.csv"
stamps = "end"
values = "instant"

[period]
calibration = { from = "2021-01", to = "2022-12" }

[[meter]]
id = "electricity"
utility = "electricity"
file = "readings.csv"

[[meter]]
id = "chilled_water"
utility = "chilled_water"
file = "readings.csv"

[[meter]]
id = "heat"
utility = "heating"
file = "readings.csv"

[[model]]
kind = "energyplus"
file = "model.epJSON"
outputs = ["electricity", "chilled_water", "heat"]
runs = 10
interval_noise = 0.02

[model.reports]
electricity = "Electricity:Facility"
chilled_water = "DistrictCooling:Facility"
heat = "DistrictHeatingWater:Facility"

[[model.parameter]]
name = "occupancy_density"

[[model.parameter]]
name = "cooling_setpoint"
prior = [22, 24, 26]

[[model.parameter]]
name = "lighting"
targets = "Lights/*/watts_per_floor_area"
change = "scale"
prior = [0.7, 1.0, 1.4]
)";

/// The same site over all years, following its chilled water.
std::string followed_site() {
  std::string text = edited(std::string{kSite}, "to = \"2022-12\" }", "to = \"2023-12\" }");
  text = edited(text, "[\"electricity\", \"chilled_water\", \"heat\"]", "[\"chilled_water\"]");
  text = edited(text, "electricity = \"Electricity:Facility\"\n", "");
  return edited(text, "heat = \"DistrictHeatingWater:Facility\"\n", "");
}

/// The office, what its meters recorded in three years, and 10 runs over the first two.
class OnEnergyPlus : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto program = energyplus::find_program(
        recald::testing::installed_energyplus(RECALD_ENERGYPLUS_ENVIRONMENT));
    if (!program) return;
    ::setenv("RECALD_ENERGYPLUS", program->executable.c_str(), 1);
    folder_ = new TemporaryFolder;
    const std::filesystem::path& folder = folder_->path();
    const auto written = simulators::energyplus::write_model_files({.kind = "small_office",
                                                                    .out = folder,
                                                                    .with_truth = true,
                                                                    .first_year = kFirstYear,
                                                                    .years = kYears,
                                                                    .seed = 7});
    ASSERT_TRUE(written.has_value()) << written.error().message;
    program_ = program->executable;
    write_text(folder / "readings.csv", readings_of("truth", kYears));
    write_text(folder / "site.toml", std::string{kSite});
    // Asked once runs are being made: nobody else may make any in the folder.
    std::jthread other{[&](const std::stop_token& stop) {
      while (!stop.stop_requested() &&
             !std::filesystem::exists(folder / "site-doe/doe_inputs.csv")) {
        std::this_thread::sleep_for(std::chrono::milliseconds{20});
      }
      folder_was_locked_ = system::FileLock::is_held(folder / "site-doe/lock");
    }};
    made_ = new Outcome{run({"doe", (folder / "site.toml").string()})};
  }
  static void TearDownTestSuite() {
    delete folder_;
    delete made_;
    folder_ = nullptr;
  }
  void SetUp() override {
    if (folder_ == nullptr) GTEST_SKIP() << "EnergyPlus is not installed";
    ASSERT_EQ(made_->exit_code, kSuccess) << made_->err;
  }

  /// What the meters record in these years of the building in NAME-YEAR.epJSON.
  static std::string readings_of(const std::string& name, int years) {
    const std::filesystem::path& folder = folder_->path();
    simulators::energyplus::ReadingOptions readings{
        .runs = {},
        .meters = simulators::energyplus::district_meters(),
        .standard_offset = std::chrono::hours{-5}};
    for (int year = kFirstYear; year < kFirstYear + years; ++year) {
      const std::string out = fmt::format("{}-{}", name, year);
      const auto ended =
          system::run_child({.program = program_,
                             .arguments = {"--weather", fmt::format("{}.epw", year),
                                           "--output-directory", out, out + ".epJSON"},
                             .folder = folder,
                             .output = folder / "truth.log"},
                            {});
      EXPECT_TRUE(ended.has_value() && ended->exit_code == 0) << read_text(folder / "truth.log");
      readings.runs.push_back(folder / out / "eplusout.sql");
    }
    const auto csv = simulators::energyplus::readings_csv(readings);
    EXPECT_TRUE(csv.has_value()) << csv.error().message;
    return csv.value_or("");
  }

  [[nodiscard]] static std::string path(std::string_view name) {
    return (*folder_ / name).string();
  }
  /// A site file beside the first, on the same runs.
  static std::string site(const std::string& name, const std::string& text) {
    write_text(*folder_ / name, edited(text, "runs = 10", "runs = 10\ndesign = \"site-doe\""));
    return path(name);
  }

  static TemporaryFolder* folder_;
  static Outcome* made_;
  static std::filesystem::path program_;
  static bool folder_was_locked_;
};
TemporaryFolder* OnEnergyPlus::folder_ = nullptr;
Outcome* OnEnergyPlus::made_ = nullptr;
std::filesystem::path OnEnergyPlus::program_;
bool OnEnergyPlus::folder_was_locked_ = false;

constexpr double kLampsLeft = 0.6;
constexpr std::string_view kLamps = R"([[measure]]
name = "Better lamps"
[[measure.change]]
targets = "Lights/*/watts_per_floor_area"
change = "scale"
value = 0.6
)";

/// kWh of a meter in the first two years.
double energy_kWh(const std::string& readings, const std::string& meter) {
  double sum = 0.0;
  std::istringstream lines{readings};
  for (std::string line; std::getline(lines, line);) {
    const std::size_t comma = line.find(',');
    if (line.compare(comma + 1, meter.size() + 1, meter + ",") != 0) continue;
    if (line.substr(0, 4) >= "2023") continue;
    sum += std::stod(line.substr(comma + 1 + meter.size() + 1));
  }
  return sum;
}

TEST_F(OnEnergyPlus, RunsAreUsedAndNeverMadeAgain) {
  EXPECT_THAT(made_->out, HasSubstr("10 runs of 3 parameters, 6 outputs in 24 months"));
  const Outcome done = run({"calibrate", path("site.toml"), "--json", "--out", path("out")});
  ASSERT_EQ(done.exit_code, kSuccess) << done.err;
  const Json result = Json::parse(done.out);
  EXPECT_EQ(result["status"], "converged");
  EXPECT_LT(result["after"]["calibration"]["chilled_water_daily_kWh"]["cvrmse"], 0.10);
  const Outcome again = run({"doe", path("site.toml"), "--json"});
  EXPECT_EQ(Json::parse(again.out)["runs_before"], 10);
}

TEST_F(OnEnergyPlus, RunsAreMadeByOneAtATime) {
  EXPECT_TRUE(folder_was_locked_);
  EXPECT_FALSE(system::FileLock::is_held(path("site-doe/lock")));
}

TEST_F(OnEnergyPlus, WhatTheModelHasIsShownAsLinesToPaste) {
  const Outcome shown = run({"engine", "show", path("site.toml")});
  ASSERT_EQ(shown.exit_code, kSuccess) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("DistrictCooling:Facility"));
  EXPECT_THAT(shown.out, HasSubstr("name = \"infiltration_scale\""));
  EXPECT_THAT(shown.out, HasSubstr("Lights/*/watts_per_floor_area"));
}

TEST_F(OnEnergyPlus, AYearThatNoRunSawIsForecastMonthByMonth) {
  const std::string live = site("live.toml", followed_site());
  const Outcome done =
      run({"drift", live, "--learn", "24", "--particles", "128", "--out", path("drift")});
  ASSERT_EQ(done.exit_code, kSuccess) << done.err;
  const Json drift = Json::parse(read_text(*folder_ / "drift/drift.json"));
  double squares = 0.0;
  double measured = 0.0;
  int months = 0;
  for (const Json& output : drift["outputs"]) {
    if (output["name"] != "chilled_water_daily_kWh") continue;
    for (const Json& month : output["months"]) {
      const double error = month["mean"].get<double>() - month["measured"].get<double>();
      squares += error * error;
      measured += month["measured"].get<double>();
      ++months;
    }
  }
  ASSERT_EQ(months, 12);
  EXPECT_LT(std::sqrt(squares / months) / (measured / months), 0.10);
  EXPECT_TRUE(drift["alarms"].empty()) << drift["alarms"].dump(1);
}

TEST_F(OnEnergyPlus, AChangeInThatYearIsFound) {
  std::string changed = followed_site();
  for (std::size_t at = changed.find("readings.csv"); at != std::string::npos;
       at = changed.find("readings.csv", at + 12)) {
    changed.replace(at, 12, "changed1.csv");
  }
  write_text(*folder_ / "changed1.csv",
             multiplied(read_text(*folder_ / "readings.csv"), "chilled_water", "2023-05", 1.3));
  const Outcome done = run({"drift", site("changed.toml", changed), "--learn", "24", "--particles",
                            "128", "--out", path("changed")});
  ASSERT_EQ(done.exit_code, kSuccess) << done.err;
  const Json drift = Json::parse(read_text(*folder_ / "changed/drift.json"));
  ASSERT_FALSE(drift["alarms"].empty());
  EXPECT_THAT(drift["alarms"][0].dump(), HasSubstr("chilled_water"));
}

TEST_F(OnEnergyPlus, AMeasureSavesWhatItSavesInTheBuildingThatNobodyKnows) {
  for (const int year : {kFirstYear, kFirstYear + 1}) {
    Json building = Json::parse(read_text(*folder_ / fmt::format("truth-{}.epJSON", year)));
    for (auto& lights : building["Lights"]) {
      lights["watts_per_floor_area"] = kLampsLeft * lights["watts_per_floor_area"].get<double>();
    }
    write_text(*folder_ / fmt::format("lamps-{}.epJSON", year), building.dump());
  }
  const std::string without = read_text(*folder_ / "readings.csv");
  const std::string with = readings_of("lamps", 2);
  write_text(*folder_ / "lamps.toml", std::string{kLamps});
  const Outcome done =
      run({"ecm", path("site.toml"), "--measure", path("lamps.toml"), "--out", path("ecm")});
  ASSERT_EQ(done.exit_code, kSuccess) << done.err;
  const Json ecm = Json::parse(read_text(*folder_ / "ecm/ecm.json"));
  int compared = 0;
  for (const Json& meter : ecm["measures"][0]["meters"]) {
    if (meter["unit"] != "kWh") continue;
    const std::string name = meter["meter"];
    const double truth = 0.5 * (energy_kWh(without, name) - energy_kWh(with, name));
    EXPECT_NEAR(meter["saved"]["q50"].get<double>(), truth, 0.5 * std::abs(truth)) << name;
    EXPECT_LT(meter["saved"]["q05"].get<double>(), truth) << name;
    EXPECT_GT(meter["saved"]["q95"].get<double>(), truth) << name;
    ++compared;
  }
  EXPECT_EQ(compared, 3);
  // Asked again where there is no EnergyPlus, it says the same.
  ::setenv("RECALD_ENERGYPLUS", "/nowhere", 1);
  const Outcome again = run({"ecm", path("site.toml"), "--measure", path("lamps.toml"), "--json"});
  ::setenv("RECALD_ENERGYPLUS", program_.c_str(), 1);
  ASSERT_EQ(again.exit_code, kSuccess) << again.err;
  EXPECT_EQ(Json::parse(again.out)["measures"], ecm["measures"]);
}

/// A building beside the EnergyPlus model, for the hourly model that finds what is missing.
constexpr std::string_view kBuilding = R"(
[[model]]
kind = "hourly"
outputs = ["electricity"]

[[model.parameter]]
name = "occupancy_density"
)";

constexpr std::string_view kFirstBusyDay = "2022-03-01T05:00:00Z";

/// The first readings up to a time, the others from then on.
std::string joined_at(std::string_view time, const std::string& first, const std::string& others) {
  std::string text;
  const auto add = [&](const std::string& readings, bool is_from) {
    std::istringstream lines{readings};
    for (std::string line; std::getline(lines, line);) {
      const bool is_head = line.starts_with("timestamp");
      if (is_head ? is_from : (line.substr(0, time.size()) >= time) != is_from) continue;
      text += line + "\n";
    }
  };
  add(first, false);
  add(others, true);
  return text;
}

// From a day on the office has half as many machines again.
TEST_F(OnEnergyPlus, AnEffectIsAddedToTheModelAndShrinksItsGap) {
  for (const int year : {kFirstYear, kFirstYear + 1}) {
    Json building = Json::parse(read_text(*folder_ / fmt::format("truth-{}.epJSON", year)));
    for (auto& equipment : building["ElectricEquipment"]) {
      equipment["watts_per_floor_area"] = 1.5 * equipment["watts_per_floor_area"].get<double>();
    }
    write_text(*folder_ / fmt::format("busy-{}.epJSON", year), building.dump());
  }
  const std::string before = read_text(*folder_ / "readings.csv");
  const std::string busy = readings_of("busy", 2);
  write_text(*folder_ / "busier1.csv", joined_at(kFirstBusyDay, before, busy));
  const double more_kW =
      (energy_kWh(busy, "electricity") - energy_kWh(before, "electricity")) / (2.0 * 365.0 * 24.0);
  std::string text = std::string{kSite} + std::string{kBuilding};
  for (std::size_t at = text.find("readings.csv"); at != std::string::npos;
       at = text.find("readings.csv", at)) {
    text.replace(at, 12, "busier1.csv");
  }
  const std::string sample = recald::testing::sample_site();
  const std::string office = site("busier.toml", text + sample.substr(sample.find("[building]")));

  const Outcome done =
      run({"diagnose", office, "--assume", "equipment_step", "--apply", "--out", path("busier")});
  ASSERT_EQ(done.exit_code, kSuccess) << done.err;
  EXPECT_THAT(done.err, HasSubstr("The EnergyPlus model gets the effect too: 10 runs into"));
  EXPECT_THAT(done.out, HasSubstr("is now in force"));
  const Json gap = Json::parse(read_text(*folder_ / "busier/diagnosis.json"))["gap"]["energyplus"];
  const auto cvrmse = [&](const char* when) {
    return gap[when]["electricity_daily_kWh"]["cvrmse"].get<double>();
  };
  EXPECT_LT(cvrmse("after"), 0.6 * cvrmse("before")) << gap.dump(1);

  // From then on the model is the one with the effect, in runs of its own.
  const Outcome calibrated = run({"calibrate", office, "--json"});
  ASSERT_EQ(calibrated.exit_code, kSuccess) << calibrated.err;
  const Json result = Json::parse(calibrated.out);
  bool is_found = false;
  for (const Json& parameter : result["parameters"]) {
    if (parameter["name"] != "equipment_step_power") continue;
    is_found = true;
    EXPECT_NEAR(parameter["mean"].get<double>(), more_kW, 0.4 * more_kW);
  }
  EXPECT_TRUE(is_found) << result["parameters"].dump();
  ASSERT_EQ(run({"model", "revert", office, "drawings"}).exit_code, kSuccess);
  EXPECT_THAT(run({"calibrate", office, "--json"}).out, Not(HasSubstr("equipment_step")));
}

TEST_F(OnEnergyPlus, AMeasureThatTheModelHasNoPlaceForIsRefused) {
  write_text(*folder_ / "nowhere.toml", edited(std::string{kLamps}, "Lights/*/watts_per_floor_area",
                                               "Lights/*/watts_per_flor"));
  EXPECT_THAT(run({"ecm", path("site.toml"), "--measure", path("nowhere.toml")}).err,
              HasSubstr("watts_per_floor_area"));
  write_text(*folder_ / "both.toml",
             edited(std::string{kLamps}, "targets", "parameter = \"lighting\"\ntargets"));
  EXPECT_THAT(run({"ecm", path("site.toml"), "--measure", path("both.toml")}).err,
              HasSubstr("either as 'parameter'"));
}

TEST_F(OnEnergyPlus, RunsOfAModelThatWasEditedAreNotTaken) {
  const std::string noisier =
      edited(std::string{kSite}, "interval_noise = 0.02", "interval_noise = 0.03");
  EXPECT_THAT(run({"calibrate", site("edited.toml", noisier)}).err,
              HasSubstr("holds a design that was made from another site file"));
  EXPECT_THAT(run({"drift", site("edited.toml", noisier), "--learn", "12"}).err,
              HasSubstr("were made before the model's targets"));
  const std::string reported =
      edited(std::string{kSite}, "DistrictHeatingWater:Facility", "Heating:DistrictHeatingWater");
  EXPECT_THAT(run({"drift", site("edited.toml", reported), "--learn", "12"}).err,
              HasSubstr("were made before [model.reports] of 'heat' changed"));
}

TEST_F(OnEnergyPlus, CornersOfThePriorsMayComeTwice) {
  const Outcome done = run(
      {"doe", path("site.toml"), "--corners", "--runs", "10", "--out", path("corners"), "--json"});
  ASSERT_EQ(done.exit_code, kSuccess) << done.err;
  EXPECT_EQ(Json::parse(done.out)["runs_failed"], 0);
  const Outcome checked = run({"metamodel", "--doe", path("site-doe"), "--form", "monthly",
                               "--check", path("corners"), "--json"});
  ASSERT_EQ(checked.exit_code, kSuccess) << checked.err;
  EXPECT_LT(Json::parse(checked.out)["check"]["chilled_water_daily_kWh"]["cvrmse"], 0.2);
}

TEST_F(OnEnergyPlus, MistakesAreNamedBeforeAnythingIsRun) {
  const auto said = [&](std::string_view what, std::string_view with) {
    write_text(*folder_ / "wrong.toml", edited(std::string{kSite}, what, with));
    return run({"doe", path("wrong.toml")}).err;
  };
  EXPECT_THAT(said("\"DistrictCooling:Facility\"", "\"DistrictColing:Facility\""),
              HasSubstr("does not report a meter"));
  EXPECT_THAT(said("Lights/*/watts_per_floor_area", "Lights/*/watts_per_flor_area"),
              HasSubstr("watts_per_floor_area"));
  EXPECT_THAT(said("chilled_water = \"Dis", "# chilled_water = \"Dis"),
              HasSubstr("[model.reports] does not say which meters"));
  EXPECT_THAT(said("name = \"cooling_setpoint\"", "name = \"chilled_water_temperature\""),
              HasSubstr("no such quantity"));
}

}  // namespace
}  // namespace recald::daemon
