/// `recald diagnose` as an operator meets it: what it leaves when all goes well, and what it says
/// when the data, the disk or the model are not as they should be.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "command_line.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/model/diagnosis_input.hpp"
#include "depot_year.hpp"
#include "modelled_readings.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::json;
using recald::testing::edited;
using recald::testing::read_text;
using recald::testing::sample_site;
using recald::testing::write_text;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::Outcome;
using testing::run;
using ::testing::StartsWith;

/// Steps of an hour, as the depot's readings come.
std::string hourly_site() {
  return edited(sample_site(), "interval = \"15m\"", "interval = \"1h\"");
}

/// The depot with its electricity meter alone: a diagnosis of a few seconds.
std::string one_meter_site() {
  return edited(hourly_site(),
                "outputs = [\"electricity\", \"district_heat\"]\nweights = { district_heat = 0.8 }",
                "outputs = [\"electricity\"]");
}

/// The lines of `text` for which `keep` holds, the first one always; `change` is applied to them.
template <class Keep, class Change>
std::string lines_of(const std::string& text, Keep keep, Change change) {
  std::istringstream lines{text};
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    if (result.empty() || keep(line)) result += change(line) + "\n";
  }
  return result;
}

std::string as_it_is(const std::string& line) { return line; }

/// A row of weather.csv without its columns from `first` to before `last`.
std::string without_columns(const std::string& line, int first, int last) {
  std::istringstream fields{line};
  std::string result;
  int column = 0;
  for (std::string field; std::getline(fields, field, ','); ++column) {
    if (column >= first && column < last) continue;
    result += (result.empty() ? "" : ",") + field;
  }
  return result;
}

class DiagnoseCommand : public ::testing::Test {
 protected:
  DiagnoseCommand() { recald::testing::write_depot_year(folder_.path(), hourly_site()); }

  [[nodiscard]] std::string path(std::string_view name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::string site() const { return path("site.toml"); }

  template <class Keep, class Change>
  void edit_file(const char* name, Keep keep, Change change) {
    write_text(folder_ / name, lines_of(read_text(folder_ / name), keep, change));
  }

  Outcome diagnose(const std::string& out, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"diagnose", site(), "--out", path(out)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  [[nodiscard]] Json result(const std::string& out) const {
    return Json::parse(read_text(folder_ / (out + "/diagnosis.json")));
  }

  /// One sentence, the last on err, and nothing else.
  void expect_refusal(const std::string& sentence) {
    const Outcome outcome = diagnose("refused");
    EXPECT_EQ(outcome.exit_code, kFailure);
    EXPECT_THAT(outcome.err, EndsWith("recald: " + sentence + "\n"));
    EXPECT_EQ(outcome.out, "");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "refused"));
  }

  recald::testing::TemporaryFolder folder_;
};

TEST_F(DiagnoseCommand, FourMonthsAreTooFew) {
  write_text(folder_ / "site.toml",
             edited(edited(hourly_site(), "to = \"2021-09\"", "to = \"2021-04\""),
                    "validation = { from = \"2021-10\", to = \"2021-12\" }", ""));
  expect_refusal(
      "a diagnosis needs at least 6 months with weather and readings; depot has 4; widen [period]");
}

TEST_F(DiagnoseCommand, MonthsWithoutReadingsDoNotCount) {
  edit_file(
      "readings.csv", [](const std::string& line) { return line < "2021-04-10"; }, as_it_is);
  expect_refusal(
      "a diagnosis needs at least 6 months with weather and readings; depot has 3; give more "
      "readings: those of depot cover 2021-01 to 2021-03 with half of their hours");
}

