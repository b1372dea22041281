/// `recald doe`: a small site's model over a design, and the commands that live on it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "depot_year.hpp"
#include "tests/support/sample_site.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::json;
using recald::testing::edited;
using recald::testing::read_text;
using recald::testing::sample_site;
using recald::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::run;

constexpr const char* kFiles[] = {"priors.csv", "doe_inputs.csv",   "doe_outputs.csv",
                                  "inputs.csv", "measurements.csv", "design.json"};

class DoeCommand : public ::testing::Test {
 protected:
  DoeCommand() { recald::testing::write_depot_year(folder_.path()); }

  [[nodiscard]] std::string path(std::string_view name) const { return (folder_ / name).string(); }
  Outcome doe(const std::string& out, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"doe", path("site.toml"), "--runs",
                                          "50",  "--out",           path(out)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  recald::testing::TemporaryFolder folder_;
};

TEST_F(DoeCommand, LeavesAFolderThatTheOthersWorkOn) {
  const Outcome made = doe("design", {"--json"});
  ASSERT_EQ(made.exit_code, kSuccess) << made.err;
  const Json json = Json::parse(made.out);
  EXPECT_EQ(json["runs"], 50);
  EXPECT_EQ(json["runs_before"], 0);
  EXPECT_EQ(json["months"], 9);

  const Outcome screen = run({"screen", "--doe", path("design"), "--json"});
  ASSERT_EQ(screen.exit_code, kSuccess) << screen.err;
  EXPECT_THAT(Json::parse(screen.out)["influential"].get<std::vector<std::string>>(),
              ::testing::Contains("outdoor_airflow"));
  const Outcome metamodel = run({"metamodel", "--doe", path("design"), "--json"});
  ASSERT_EQ(metamodel.exit_code, kSuccess) << metamodel.err;
  EXPECT_GT(Json::parse(metamodel.out)["r2_left_out"], 0.95);
  const Outcome calibrated =
      run({"calibrate", "--doe", path("design"), "--json", "--out", path("out")});
  ASSERT_EQ(calibrated.exit_code, kSuccess) << calibrated.err;
  const Json result = Json::parse(calibrated.out);
  EXPECT_EQ(result["months"].size(), 12U);  // October to December validate
  EXPECT_EQ(result["months"][9]["role"], "validation");
  EXPECT_EQ(result["status"], "converged");
  EXPECT_EQ(result["model"], "metamodel");
  EXPECT_EQ(result["metamodel"]["form"], "monthly");
  EXPECT_FALSE(result["after"]["validation"]["district_heat_daily_kWh"]["cvrmse"].is_null());
}

TEST_F(DoeCommand, ADesignCanBeContinued) {
  const auto runs = [&](const char* count, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"doe",   path("site.toml"), "--runs", count,
                                          "--out", path("design"),    "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  ASSERT_EQ(runs("200").exit_code, kSuccess);
  const std::string before = read_text(folder_ / "design/doe_outputs.csv");
  const Outcome more = runs("240");
  ASSERT_EQ(more.exit_code, kSuccess) << more.err;
  EXPECT_EQ(Json::parse(more.out)["runs_before"], 200);
  EXPECT_EQ(Json::parse(more.out)["runs"], 240);
  EXPECT_THAT(read_text(folder_ / "design/doe_outputs.csv"), ::testing::StartsWith(before));
  EXPECT_EQ(runs("240", {"--seed", "2"}).exit_code, kFailure);
}

/// Lines of a file without the run's number.
std::set<std::string> values_of_runs(const std::string& text) {
  std::set<std::string> rows;
  std::istringstream lines{text};
  for (std::string line; std::getline(lines, line);) rows.insert(line.substr(line.find(',')));
  return rows;
}

TEST_F(DoeCommand, RunsFromThePriorsAreNoneOfTheDesign) {
  ASSERT_EQ(doe("design").exit_code, kSuccess);
  const Outcome made =
      run({"doe", path("site.toml"), "--priors", "--runs", "25", "--out", path("truths")});
  ASSERT_EQ(made.exit_code, kSuccess) << made.err;
  const auto design = values_of_runs(read_text(folder_ / "design/doe_inputs.csv"));
  const auto truths = values_of_runs(read_text(folder_ / "truths/doe_inputs.csv"));
  std::vector<std::string> common;
  std::ranges::set_intersection(design, truths, std::back_inserter(common));
  EXPECT_EQ(common.size(), 1U);  // the header
  EXPECT_EQ(truths.size(), 26U);
}

TEST_F(DoeCommand, CornersOfThePriorsCheckTheMetaModel) {
  ASSERT_EQ(doe("design").exit_code, kSuccess);
  ASSERT_EQ(doe("corners", {"--corners"}).exit_code, kSuccess);
  const Outcome checked =
      run({"metamodel", "--doe", path("design"), "--check", path("corners"), "--json"});
  ASSERT_EQ(checked.exit_code, kSuccess) << checked.err;
  const Json heat = Json::parse(checked.out)["check"]["district_heat_daily_kWh"];
  EXPECT_LT(heat["cvrmse"], 0.3);
  EXPECT_GT(heat["cvrmse"], 0.0);
  EXPECT_THAT(run({"metamodel", "--doe", path("design"), "--check", path("corners")}).out,
              HasSubstr("runs to check"));
  ASSERT_EQ(doe("hourly", {"--model", "hourly"}).exit_code, kSuccess);
  EXPECT_THAT(run({"metamodel", "--doe", path("design"), "--check", path("hourly")}).err,
              HasSubstr("of other parameters, outputs or months"));
}

TEST_F(DoeCommand, TheSameSeedGivesTheSameBytes) {
  ASSERT_EQ(doe("one", {"--threads", "1"}).exit_code, kSuccess);
  ASSERT_EQ(doe("two", {"--threads", "2"}).exit_code, kSuccess);
  ASSERT_EQ(doe("other", {"--seed", "2"}).exit_code, kSuccess);
  for (const char* file : kFiles) {
    EXPECT_TRUE(read_text(folder_ / "one" / file) == read_text(folder_ / "two" / file)) << file;
  }
  EXPECT_NE(read_text(folder_ / "one/doe_inputs.csv"), read_text(folder_ / "other/doe_inputs.csv"));
}

TEST_F(DoeCommand, GoesOnWhereItStopped) {
  ASSERT_EQ(doe("whole").exit_code, kSuccess);
  ASSERT_EQ(doe("cut").exit_code, kSuccess);
  const std::string outputs = read_text(folder_ / "cut/doe_outputs.csv");
  // As it stands after the first batch: twenty runs.
  write_text(folder_ / "cut/doe_outputs.csv", outputs.substr(0, outputs.find("\n21,") + 1));
  const Outcome again = doe("cut");
  ASSERT_EQ(again.exit_code, kSuccess) << again.err;
  EXPECT_THAT(again.out, HasSubstr("; 20 of them already existed.\n"));
  for (const char* file : kFiles) {
    EXPECT_TRUE(read_text(folder_ / "whole" / file) == read_text(folder_ / "cut" / file)) << file;
  }
}

TEST_F(DoeCommand, RefusesTheFolderOfAnotherDesign) {
  ASSERT_EQ(doe("design").exit_code, kSuccess);
  const std::string before = read_text(folder_ / "design/doe_outputs.csv");
  const Outcome seed = doe("design", {"--seed", "2"});
  EXPECT_EQ(seed.exit_code, kFailure);
  EXPECT_EQ(seed.err.substr(seed.err.find("recald: ")),
            "recald: '" + path("design") +
                "' holds a design that has other runs: by another seed or number, by --priors or "
                "--corners, or by another version; delete it, or "
                "give another --out\n");
  write_text(folder_ / "site.toml", edited(sample_site(), "max = 2.6", "max = 2.8"));
  EXPECT_THAT(doe("design").err, HasSubstr("holds a design that was made for other priors;"));
  write_text(folder_ / "site.toml", edited(sample_site(), "efficiency = 0.95", "efficiency = 0.9"));
  EXPECT_THAT(doe("design").err,
              HasSubstr("was made from another site file, other readings or weather, or by another "
                        "version;"));
  EXPECT_EQ(read_text(folder_ / "design/doe_outputs.csv"), before);
}

}  // namespace
}  // namespace recald::daemon
