/// `recald doe`: a small site's model over a Latin hypercube, and the commands that live on it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "command_line.hpp"
#include "core/metering/civil_time.hpp"
#include "tests/support/sample_site.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::json;
using metering::Instant;
using recald::testing::edited;
using recald::testing::read_text;
using recald::testing::sample_site;
using recald::testing::write_text;
using std::chrono::hours;
using std::chrono::sys_days;
using std::chrono::year;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::run;

constexpr const char* kFiles[] = {"priors.csv", "doe_inputs.csv",   "doe_outputs.csv",
                                  "inputs.csv", "measurements.csv", "design.json"};

/// The depot's 2021: a plain year's temperatures, heat that follows them, lights by day.
class DoeCommand : public ::testing::Test {
 protected:
  DoeCommand() {
    std::string readings = "timestamp,meter,value,unit\n";
    std::string weather =
        "timestamp,dry_bulb_C,rel_humidity_pct,wind_speed_m_s,wind_dir_deg,ghi_W_m2\n";
    const Instant begin = sys_days{year{2020} / 12 / 31} + hours{23};
    for (int h = 0; h < 8760; ++h) {
      const std::string stamp = metering::to_string(begin + hours{h});
      const double day = h / 24.0;
      const double sun =
          std::max(0.0, -std::cos(h * 0.2618)) * (350.0 - 250.0 * std::cos(day * 0.01721));
      const double dry_bulb = 9.5 - 10.0 * std::cos((day - 20.0) * 0.01721) +
                              3.0 * std::sin(day * 0.7) - 3.0 * std::cos((h - 3) * 0.2618);
      const bool open = h % 24 >= 7 && h % 24 < 19;
      // No two hours alike: a meter that stands still is not believed.
      const double wiggle = std::sin(1.3 * h);
      readings += stamp + ",electricity," + std::to_string((open ? 52.0 : 11.0) + wiggle) + ",kW\n";
      readings += stamp + ",heat," +
                  std::to_string(std::max(2.0, 5.2 * (15.5 - dry_bulb)) + 0.3 * wiggle) + ",kWh\n";
      weather += stamp + "," + std::to_string(dry_bulb) + "," +
                 std::to_string(72.0 + 12.0 * std::cos(day * 0.31)) + "," +
                 std::to_string(2.5 + std::sin(day * 0.23)) + "," +
                 std::to_string(std::fmod(180.0 + 90.0 * std::sin(day * 0.11), 360.0)) + "," +
                 std::to_string(sun) + "\n";
    }
    write_text(folder_ / "readings.csv", readings);
    write_text(folder_ / "weather.csv", weather);
    write_text(folder_ / "site.toml", sample_site());
  }

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
  EXPECT_THAT(again.out, HasSubstr("; 20 of them were there already.\n"));
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
                "' holds a design that was made with another seed or number of runs; delete it, or "
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