TEST_F(DiagnoseCommand, AMeterThatNeverSpokeIsNamed) {
  edit_file(
      "readings.csv",
      [](const std::string& line) {
        return line.find(",heat,") == std::string::npos || line < "2021-01-08";
      },
      as_it_is);
  const Outcome outcome = run({"diagnose", site()});
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_THAT(outcome.err, HasSubstr("recald: meter 'district_heat' has "));
  EXPECT_THAT(outcome.err,
              HasSubstr("leave the meter out of the model's outputs or provide more readings"));
}

TEST_F(DiagnoseCommand, AFolderThatCannotBeMadeIsToldBeforeTheWork) {
  write_text(folder_ / "in_the_way", "a file");
  const Outcome outcome = diagnose("in_the_way/results");
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_THAT(outcome.err, AllOf(StartsWith("recald: "), HasSubstr("in_the_way")));
  EXPECT_EQ(outcome.out, "");
}

// One meter, read by the hour; the weather has temperature alone, and no May at all; the meter
// stood still from November. Nothing can be named here, and all of that is said.
TEST_F(DiagnoseCommand, WhatTheDataLackIsSaid) {
  write_text(folder_ / "site.toml", one_meter_site());
  edit_file(
      "weather.csv", [](const std::string& line) { return !line.starts_with("2021-05"); },
      [](const std::string& line) { return without_columns(line, 2, 6); });
  edit_file(
      "readings.csv", [](const std::string& line) { return line < "2021-11"; }, as_it_is);

  const Outcome outcome = diagnose("out", {"--apply"});

  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("! May 2021 is left out: only "));
  EXPECT_THAT(outcome.out, HasSubstr("! The weather has no humidity: "));
  EXPECT_THAT(outcome.out, HasSubstr("! The weather has no wind: "));
  EXPECT_THAT(outcome.out, HasSubstr("! The weather has no sun: "));
  EXPECT_THAT(outcome.out, EndsWith("No effect was added. The model was not changed.\n"));
  const Json json = result("out");
  EXPECT_THAT(json["added"], IsEmpty());
  const Json unseen = json["not_identifiable_here"];
  const auto why = [&](const char* effect) -> std::string {
    for (const Json& one : unseen) {
      if (one["effect"] == effect) return one["why"];
    }
    return "";
  };
  EXPECT_EQ(why("wind_infiltration"), "the weather has no wind");
  EXPECT_EQ(why("humidifier"), "the weather has no humidity");
  EXPECT_EQ(why("solar_gain_change"), "the weather has no sun");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/diagnosis.html"));
  EXPECT_THAT(run({"model", "list", site()}).out, StartsWith("* drawings"));
}

// A page that cannot be written: what was found is on the terminal, and nothing half-done remains.
TEST_F(DiagnoseCommand, AWriteThatFailsLosesNothing) {
  write_text(folder_ / "site.toml", one_meter_site());
  std::filesystem::create_directories(folder_ / "out/diagnosis.html/in_the_way");
  const Outcome outcome = diagnose("out", {"--apply"});
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_THAT(outcome.out, HasSubstr("Outcome: "));
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("recald: "), HasSubstr("diagnosis.html")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/diagnosis.json"));
  EXPECT_THAT(run({"model", "list", site()}).out, StartsWith("* drawings"));
}

/// Ten months of the depot whose lights and plugs are as the hourly model has them, and from a day
/// in April on more than half as much again. (Lost phases would do, but on one meter a meter that
/// stands still explains nearly as much, and which of them is first hangs on the last bits of a
/// machine.)
class DepotWithMoreMachines : public DiagnoseCommand {
 protected:
  DepotWithMoreMachines() {
    const std::string heat = lines_of(read_text(folder_ / "readings.csv"), is_of_heat, as_it_is);
    write_electricity_of_model();
    edit_file("readings.csv", std::not_fn(is_of_heat), [](const std::string& line) {
      const std::size_t at = line.find(kElectricity);
      if (at == std::string::npos || line < "2021-04-12") return line;
      const double kW = std::stod(line.substr(at + kElectricity.size()));
      return line.substr(0, at) + std::string{kElectricity} + std::to_string(1.6 * kW) + ",kW";
    });
    const std::string header = "timestamp,meter,value,unit\n";
    write_text(folder_ / "readings.csv",
               read_text(folder_ / "readings.csv") + heat.substr(header.size()));
  }

