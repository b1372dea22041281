/// A site with an EnergyPlus model, calibrated on runs that are there: no program is needed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

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
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::run;

constexpr std::string_view kBuiltIn =
    "kind = \"epc\"\noutputs = [\"electricity\", \"district_heat\"]";
constexpr std::string_view kEnergyPlus =
    "kind = \"energyplus\"\nfile = \"depot.epJSON\"\nprogram = \"nowhere\"\n"
    "outputs = [\"district_heat\"]\ndesign = \"runs\"\n"
    "reports = { district_heat = \"HeatingCoils:EnergyTransfer\" }";

/// The runs are the hourly model's, of the same parameters: what is calibrated is a folder.
class EnergyPlusSite : public ::testing::Test {
 protected:
  EnergyPlusSite() {
    std::string site =
        edited(sample_site(), "validation = { from = \"2021-10\", to = \"2021-12\" }", "");
    site = edited(site, "to = \"2021-09\"", "to = \"2021-12\"");
    recald::testing::write_depot_year(folder_.path(), site);
    site_ = edited(edited(site, kBuiltIn, kEnergyPlus), "weights = { district_heat = 0.8 }", "");
    // The drawings' value, which the library of an EnergyPlus model reads in the model.
    site_ = edited(site_, "name = \"occupancy_density\"",
                   "name = \"occupancy_density\"\nprior = [0, 0.05, 0.1]");
  }

  void make_runs() {
    const Outcome made =
        run({"doe", path("site.toml"), "--model", "hourly", "--runs", "40", "--out", path("runs")});
    ASSERT_EQ(made.exit_code, kSuccess) << made.err;
    write_text(folder_ / "site.toml", site_);
  }
  [[nodiscard]] std::string path(std::string_view name) const { return (folder_ / name).string(); }

  recald::testing::TemporaryFolder folder_;
  std::string site_;
};

TEST_F(EnergyPlusSite, IsCalibratedOnItsRuns) {
  make_runs();
  const Outcome done = run({"calibrate", path("site.toml"), "--json", "--out", path("out")});
  ASSERT_EQ(done.exit_code, kSuccess) << done.err;
  const Json result = Json::parse(done.out);
  EXPECT_EQ(result["model"], "energyplus");
  EXPECT_EQ(result["status"], "converged");
  EXPECT_EQ(result["metamodel"]["form"], "monthly");
  EXPECT_GT(result["metamodel"]["r2_left_out"], 0.99);
  EXPECT_EQ(result["parameters"].back()["name"], "outdoor_airflow");
  EXPECT_FALSE(result["after"]["calibration"]["district_heat_peak_kW"]["cvrmse"].is_null());
  EXPECT_FALSE(result["yardstick"].is_null());
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/screen.json"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/metamodel.json"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/profile.json"));
  EXPECT_THAT(read_text(folder_ / "out/report.html"), HasSubstr("Outdoor airflow rate"));
}

TEST_F(EnergyPlusSite, IsComparedWithTheMonthlyModel) {
  make_runs();
  write_text(folder_ / "site.toml",
             site_ +
                 "\n[[model]]\nkind = \"epc\"\noutputs = [\"electricity\", \"district_heat\"]\n"
                 "[[model.parameter]]\nname = \"outdoor_airflow\"\n");
  const Outcome done = run({"calibrate", path("site.toml"), "--out", path("out")});
  ASSERT_EQ(done.exit_code, kSuccess) << done.err;
  EXPECT_THAT(done.out, HasSubstr("Models beside each other"));
  const Json compared = Json::parse(read_text(folder_ / "out/comparison.json"))["models"];
  ASSERT_EQ(compared.size(), 2U);
  EXPECT_EQ(compared[0]["model"], "energyplus");
  EXPECT_EQ(compared[1]["model"], "epc");
  for (const Json& model : compared) {
    const Json heat = model["outputs"]["district_heat_daily_kWh"];
    EXPECT_GT(heat["after"]["calibration"]["cvrmse"], 0.0) << model["model"];
  }
  EXPECT_THAT(read_text(folder_ / "out/report.html"), HasSubstr("Which model tells more?"));
  EXPECT_EQ(Json::parse(read_text(folder_ / "out/calibration.json"))["model"], "energyplus");
  EXPECT_EQ(Json::parse(read_text(folder_ / "out/epc/calibration.json"))["model"], "epc");
  // One of them alone, as ever.
  EXPECT_EQ(
      Json::parse(run({"calibrate", path("site.toml"), "--model", "epc", "--json"}).out)["model"],
      "epc");
}

