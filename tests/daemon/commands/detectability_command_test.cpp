#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/metering/civil_time.hpp"
#include "simulators/scenario/building_feed.hpp"
#include "tests/daemon/command_line.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::json;
using recald::testing::read_text;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::run;

constexpr const char* kHeader = "timestamp,meter,value,unit\n";

/// A simulated year with nothing hidden, made once for all tests here.
class DetectabilityCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    simulators::Scenario scenario;
    scenario.period = {2021, 1};
    scenario.care = simulators::MeterCare::perfect;
    const auto written =
        simulators::write_building_feed({.out = folder_->path(), .scenario = scenario, .seed = 7});
    ASSERT_TRUE(written.has_value()) << written.error().message;
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string path(const char* name) { return (*folder_ / name).string(); }

  /// So much on one meter in the first five hours (UTC) of each day of the year.
  static std::string early_hours(const char* meter, double added_kW) {
    std::string text = kHeader;
    const std::chrono::sys_days begin{std::chrono::year{2021} / 1 / 1};
    for (int hour = 0; hour < 24 * 365; ++hour) {
      const metering::Instant start = begin + std::chrono::hours{hour};
      text += fmt::format("{},{},{},kW\n", metering::to_string(start), meter,
                          hour % 24 < 5 ? added_kW : 0.0);
    }
    return text;
  }

  static Outcome measure(const std::string& footprint, std::vector<std::string> more = {}) {
    write_text(*folder_ / "footprint.csv", footprint);
    more.insert(more.begin(),
                {"detectability", path("site.toml"), "--footprint", path("footprint.csv")});
    return run(more);
  }

  static Json measured(const std::string& footprint) {
    const Outcome outcome = measure(footprint, {"--json"});
    EXPECT_EQ(outcome.exit_code, kSuccess) << outcome.err;
    return Json::parse(outcome.out);
  }

  static TemporaryFolder* folder_;
};
TemporaryFolder* DetectabilityCommand::folder_ = nullptr;

TEST_F(DetectabilityCommand, MeasuresEitherSignAndLeavesOtherMetersAlone) {
  const Json more = measured(early_hours("electricity", 6.0));
  const Json less = measured(early_hours("electricity", -6.0));
  EXPECT_GT(more["grains"]["block"]["detectability"], 1.0);
  EXPECT_NEAR(less["detectability"], more["detectability"],
              0.2 * more["detectability"].get<double>());
  // What scores of absent effects vary by divides it.
  EXPECT_LT(more["detectability"].get<double>(),
            more["grains"]["block"]["detectability"].get<double>() / 2.0);
  EXPECT_GT(more["grains"]["block"]["detectability"], more["grains"]["month"]["detectability"]);
  EXPECT_GT(more["meters"]["electricity"]["net_share"], 0.0);
  EXPECT_NEAR(more["meters"]["electricity"]["net_share"],
              more["meters"]["electricity"]["moved_share"], 1e-12);
  EXPECT_NEAR(less["meters"]["electricity"]["net_share"],
              -more["meters"]["electricity"]["net_share"].get<double>(), 1e-12);
  EXPECT_EQ(more["meters"]["chilled_water"]["moved_share"], 0.0);
  EXPECT_FALSE(more["data_revision"].get<std::string>().empty());
}

TEST_F(DetectabilityCommand, SaysItInWordsAndKeepsItInAFolder) {
  const std::string footprint = early_hours("electricity", 6.0);
  const Outcome words = measure(footprint, {"--out", path("out")});
  ASSERT_EQ(words.exit_code, kSuccess) << words.err;
  EXPECT_THAT(words.out, HasSubstr("detectability d* = "));
  EXPECT_THAT(words.out, HasSubstr("% moved"));
  EXPECT_EQ(read_text(*folder_ / "out" / "detectability.json"), measure(footprint, {"--json"}).out);
}

TEST_F(DetectabilityCommand, WhatIsNoFootprintOfTheSiteIsOneSentence) {
  const std::vector<std::pair<std::string, std::string>> mistakes = {
      {kHeader, "footprint.csv has no row"},
      {early_hours("beer", 1.0),
       "footprint.csv tells of meter 'beer', which the site's model does not have; it has "
       "electricity, "},
      {std::string(kHeader) +
           "1999-01-01T00:00:00Z,electricity,1,kW\n1999-01-01T01:00:00Z,electricity,1,kW\n",
       "footprint.csv tells of no hour within the months"},
      {std::string(kHeader) + "2021-06-01T00:00:00Z,electricity,many,kW\n", "footprint.csv:2: "},
      {std::string(kHeader) +
           "2021-06-01T00:00:00Z,electricity,1,kW\n2021-06-01T01:00:00Z,electricity,1,kW\n"
           "2021-06-01T01:00:00Z,electricity,1,kW\n",
       "footprint.csv:4: meter 'electricity': interval 2021-06-01T01:00:00Z comes twice\n"},
      {std::string(kHeader) +
           "2021-06-01T00:00:00Z,electricity,1,kW\n2021-06-01T01:00:00Z,electricity,,kW\n",
       "footprint.csv: meter 'electricity' has no value at 2021-06-01T01:00:00Z"},
      {std::string(kHeader) +
           "2021-06-01T00:00:00Z,electricity,1,kW\n2021-06-01T00:15:00Z,electricity,1,kW\n"
           "2021-06-01T00:30:00Z,electricity,1,kW\n",
       "footprint.csv: meter 'electricity' has rows for 45 of the 60 minutes from "
       "2021-06-01T00:00:00Z"},
      {"when,what\n", "timestamp,meter,value,unit"}};
  for (const auto& [footprint, sentence] : mistakes) {
    const Outcome outcome = measure(footprint);
    EXPECT_EQ(outcome.exit_code, kFailure);
    EXPECT_THAT(outcome.err, HasSubstr(sentence));
    EXPECT_EQ(outcome.out, "");
  }
  const Outcome absent =
      run({"detectability", path("site.toml"), "--footprint", path("absent.csv")});
  EXPECT_EQ(absent.exit_code, kFailure);
  EXPECT_THAT(absent.err, HasSubstr("absent.csv"));
}

TEST_F(DetectabilityCommand, WrongUsageIsTwo) {
  EXPECT_EQ(run({"detectability", path("site.toml")}).exit_code, kUsage);
  EXPECT_EQ(run({"detectability", "--footprint", path("footprint.csv")}).exit_code, kUsage);
}

}  // namespace
}  // namespace recald::daemon