  static bool is_of_heat(const std::string& line) {
    return line.find(",heat,") != std::string::npos;
  }

  void write_electricity_of_model() {
    std::ostringstream ignored;
    const auto year =
        open_modelled_site(site(), Console{ignored, ignored, false}, ModelKind::hourly);
    if (!year) throw std::runtime_error(ignored.str());
    const auto problem =
        make_site_problem(year->site.config, year->site.calendar, year->recording, year->weather);
    if (!problem) throw std::runtime_error(problem.error().message);
    recald::testing::write_modelled_readings(folder_.path(), *problem, nullptr);
  }

  /// With these meters, from January to October.
  void use(const std::string& text) {
    write_text(folder_ / "site.toml", edited(edited(text, "to = \"2021-09\"", "to = \"2021-07\""),
                                             "from = \"2021-10\", to = \"2021-12\"",
                                             "from = \"2021-08\", to = \"2021-10\""));
  }

  /// @return calibration.json without the one figure that differs between equal runs.
  Json calibrate() {
    use(hourly_site());
    const Outcome outcome = run({"calibrate", site(), "--out", path("calibrated"), "--sampler",
                                 "dram", "--draws", "1400", "--burn-in", "400", "--chains", "2"});
    EXPECT_EQ(outcome.exit_code, kSuccess) << outcome.err;
    Json json = Json::parse(read_text(folder_ / "calibrated/calibration.json"));
    json.erase("wall_s");
    return json;
  }

  static constexpr std::string_view kElectricity = ",electricity,";
};

TEST_F(DepotWithMoreMachines, WhatIsNamedIsInForceUntilItIsReverted) {
  const Json before = calibrate();
  use(one_meter_site());
  // One meter cannot tell new equipment from a wrong scale, so it is told.
  const Outcome found = diagnose("found", {"--apply", "--assume", "equipment_step"});
  ASSERT_EQ(found.exit_code, kSuccess) << found.err;
  const std::string title = "Equipment added or removed";
  EXPECT_THAT(found.out, HasSubstr("Missing from the model: \"" + title + "\""));
  EXPECT_THAT(found.out,
              HasSubstr("Scatter of months in the monthly model: Electricity, daily mean "));
  const Json json = result("found");
  EXPECT_THAT(json["added"], Contains("equipment_step"));
  EXPECT_LT(json["gap"]["epc"]["change"]["electricity_daily_kWh"]["cvrmse"]["q95"], 0.0);
  const std::string version = json["model_version"].get<std::string>().substr(0, 12);
  EXPECT_THAT(found.out, EndsWith("Model version " + version + " is now in force.\n"));
  EXPECT_THAT(run({"model", "list", site()}).out, HasSubstr("* " + version));

  // A diagnosis starts from the drawings, which are not in force.
  expect_refusal("the model already has '" + title + "' (version " + version +
                 "), but a diagnosis starts from the drawings; first run `recald model revert " +
                 site() + " drawings`");

  const Json with = calibrate();
  EXPECT_THAT(with["model_version"].get<std::string>(), StartsWith(version));
  EXPECT_NE(with["before"], before["before"]);

  const Outcome unknown = run({"model", "revert", site(), "0123abcd"});
  EXPECT_EQ(unknown.exit_code, kFailure);
  EXPECT_EQ(unknown.err,
            "recald: the model of site 'depot' has no version '0123abcd'; it has drawings, " +
                version + "\n");
  ASSERT_EQ(run({"model", "revert", site(), "drawings"}).exit_code, kSuccess);
  EXPECT_EQ(calibrate(), before);
}

}  // namespace
}  // namespace recald::daemon