TEST_F(EnergyPlusSite, OtherRunsOnTheSameParametersAreAnotherRevision) {
  make_runs();
  const auto revision = [&] {
    const Outcome done = run({"calibrate", path("site.toml"), "--json"});
    return Json::parse(done.out)["data_revision"].get<std::string>();
  };
  const std::string first = revision();
  EXPECT_EQ(revision(), first);
  std::string outputs = read_text(folder_ / "runs/doe_outputs.csv");
  write_text(folder_ / "runs/doe_outputs.csv", "# by hand\n" + outputs);
  EXPECT_NE(revision(), first);
}

TEST_F(EnergyPlusSite, DriftForecastsEachMonthOnTheRuns) {
  make_runs();
  const Outcome done =
      run({"drift", path("site.toml"), "--learn", "8", "--particles", "128", "--json"});
  ASSERT_EQ(done.exit_code, kSuccess) << done.err;
  EXPECT_EQ(Json::parse(done.out)["months"].size(), 12U);
}

TEST_F(EnergyPlusSite, WithoutRunsAndProgramSaysWhatToDo) {
  write_text(folder_ / "site.toml", site_);
  EXPECT_THAT(run({"calibrate", path("site.toml")}).err,
              HasSubstr("there is no EnergyPlus at " + path("nowhere")));
  EXPECT_THAT(run({"drift", path("site.toml"), "--learn", "8"}).err,
              HasSubstr("there are no runs of the EnergyPlus model"));
}

TEST_F(EnergyPlusSite, RunsForOtherParametersAreNotUsed) {
  make_runs();
  write_text(folder_ / "site.toml", edited(site_, "mode = 2.0", "mode = 2.1"));
  EXPECT_THAT(
      run({"calibrate", path("site.toml")}).err,
      HasSubstr("vary outdoor_airflow from 0.8 to 2.6, but the site file asks for something "
                "else"));
}

TEST_F(EnergyPlusSite, FailedRunsAreLeftOutAndTold) {
  make_runs();
  std::string outputs;
  std::string all = read_text(folder_ / "runs/doe_outputs.csv");
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t end = all.find('\n', begin) + 1;
    const std::string line = all.substr(begin, end - begin);
    if (!line.starts_with("7,")) outputs += line;
    begin = end;
  }
  write_text(folder_ / "runs/doe_outputs.csv", outputs);
  write_text(folder_ / "runs/failed.csv", "run,because\n7,EnergyPlus says: the roof is gone\n");
  const Outcome done = run({"calibrate", path("site.toml"), "--json"});
  ASSERT_EQ(done.exit_code, kSuccess) << done.err;
  EXPECT_THAT(Json::parse(done.out)["warnings"].dump(),
              HasSubstr("1 of 40 runs failed and are left out; run 7: EnergyPlus says: the roof"));
}

TEST_F(EnergyPlusSite, WithoutABuildingThereIsNothingToDiagnose) {
  make_runs();
  const std::size_t building = site_.find("[building]");
  write_text(folder_ / "site.toml", site_.substr(0, building));
  EXPECT_EQ(run({"calibrate", path("site.toml")}).exit_code, kSuccess);
  EXPECT_THAT(run({"diagnose", path("site.toml")}).err,
              HasSubstr("has no [[model]] of kind \"hourly\", which needs a [building]"));
  EXPECT_THAT(run({"profile", path("site.toml")}).err, HasSubstr("has no [building]"));
}

}  // namespace
}  // namespace recald::daemon
