/// The commands on a design of experiments, as their user meets them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>

#include "command_line.hpp"
#include "tests/support/sample_design.hpp"
#include "tests/support/sample_site.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using recald::testing::edited;
using recald::testing::read_text;
using recald::testing::write_text;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Outcome;
using testing::run;
using ::testing::UnorderedElementsAre;

std::string without_wall_time(const std::string& text) {
  return std::regex_replace(text, std::regex{"\"wall_s\": [0-9.e-]+"}, "\"wall_s\": _");
}

std::vector<std::string> warnings_of(const Json& json) {
  return json["warnings"].get<std::vector<std::string>>();
}

class DesignCommands : public ::testing::Test {
 protected:
  DesignCommands() { recald::testing::write_sample_design(design()); }

  [[nodiscard]] fs::path design() const { return folder_ / "design"; }
  [[nodiscard]] std::string path(std::string_view name) const { return (folder_ / name).string(); }

  Outcome on_design(const std::string& command, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {command, "--doe", design().string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  Outcome calibrate(std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--sampler", "dram", "--draws", "2000", "--burn-in", "500"});
    return on_design("calibrate", more);
  }
  void change(const char* file, std::string_view from, std::string_view to) {
    write_text(design() / file, edited(read_text(design() / file), from, to));
  }

  recald::testing::TemporaryFolder folder_;
};

TEST_F(DesignCommands, ScreenNamesWhatMatters) {
  const Outcome outcome = on_design("screen", {"--json", "--out", path("out")});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_EQ(read_text(folder_ / "out/screen.json"), outcome.out);
  const Json json = Json::parse(outcome.out);
  EXPECT_THAT(json["influential"].get<std::vector<std::string>>(),
              UnorderedElementsAre("set_point", "air", "people"));
  ASSERT_EQ(json["parameters"].size(), 4U);
  EXPECT_EQ(json["parameters"][0]["name"], "set_point");
  EXPECT_EQ(json["parameters"][0]["unit"], "degC");
  EXPECT_EQ(json["parameters"][0]["frequency"], 1.0);
  EXPECT_NE(json["parameters"][3]["verdict"], "influential");
  EXPECT_TRUE(json["parameters"][0]["effects"].contains("chw_peak_kw"));
  EXPECT_LT(json["parameters"][0]["effects"]["chw_daily_kwh"]["change_least"], 0.0);
  EXPECT_EQ(json["runs"], 60);

  const Outcome table = on_design("screen");
  EXPECT_EQ(table.exit_code, kSuccess);
  EXPECT_THAT(table.out, HasSubstr("3 of 4 are influential: "));
}

TEST_F(DesignCommands, MetamodelOffersBothFormsAndSaysWhichPredicts) {
  const Outcome outcome = on_design("metamodel", {"--json", "--out", path("out")});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_EQ(read_text(folder_ / "out/metamodel.json"), outcome.out);
  const Json json = Json::parse(outcome.out);
  for (const char* key :
       {"form", "patterns", "r2_in_sample", "r2_left_out", "sigma_r", "scaling"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["form"], "monthly");
  EXPECT_GT(json["forms"]["monthly"]["r2_left_out"], json["forms"]["seed"]["r2_left_out"]);
  EXPECT_EQ(json["r2_left_out"], json["forms"]["monthly"]["r2_left_out"]);
  EXPECT_GT(json["sigma_r"]["chw_daily_kwh"], 0.0);
  const Json& pattern = json["patterns"][0];
  EXPECT_EQ(pattern["output"], "chw_daily_kwh");
  EXPECT_EQ(pattern["loadings"].size(), 12U);
  EXPECT_EQ(pattern["lengths"].size(), 4U);

  const Outcome table = on_design("metamodel");
  EXPECT_THAT(table.out,
              HasSubstr("Chosen: monthly: on left-out runs Gaussian processes of the design's "
                        "months"));
  EXPECT_THAT(table.out, HasSubstr("It speaks of the design's months alone"));
}

// A heating set-point counts up to that of cooling, where both are there.
TEST_F(DesignCommands, OneOfTwoSetPointsCanBeChosen) {
  for (const char* file : {"priors.csv", "doe_inputs.csv"}) {
    change(file, "set_point", "cooling_setpoint");
    change(file, "air", "heating_setpoint");
  }
  const Outcome outcome = on_design("metamodel", {"--parameters", "heating_setpoint", "--json"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_GT(Json::parse(outcome.out)["forms"]["monthly"]["r2_left_out"], 0.3);
}

/// Multiplies the peaks of some runs by eight, as a simulation that failed may leave them.
std::string with_wild_peaks(const std::string& outputs, const std::vector<std::string>& runs) {
  std::istringstream lines{outputs};
  std::string text;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t last = line.rfind(',') + 1;
    if (std::ranges::find(runs, line.substr(0, line.find(','))) != runs.end()) {
      line = line.substr(0, last) + std::to_string(8.0 * std::stod(line.substr(last)));
    }
    text += line + "\n";
  }
  return text;
}

TEST_F(DesignCommands, ARunFarFromAllOthersIsToldAndSetAside) {
  const Json sound = Json::parse(on_design("metamodel", {"--json", "--form", "monthly"}).out);
  const std::string outputs = read_text(design() / "doe_outputs.csv");
  write_text(design() / "doe_outputs.csv", with_wild_peaks(outputs, {"17"}));
  const Outcome outcome = on_design("metamodel", {"--json", "--form", "monthly"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_THAT(warnings_of(json),
              Contains(AllOf(HasSubstr("Run 17 is left out: chw_peak_kw in 2020-"),
                             HasSubstr("where the median of all runs is"))));
  EXPECT_EQ(json["runs"], 59);
  EXPECT_NEAR(json["r2_left_out"].get<double>(), sound["r2_left_out"].get<double>(), 0.01);
  EXPECT_NEAR(json["sigma_r"]["chw_peak_kw"].get<double>(),
              sound["sigma_r"]["chw_peak_kw"].get<double>(),
              0.5 * sound["sigma_r"]["chw_peak_kw"].get<double>());
}

// Three times the usual peak is far outside the other runs, and would be inside with the wild one.
TEST_F(DesignCommands, ARunThatIsSetAsideDoesNotWidenTheRange) {
  write_text(design() / "doe_outputs.csv",
             with_wild_peaks(read_text(design() / "doe_outputs.csv"), {"17"}));
  const std::string measured = read_text(design() / "measurements.csv");
  const std::size_t july = measured.find("2020-07,");
  const std::size_t peak = measured.find(',', measured.find(',', july) + 1) + 1;
  const std::size_t end = measured.find(',', peak);
  const double tripled_kW = 3.0 * std::stod(measured.substr(peak, end - peak));
  write_text(design() / "measurements.csv",
             measured.substr(0, peak) + std::to_string(tripled_kW) + measured.substr(end));
  const Outcome calibrated = calibrate({"--json"});
  ASSERT_EQ(calibrated.exit_code, kSuccess) << calibrated.err;
  const Json json = Json::parse(calibrated.out);
  EXPECT_THAT(warnings_of(json), Contains(HasSubstr("Run 17 is left out: ")));
  ASSERT_EQ(json["extrapolation"].size(), 1U);
  EXPECT_EQ(json["extrapolation"][0]["output"], "chw_peak_kw");
  EXPECT_EQ(json["extrapolation"][0]["month"], "2020-07");
}

TEST_F(DesignCommands, ManyRunsFarFromTheOthersAreNoAccident) {
  const std::string outputs = read_text(design() / "doe_outputs.csv");
  write_text(design() / "doe_outputs.csv",
             with_wild_peaks(outputs, {"3", "8", "13", "21", "34", "40", "55"}));
  const Json json = Json::parse(on_design("metamodel", {"--json", "--form", "monthly"}).out);
  EXPECT_EQ(json["runs"], 60);
  EXPECT_THAT(warnings_of(json), Contains(HasSubstr("7 of 60 runs stand far from the others")));
}

TEST_F(DesignCommands, TheSeedsFormIsOneOptionAway) {
  const Outcome outcome = on_design("metamodel", {"--form", "seed", "--json"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["form"], "seed");
  EXPECT_THAT(json["why"].get<std::string>(), HasSubstr("the first was asked for"));
  EXPECT_TRUE(json["scaling"]["inputs"].contains("winddir_sin"));
  EXPECT_EQ(json["terms"][0]["meter"], "chw");
  const Json degrees = Json::parse(
      on_design("metamodel", {"--form", "seed", "--wind-direction", "degrees", "--json"}).out);
  EXPECT_TRUE(degrees["scaling"]["inputs"].contains("winddir"));
}

TEST_F(DesignCommands, MetamodelOfSomeParameters) {
  const Outcome outcome = on_design("metamodel", {"--parameters", "air, people", "--json"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_EQ(Json::parse(outcome.out)["scaling"]["parameters"].size(), 2U);
  EXPECT_EQ(on_design("metamodel", {"--parameters", "air,peple"}).err,
            "recald: the design has no parameter 'peple'; did you mean 'people'?\n");
  EXPECT_EQ(on_design("metamodel", {"--parameters", "air,air"}).err,
            "recald: 'air,air' names a parameter twice\n");
}

TEST_F(DesignCommands, CalibrationLeavesItsContract) {
  const Outcome outcome = calibrate({"--json", "--out", path("out")});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_EQ(read_text(folder_ / "out/calibration.json"), outcome.out);
  for (const char* file : {"draws_1.csv", "draws_4.csv", "screen.json", "metamodel.json",
                           "months.csv", "report.html"}) {
    EXPECT_TRUE(fs::exists(folder_ / "out" / file)) << file;
  }
  const Json json = Json::parse(outcome.out);
  for (const char* key : {"model", "months", "parameters", "hyperparameters", "before",
                          "prior_mean", "after", "guideline14", "extrapolation", "warnings",
                          "sampler", "seed", "data_revision", "model_version", "wall_s"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["model"], "metamodel");
  EXPECT_EQ(json["chains"], 4);
  EXPECT_EQ(json["months"].size(), 15U);
  EXPECT_EQ(json["months"][11]["role"], "calibration");
  EXPECT_EQ(json["months"][12]["role"], "validation");
  ASSERT_EQ(json["parameters"].size(), 3U);
  ASSERT_EQ(json["fixed_parameters"].size(), 1U);
  EXPECT_EQ(json["fixed_parameters"][0]["name"], "paint");
  EXPECT_EQ(json["fixed_parameters"][0]["value"], 1.0);
  EXPECT_EQ(json["metamodel"]["form"], "monthly");
  EXPECT_EQ(json["outputs"][1]["unit"], "kW");
  EXPECT_TRUE(json["outputs"][1]["months"][0].contains("measured_kW"));
  for (const char* stage : {"before", "prior_mean", "after"}) {
    for (const char* period : {"calibration", "validation"}) {
      for (const char* output : {"chw_daily_kwh", "chw_peak_kw"}) {
        const Json& metrics = json[stage][period][output];
        EXPECT_EQ(metrics["nmbe_g14"].get<double>(), -metrics["nmbe_sim_minus_meas"].get<double>());
      }
    }
  }
  EXPECT_THAT(warnings_of(json),
              Contains(HasSubstr(
                  "January 2021 to March 2021 are not in the design: the bands there are too "
                  "narrow. The monthly form says nothing of these months")));
}

// The page and the months of a site's calibration, as far as the folder knows them.
TEST_F(DesignCommands, CalibrationHasAPageAndItsMonths) {
  ASSERT_EQ(calibrate({"--out", path("out")}).exit_code, kSuccess);
  const std::string page = read_text(folder_ / "out/report.html");
  EXPECT_THAT(page, HasSubstr("<h1>Calibration of design</h1>"));
  EXPECT_THAT(page, HasSubstr("<strong>Chw peak</strong>"));  // the verdict of Guideline 14
  EXPECT_THAT(page, HasSubstr("Chw: daily mean of each month, kWh/day"));
  EXPECT_THAT(page, HasSubstr("class=\"code\">set_point<"));
  EXPECT_THAT(page, ::testing::Not(HasSubstr("recald diagnose")));
  std::istringstream months{read_text(folder_ / "out/months.csv")};
  std::istringstream measured{read_text(design() / "measurements.csv")};
  std::string line;
  std::getline(months, line);
  EXPECT_EQ(line,
            "month,meter,value,unit,coverage,filled_share,peak_kW,peak_at,method,usable,different,"
            "revision,tzdata,estimated_share,value_sd");
  std::getline(measured, line);
  int count = 0;
  for (std::string figures; std::getline(measured, figures); ++count) {
    ASSERT_TRUE(std::getline(months, line));
    const std::regex columns{"([^,]*),([^,]*),([^,]*),.*"};
    std::smatch of;
    ASSERT_TRUE(std::regex_match(figures, of, columns));
    const auto rounded = [](const std::string& number) {
      std::ostringstream text;  // six digits
      text << std::stod(number);
      return text.str();
    };
    EXPECT_EQ(line, of[1].str() + ",chw," + rounded(of[2]) + ",kWh/day,,," + rounded(of[3]) +
                        ",,,yes,,,,,");
  }
  EXPECT_EQ(count, 15);
}

TEST_F(DesignCommands, MonthsMayBeNumbers) {
  for (const char* file : {"doe_outputs.csv", "inputs.csv", "measurements.csv"}) {
    std::string text = read_text(design() / file);
    const auto months = recald::testing::sample_months(15);
    for (std::size_t i = 0; i < months.size(); ++i) {
      text = std::regex_replace(text, std::regex{months[i].name}, std::to_string(i + 1));
    }
    write_text(design() / file, text);
  }
  ASSERT_EQ(calibrate({"--out", path("out")}).exit_code, kSuccess);
  EXPECT_THAT(read_text(folder_ / "out/months.csv"), HasSubstr("\n15,chw,"));
  const std::string page = read_text(folder_ / "out/report.html");
  EXPECT_THAT(page, HasSubstr("Month 15"));
  EXPECT_THAT(page, HasSubstr("\"month\":\"15\""));
}

// Noise of 2 % on a simulation that the meta-model knows: the data must bring the model closer, and
// the truth must not be far out.
TEST_F(DesignCommands, CalibrationFindsTheTruth) {
  const Json json = Json::parse(calibrate({"--json"}).out);
  EXPECT_LT(json["after"]["calibration"]["chw_daily_kwh"]["cvrmse"],
            json["before"]["calibration"]["chw_daily_kwh"]["cvrmse"]);
  EXPECT_LT(json["after"]["calibration"]["chw_daily_kwh"]["cvrmse"], 0.05);
  for (std::size_t j = 0; j < 3; ++j) {
    const Json& parameter = json["parameters"][j];
    SCOPED_TRACE(parameter["name"].get<std::string>());
    const double away = recald::testing::kSampleTruth[j] - parameter["mean"].get<double>();
    EXPECT_LT(std::abs(away), 3.0 * parameter["sd"].get<double>());
  }
  EXPECT_GT(json["parameters"][1]["contraction"], 0.5);
}

TEST_F(DesignCommands, CalibrationRepeatsItself) {
  ::setenv("SOURCE_DATE_EPOCH", "1600000000", 1);  // the page says when it was made
  const Outcome one = calibrate({"--threads", "1", "--out", path("one")});
  const Outcome two = calibrate({"--threads", "2", "--out", path("two")});
  ::unsetenv("SOURCE_DATE_EPOCH");
  ASSERT_EQ(one.exit_code, kSuccess) << one.err;
  EXPECT_EQ(one.out, two.out);
  for (const auto& entry : fs::directory_iterator(folder_ / "one")) {
    const std::string name = entry.path().filename();
    EXPECT_TRUE(without_wall_time(read_text(entry.path())) ==
                without_wall_time(read_text(folder_ / "two" / name)))
        << name;
  }
  EXPECT_THAT(one.out, AllOf(HasSubstr("Chw, monthly peak"), HasSubstr("validation months"),
                             HasSubstr("Meta-model, form monthly: "),
                             HasSubstr("Held at their prior means")));
}

TEST_F(DesignCommands, OtherMeasurementsMayTakeTheirPlace) {
  std::string text = "month,chw_peak_kw\n";
  for (const auto& month : recald::testing::sample_months(9)) {
    text += month.name + ",120\n";
  }
  write_text(folder_ / "other.csv", text);
  const Outcome outcome = calibrate({"--measurements", path("other.csv"), "--json"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const Json json = Json::parse(outcome.out);
  ASSERT_EQ(json["outputs"].size(), 1U);
  EXPECT_EQ(json["outputs"][0]["name"], "chw_peak_kw");
  EXPECT_EQ(json["months"].size(), 12U);
  EXPECT_THAT(warnings_of(json), Contains(HasSubstr("chw_daily_kwh is not measured in '")));
}

TEST_F(DesignCommands, ParametersMayBeChosenByName) {
  const Outcome outcome = calibrate({"--parameters", "air,paint", "--json"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["parameters"][0]["name"], "air");
  EXPECT_EQ(json["parameters"][1]["name"], "paint");
  EXPECT_EQ(json["fixed_parameters"].size(), 2U);
  EXPECT_EQ(Json::parse(calibrate({"--parameters", "all", "--json"}).out)["parameters"].size(), 4U);
}

// What is held fixed is not taken for known: the others come out as if it had been calibrated too,
// since the outputs are nearly linear in it. Without its direction among the errors the air would
// make up for a set-point that is a degree off.
TEST_F(DesignCommands, FixedParametersAreMarginalised) {
  const Json all = Json::parse(calibrate({"--parameters", "all", "--json"}).out);
  const Json some = Json::parse(calibrate({"--parameters", "air,people", "--json"}).out);
  for (std::size_t j = 0; j < 2; ++j) {
    const Json& with = all["parameters"][j + 1];
    const Json& without = some["parameters"][j];
    ASSERT_EQ(with["name"], without["name"]);
    const double sd = with["sd"];
    EXPECT_NEAR(without["mean"], with["mean"].get<double>(), 0.25 * sd);
    EXPECT_NEAR(without["sd"], sd, 0.15 * sd);
  }
}

TEST_F(DesignCommands, AGivenMetamodelIsTakenAsItIs) {
  write_text(folder_ / "given.csv",
             "term,coef\n(Intercept),0.1\ndrybulb,0.5\nout,0.05\nair,0.2\nair:drybulb,0.3\n"
             "set_point,-0.1\n");
  const Outcome outcome = calibrate({"--metamodel", path("given.csv"), "--json"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["metamodel"]["form"], "given");
  EXPECT_EQ(json["metamodel"]["sigma_r"], Json::object());
  EXPECT_EQ(json["parameters"].size(), 4U);  // also the two that it does not contain
  EXPECT_EQ(json["months"].size(), 15U);
  // Not in the meta-model: nothing but its prior can come out.
  EXPECT_NEAR(json["parameters"][3]["sd"].get<double>(), 0.1 / std::sqrt(6.0), 0.004);
}

TEST_F(DesignCommands, AGivenMetamodelHasToFitTheDesign) {
  write_text(folder_ / "given.csv", "term,coef\nair,1\nhumidity,2\n");
  const Outcome unknown = calibrate({"--metamodel", path("given.csv")});
  EXPECT_EQ(unknown.exit_code, kFailure);
  EXPECT_THAT(unknown.err, AllOf(HasSubstr("given.csv': "), HasSubstr("'humidity'")));
  write_text(folder_ / "given.csv", "term,coef\nair,1\n");
  change("priors.csv", "air,m3/s,0.5,2,3\n", "air,m3/s,0.5,2,\n");
  change("priors.csv", "min,mode,max\n", "min,mode,max,distribution,sd\n");
  std::string priors = read_text(design() / "priors.csv");
  priors = std::regex_replace(priors, std::regex{"(set_point.*|people.*|paint.*)\n"}, "$1,,\n");
  write_text(design() / "priors.csv", edited(priors, "0.5,2,\n", "0.5,2,,truncated_normal,1\n"));
  const Outcome endless = calibrate({"--metamodel", path("given.csv")});
  EXPECT_EQ(endless.exit_code, kFailure);
  EXPECT_EQ(endless.err,
            "recald: a given meta-model needs the prior of 'air' to have both ends: they are what "
            "it calls 0 and 1\n");
}

TEST_F(DesignCommands, HyperPriorsMayComeFromAFile) {
  write_text(folder_ / "beliefs.toml",
             "[discrepancy]\nshape = 10\nrate = 0.3\n[error]\nshape = 10\nrate = 0.03\n");
  const Outcome own = calibrate({"--hyper-prior", path("beliefs.toml"), "--json"});
  ASSERT_EQ(own.exit_code, kSuccess) << own.err;
  const Json json = Json::parse(own.out);
  EXPECT_EQ(json["hyper_prior"], "custom");
  // stan2018 has the same numbers, so the same draws must come out.
  const Json profile = Json::parse(calibrate({"--hyper-prior", "stan2018", "--json"}).out);
  EXPECT_EQ(json["parameters"], profile["parameters"]);
  write_text(folder_ / "beliefs.toml", "[discrepancy]\nshape = 10\n");
  const Outcome wrong = calibrate({"--hyper-prior", path("beliefs.toml")});
  EXPECT_EQ(wrong.exit_code, kFailure);
  EXPECT_EQ(wrong.err,
            "recald: beliefs.toml:1: [discrepancy] 'rate' is missing\n"
            "recald: beliefs.toml:1: [error] with shape and rate is missing\n");
}

TEST_F(DesignCommands, WrongUsageIsTwo) {
  const std::string doe = design().string();
  const std::vector<std::vector<std::string>> misuses = {
      {"screen"},
      {"metamodel", "--form", "seed"},
      {"metamodel", "--doe", doe, "--form", "weekly"},
      {"calibrate"},
      {"calibrate", "site.toml", "--doe", doe},
      {"calibrate", "site.toml", "--form", "seed"},
      {"calibrate", "site.toml", "--model", "metamodel"},
      {"calibrate", "--doe", doe, "--model", "epc"},
      {"calibrate", "--doe", doe, "--metamodel", "a.csv", "--parameters", "air"},
      {"calibrate", "--doe", doe, "--metamodel", "a.csv", "--form", "seed"},
      {"calibrate", "--doe", doe, "--predictive"},
      {"calibrate", "--doe", doe, "--hyper-prior", "none"},
      {"calibrate", "--doe", doe, "--sampler", "dram", "--draws", "200", "--burn-in", "300"},
      {"doe", "site.toml", "--corners", "--runs", "1"},
      {"doe", "site.toml", "--out", "x", "--priors", "--corners"},
      {"doe", "site.toml", "--out", "x", "--runs", "3"},
  };
  for (const auto& arguments : misuses) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, kUsage) << ::testing::PrintToString(arguments) << outcome.err;
    EXPECT_THAT(outcome.out, IsEmpty());
    EXPECT_THAT(outcome.err, ::testing::Not(IsEmpty()));
  }
}

TEST_F(DesignCommands, ABadFolderIsOneSentenceAndLeavesNothing) {
  change("doe_inputs.csv", "run,set_point", "run,setpoint");
  for (const char* command : {"screen", "metamodel", "calibrate"}) {
    const Outcome outcome = on_design(command, {"--out", path("out")});
    EXPECT_EQ(outcome.exit_code, kFailure);
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("doe_inputs.csv': column 'set_point' is missing (is it "
                                       "'setpoint'?)"));
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  }
}

TEST_F(DesignCommands, CollinearParametersAreNamed) {
  std::string text = "run,set_point,air,people,paint\n";
  for (int i = 1; i <= 60; ++i) {
    const std::string air = std::to_string(0.5 + 0.04 * i);
    text += std::to_string(i) + "," + std::to_string(20.0 + std::fmod(1.7 * i, 6.0)) + "," + air +
            "," + std::to_string(std::fmod(0.037 * i, 0.1)) + "," +
            std::to_string(0.9 + (0.04 * i) / 12.0) + "\n";
  }
  write_text(design() / "doe_inputs.csv", text);
  const Outcome outcome = on_design("metamodel");
  EXPECT_EQ(outcome.exit_code, kFailure);
  EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("paint"));
}

TEST_F(DesignCommands, MeasurementsOutsideTheDesignAreNamed) {
  const std::string text = read_text(design() / "measurements.csv");
  const std::size_t july = text.find("2020-07,");
  write_text(design() / "measurements.csv",
             text.substr(0, july) + "2020-07,99999,150,high" + text.substr(text.find('\n', july)));
  const Json json = Json::parse(calibrate({"--json"}).out);
  ASSERT_EQ(json["extrapolation"].size(), 1U);
  EXPECT_EQ(json["extrapolation"][0]["output"], "chw_daily_kwh");
  EXPECT_EQ(json["extrapolation"][0]["month"], "2020-07");
  EXPECT_EQ(json["extrapolation"][0]["value"], 99999.0);
}

}  // namespace
}  // namespace recald::daemon
