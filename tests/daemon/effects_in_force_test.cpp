/// A model version with an effect in force: what calibrations and designs make of it, and that a
/// revert takes all of it back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "command_line.hpp"
#include "depot_versions.hpp"
#include "depot_year.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::json;
using diagnosis::AddedEffect;
using metering::Month;
using recald::testing::edited;
using recald::testing::half_missing_setback;
using recald::testing::read_text;
using recald::testing::sample_site;
using recald::testing::write_text;
using std::chrono::year;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::run;

constexpr const char* kShare = "night_setback_missing_missing_share";

std::vector<Month> months(int first, int last) {
  std::vector<Month> all;
  for (int m = first; m <= last; ++m) {
    all.push_back(year{2021} / std::chrono::month{static_cast<unsigned>(m)});
  }
  return all;
}

class EffectsInForce : public ::testing::Test {
 protected:
  EffectsInForce() { recald::testing::write_depot_year(folder_.path()); }

  std::string put_in_force(const AddedEffect& effect) {
    return recald::testing::put_in_force(effect, folder_ / "site.toml");
  }

  [[nodiscard]] std::string path(std::string_view name) const { return (folder_ / name).string(); }

  /// Short chains: these tests are of what goes in and comes out, not of the figures' precision.
  Outcome calibrate(const std::string& out, const std::string& model = "epc", int draws = 1400,
                    int burn_in = 400, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"calibrate",
                                       path("site.toml"),
                                       "--model",
                                       model,
                                       "--out",
                                       path(out),
                                       "--json",
                                       "--sampler",
                                       "dram",
                                       "--draws",
                                       std::to_string(draws),
                                       "--burn-in",
                                       std::to_string(burn_in),
                                       "--chains",
                                       "2",
                                       "--design-runs",
                                       "50"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  [[nodiscard]] Json result(const std::string& out) const {
    return Json::parse(read_text(folder_ / (out + "/calibration.json")));
  }

  recald::testing::TemporaryFolder folder_;
};

std::vector<std::string> names_of(const Json& parameters) {
  std::vector<std::string> names;
  for (const Json& parameter : parameters) names.push_back(parameter["name"]);
  return names;
}

const Json& named(const Json& parameters, const std::string& name) {
  for (const Json& parameter : parameters) {
    if (parameter["name"] == name) return parameter;
  }
  throw std::logic_error("no parameter " + name);
}

/// Without the one figure that differs between equal runs.
std::string without_wall_time(Json json) {
  json.erase("wall_s");
  return json.dump();
}

TEST_F(EffectsInForce, CalibrationHasThemUntilTheyAreReverted) {
  ASSERT_EQ(calibrate("before").exit_code, kSuccess);
  const std::string version = put_in_force(half_missing_setback(months(1, 12)));
  const Outcome with = calibrate("with");
  ASSERT_EQ(with.exit_code, kSuccess) << with.err;
  const Outcome reverted = run({"model", "revert", path("site.toml")});
  ASSERT_EQ(reverted.exit_code, kSuccess) << reverted.err;
  ASSERT_EQ(calibrate("after").exit_code, kSuccess);

  const Json json = result("with");
  EXPECT_EQ(json["model_version"], version);
  EXPECT_EQ(names_of(json["parameters"]),
            (std::vector<std::string>{"occupancy_density", "outdoor_airflow", kShare}));
  EXPECT_THAT(json["warnings"].dump(), HasSubstr("has the effect 'Night set-back missing'"));
  EXPECT_THAT(json["warnings"].dump(), HasSubstr("not calibrated on them again"));
  // All months are of the diagnosis: what it learnt stands, whatever these months would say.
  const Json& share = named(json["parameters"], kShare);
  EXPECT_NEAR(share["mean"].get<double>(), 0.7, 0.005);
  EXPECT_NEAR(share["sd"].get<double>(), 0.2 / std::sqrt(12.0), 0.005);
  // Rooms that stay warm at night need more heat.
  const auto modelled = [](const Json& j) {
    return j["before"]["calibration"]["district_heat_daily_kWh"]["nmbe_sim_minus_meas"]
        .get<double>();
  };
  EXPECT_GT(modelled(json), modelled(result("before")) + 0.01);

  EXPECT_EQ(without_wall_time(result("before")), without_wall_time(result("after")));
  for (const char* file : {"draws_1.csv", "draws_2.csv", "months.csv", "profile.json"}) {
    EXPECT_TRUE(read_text(folder_ / "before" / file) == read_text(folder_ / "after" / file))
        << file;
  }
}

// A cut pools draws that were made at many values of the effect's share; each is predicted with.
TEST_F(EffectsInForce, PooledDrawsHavePredictionsToo) {
  put_in_force(half_missing_setback(months(1, 12)));
  const Outcome outcome = calibrate("cut", "epc", 1400, 400, {"--predictive"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const Json points = Json::parse(read_text(folder_ / "cut/points.json"));
  ASSERT_EQ(points["y"].size(), 9u);  // heat, January to September
  std::istringstream draws{read_text(folder_ / "cut/draws_1.csv")};
  std::string line;
  while (std::getline(draws, line) && line.starts_with('#')) {
  }
  std::vector<std::string> columns;
  std::istringstream head{line};
  for (std::string column; std::getline(head, column, ',');) columns.push_back(column);
  ASSERT_EQ(columns.back(), "log_lik.9");
  ASSERT_EQ(columns[columns.size() - 18], "y_rep.1");
  int rows = 0;
  double measured = 0.0;
  double drawn = 0.0;
  for (; std::getline(draws, line); ++rows) {
    std::vector<double> values;
    std::istringstream row{line};
    for (std::string value; std::getline(row, value, ',');) values.push_back(std::stod(value));
    ASSERT_EQ(values.size(), columns.size());
    for (std::size_t p = 0; p < 9; ++p) {
      measured += points["y"][p].get<double>();
      drawn += values[values.size() - 18 + p];
      EXPECT_TRUE(std::isfinite(values[values.size() - 9 + p]));
    }
  }
  EXPECT_EQ(rows, result("cut")["sampling"]["draws"].get<int>());
  EXPECT_NEAR(drawn / measured, 1.0, 0.1);
}

TEST_F(EffectsInForce, TheSameSeedGivesTheSameCut) {
  put_in_force(half_missing_setback(months(1, 12)));
  ASSERT_EQ(calibrate("one").exit_code, kSuccess);
  ASSERT_EQ(calibrate("two").exit_code, kSuccess);
  EXPECT_TRUE(read_text(folder_ / "one/draws_2.csv") == read_text(folder_ / "two/draws_2.csv"));
}

TEST_F(EffectsInForce, LaterMonthsTeachThem) {
  put_in_force(half_missing_setback({year{2020} / 11, year{2020} / 12}));
  ASSERT_EQ(calibrate("later").exit_code, kSuccess);
  const Json json = result("later");
  EXPECT_THAT(json["warnings"].dump(), HasSubstr("these months teach them further"));
  const Json& share = named(json["parameters"], kShare);
  EXPECT_EQ(share["prior"]["distribution"], "truncated_normal");
  EXPECT_GT(share["sd"].get<double>(), 0.0);
}

TEST_F(EffectsInForce, OfSomeLaterMonthsTheseAloneTeach) {
  put_in_force(half_missing_setback(months(1, 4)));  // calibrated: January to September
  ASSERT_EQ(calibrate("some").exit_code, kSuccess);
  const Json json = result("some");
  EXPECT_THAT(json["warnings"].dump(), HasSubstr("the later ones alone were let teach it further"));
  EXPECT_EQ(json["parameters"].size(), 3u);
}

TEST_F(EffectsInForce, OneLaterMonthCannotTeachThem) {
  put_in_force(half_missing_setback(months(1, 8)));
  ASSERT_EQ(calibrate("one").exit_code, kSuccess);
  const Json json = result("one");
  EXPECT_THAT(json["warnings"].dump(), HasSubstr("the later ones cannot teach it further ("));
  EXPECT_NEAR(named(json["parameters"], kShare)["mean"].get<double>(), 0.7, 0.005);
}

// Effects are told dates, and validation may lie before the months that are calibrated.
TEST_F(EffectsInForce, HourlyValidationMayLieBefore) {
  const std::string backwards =
      edited(edited(sample_site(), "from = \"2021-01\", to = \"2021-09\"",
                    "from = \"2021-06\", to = \"2021-09\""),
             "from = \"2021-10\", to = \"2021-12\"", "from = \"2021-01\", to = \"2021-03\"");
  write_text(folder_ / "site.toml", edited(backwards, "interval = \"15m\"", "interval = \"1h\""));
  put_in_force(half_missing_setback(months(1, 9)));
  const Outcome outcome = calibrate("backwards", "hourly", 120, 60);
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const Json json = result("backwards");
  EXPECT_EQ(json["months"][4]["month"], "2021-01");
  EXPECT_TRUE(json["after"]["validation"]["district_heat_daily_kWh"]["cvrmse"].is_number());
}

TEST_F(EffectsInForce, HourlyCalibrationHasThemToo) {
  // Steps of an hour and few months: the hourly model costs a hundred times the monthly one.
  write_text(folder_ / "site.toml",
             edited(edited(sample_site(), "interval = \"15m\"", "interval = \"1h\""),
                    "to = \"2021-09\"", "to = \"2021-04\""));
  const Outcome without = calibrate("without", "hourly", 120, 60);
  ASSERT_EQ(without.exit_code, kSuccess) << without.err;
  const std::string version = put_in_force(half_missing_setback(months(1, 12)));
  const Outcome with = calibrate("with", "hourly", 120, 60);
  ASSERT_EQ(with.exit_code, kSuccess) << with.err;
  const Json json = result("with");
  EXPECT_EQ(json["model"], "hourly");
  EXPECT_EQ(json["model_version"], version);
  EXPECT_THAT(names_of(json["parameters"]), Contains(kShare));
  EXPECT_TRUE(json["after"]["calibration"].contains("district_heat_peak_kW"));
  EXPECT_NE(json["before"], result("without")["before"]);
}

TEST_F(EffectsInForce, DesignVariesThemAndItsMetaModelHoldsThem) {
  const auto doe = [&](const std::string& out, const std::string& model) {
    return run({"doe", path("site.toml"), "--runs", "50", "--out", path(out), "--model", model});
  };
  ASSERT_EQ(doe("plain", "hourly").exit_code, kSuccess);
  put_in_force(half_missing_setback(months(1, 12)));
  // A design that did not vary the effect says nothing of it.
  for (const char* command : {"metamodel", "calibrate"}) {
    const Outcome refused = run({command, "--doe", path("plain")});
    EXPECT_EQ(refused.exit_code, kFailure);
    EXPECT_EQ(refused.err,
              "recald: metamodel: effect night_setback_missing is not in the design; run `recald "
              "doe` with it.\n");
  }
  EXPECT_EQ(doe("plain", "hourly").exit_code, kFailure);  // another design by now

  const Outcome made = doe("design", "hourly");
  ASSERT_EQ(made.exit_code, kSuccess) << made.err;
  EXPECT_THAT(read_text(folder_ / "design/priors.csv"), HasSubstr(kShare));
  const Outcome fitted = run({"metamodel", "--doe", path("design"), "--json"});
  ASSERT_EQ(fitted.exit_code, kSuccess) << fitted.err;
  EXPECT_THAT(Json::parse(fitted.out)["warnings"].dump(), HasSubstr("held at what was learnt"));
  const Outcome calibrated =
      run({"calibrate", "--doe", path("design"), "--json", "--parameters", "all", "--sampler",
           "dram", "--draws", "1400", "--burn-in", "400", "--chains", "2"});
  ASSERT_EQ(calibrated.exit_code, kSuccess) << calibrated.err;
  const Json json = Json::parse(calibrated.out);
  EXPECT_THAT(names_of(json["parameters"]), ::testing::Not(Contains(kShare)));
  EXPECT_THAT(names_of(json["fixed_parameters"]), Contains(kShare));

  ASSERT_EQ(run({"model", "revert", path("site.toml")}).exit_code, kSuccess);
  const Outcome gone = run({"metamodel", "--doe", path("design")});
  EXPECT_EQ(gone.exit_code, kFailure);
  EXPECT_THAT(gone.err, HasSubstr("of an effect that the model no longer has"));
}

TEST_F(EffectsInForce, AnEffectThatTheProgramDoesNotKnowIsOneSentence) {
  AddedEffect unknown = half_missing_setback(months(1, 12));
  unknown.effect = "poltergeist";
  put_in_force(unknown);
  const Outcome refused = calibrate("refused");
  EXPECT_EQ(refused.exit_code, kFailure);
  EXPECT_THAT(
      refused.err,
      HasSubstr("the model version in force has the effect poltergeist, which the catalogue "
                "does not know; `recald model revert` takes it out\n"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "refused"));
}

}  // namespace
}  // namespace recald::daemon
