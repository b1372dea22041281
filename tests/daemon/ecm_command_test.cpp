/// recald ecm on simulated buildings in which measures are really carried out.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "command_line.hpp"
#include "simulators/scenario/building_feed.hpp"
#include "simulators/scenario/scenario_file.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::ecm_command_test {
namespace {

using Json = nlohmann::json;
using recald::testing::read_text;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::run;

constexpr std::string_view kOffice = R"([building]
use = "office"
[period]
start = 2021
years = 3
step = "15m"
)";
// The drawings have 9 W/m2 of lamps; of them 40 % go.
constexpr std::string_view kBetterLamps = R"([[effect]]
name = "equipment_step"
strength = -3.6
from = ")";
constexpr std::string_view kLamps = R"([[measure]]
name = "Better lamps"
cost = 20000
[[measure.change]]
parameter = "lighting_use"
change = "scale"
value = 0.6
)";
constexpr std::string_view kMore = R"([[measure]]
name = "Warmer rooms"
[[measure.change]]
parameter = "cooling_setpoint"
change = "add"
value = [0.5, 1.5, 2.0]
)";
constexpr std::string_view kTariff = R"([tariff]
currency = "EUR"
[tariff.electricity]
per_kWh = 0.3
per_kW_month = 5.0
[emissions]
electricity = 0.4
)";

/// @param lamps_from  Since when there are better lamps; empty: never.
void make_office(const std::filesystem::path& folder, const std::string& lamps_from) {
  std::filesystem::create_directories(folder);
  std::string text{kOffice};
  if (!lamps_from.empty()) text += std::string{kBetterLamps} + lamps_from + "\"\n";
  write_text(folder / "scenario.toml", text);
  auto scenario = simulators::read_scenario(folder / "scenario.toml");
  ASSERT_TRUE(scenario.has_value()) << scenario.error().message;
  const auto written = simulators::write_building_feed(
      {.out = folder, .scenario = std::move(*scenario), .seed = 11});
  ASSERT_TRUE(written.has_value()) << written.error().message;
}

/// kWh of a year, the mean over the first two: the truth, free of noise and gaps.
double year_kWh(const std::filesystem::path& folder, const std::string& meter) {
  const Json truth = Json::parse(read_text(folder / "truth.json"));
  double mean = 0.0;
  for (std::size_t i = 0; i < 24; ++i) {
    mean += truth["meters"][meter]["monthly"][i]["daily_average_kWh"].get<double>() / 24.0;
  }
  return 365.0 * mean;
}

class EcmCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    make_office(*folder_ / "plain", "");
    make_office(*folder_ / "lamps", "2021-01-01");
    make_office(*folder_ / "since", "2022-07-01");
    const auto site = *folder_ / "plain/site.toml";
    write_text(site, read_text(site) + std::string{kTariff});
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::filesystem::path measures(std::string_view text) {
    write_text(*folder_ / "measures.toml", text);
    return *folder_ / "measures.toml";
  }
  static testing::Outcome ecm(std::string_view text, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"ecm", *folder_ / "plain/site.toml", "--measure",
                                       measures(text)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  static Json result(const std::string& out) {
    Json json = Json::parse(read_text(*folder_ / out / "ecm.json"));
    json.erase("wall_s");
    return json;
  }
  static const Json& meter(const Json& measure, const std::string& output) {
    for (const Json& one : measure["meters"]) {
      if (one["output"] == output) return one;
    }
    throw std::runtime_error("no output " + output);
  }

  static inline TemporaryFolder* folder_ = nullptr;
};

TEST_F(EcmCommand, ItsIntervalsHoldWhatTheMeasureReallySaves) {
  const auto done =
      ecm(std::string{kLamps} + std::string{kMore}, {"--out", *folder_ / "once", "--threads", "2"});
  ASSERT_EQ(done.exit_code, kSuccess) << done.err;
  const Json json = result("once");
  EXPECT_EQ(json["is_year"], true);
  EXPECT_EQ(json["draws"], 400);
  ASSERT_EQ(json["measures"].size(), 3U);
  const Json& lamps = json["measures"][0];
  for (const std::string name : {"electricity", "chilled_water", "heating"}) {
    SCOPED_TRACE(name);
    const double truth = year_kWh(*folder_ / "plain", name) - year_kWh(*folder_ / "lamps", name);
    const Json& saved = meter(lamps, name + "_daily_kWh")["saved"];
    EXPECT_LE(saved["q05"].get<double>(), truth);
    EXPECT_GE(saved["q95"].get<double>(), truth);
  }
  // Lamps heat the rooms: without them there is less to cool and more to heat.
  EXPECT_EQ(meter(lamps, "electricity_daily_kWh")["saved"]["probability_of_saving"], 1.0);
  EXPECT_GT(meter(lamps, "chilled_water_daily_kWh")["saved"]["q05"], 0.0);
  EXPECT_LT(meter(lamps, "heating_daily_kWh")["saved"]["q95"], 0.0);
  // Electricity alone has a price; the EPC has no peaks.
  const double kWh = meter(lamps, "electricity_daily_kWh")["saved"]["q50"].get<double>();
  EXPECT_NEAR(lamps["money"]["q50"].get<double>(), 0.3 * kWh, 1e-6 * kWh);
  EXPECT_NEAR(lamps["emissions_kg"]["q50"].get<double>(), 0.4 * kWh, 1e-6 * kWh);
  EXPECT_NEAR(lamps["payback_years"]["q50"].get<double>(), 20000.0 / (0.3 * kWh), 1e-6);
  EXPECT_EQ(json["measures"][2]["name"], "All measures together");
  EXPECT_TRUE(json["measures"][2]["cost"].is_null());
  // Together they save less of the cooling than one by one: what is not there cannot be saved.
  const auto cooling = [&](std::size_t i) {
    return meter(json["measures"][i], "chilled_water_daily_kWh")["saved"]["q50"].get<double>();
  };
  EXPECT_LT(cooling(2), cooling(0) + cooling(1));
  EXPECT_GT(cooling(2), std::max(cooling(0), cooling(1)));
  EXPECT_THAT(done.out, AllOf(HasSubstr("Better lamps"), HasSubstr("pays back in"),
                              HasSubstr("The meter does not tell lights from plugs")));
  EXPECT_THAT(read_text(*folder_ / "once/savings.html"), HasSubstr("All measures together"));
  EXPECT_THAT(read_text(*folder_ / "once/savings.csv"),
              HasSubstr("\"Better lamps\",electricity_daily_kWh,kWh,"));

  const auto again = ecm(std::string{kLamps} + std::string{kMore},
                         {"--out", *folder_ / "again", "--threads", "1"});
  ASSERT_EQ(again.exit_code, kSuccess) << again.err;
  EXPECT_EQ(result("again"), json);
}

TEST_F(EcmCommand, BothOptionsFindWhatHasBeenSaved) {
  const auto done = run({"ecm", *folder_ / "since/site.toml", "--since", "2022-07-01", "--out",
                         *folder_ / "afterwards"});
  ASSERT_EQ(done.exit_code, kSuccess) << done.err;
  const Json json = result("afterwards");
  EXPECT_EQ(json["months_before"].size(), 18U);
  EXPECT_EQ(json["months_after"].size(), 18U);
  EXPECT_TRUE(json["month_left_out"].is_null());
  const Json plain = Json::parse(read_text(*folder_ / "plain/truth.json"));
  const Json with = Json::parse(read_text(*folder_ / "since/truth.json"));
  for (const Json& one : json["meters"]) {
    const std::string name = one["meter"];
    SCOPED_TRACE(name);
    double truth = 0.0;
    for (const Json& month : one["by_month_kWh_day"]) {
      if (month["measured"].is_null()) continue;
      const std::string at = month["month"];
      for (std::size_t i = 0; i < 36; ++i) {
        const Json& before = plain["meters"][name]["monthly"][i];
        if (before["month"] != at) continue;
        const double less = before["daily_average_kWh"].get<double>() -
                            with["meters"][name]["monthly"][i]["daily_average_kWh"].get<double>();
        truth += less * metering::days_in(metering::parse_month(at).value());
      }
    }
    for (const char* option : {"option_c", "option_d"}) {
      ASSERT_FALSE(one[option].is_null()) << option;
      const Json& avoided = one[option]["avoided_kWh"];
      EXPECT_LE(avoided["q05"].get<double>(), truth) << option;
      EXPECT_GE(avoided["q95"].get<double>(), truth) << option;
    }
  }
  EXPECT_THAT(done.out, AllOf(HasSubstr("Since 2022-07-01 the building used electricity"),
                              HasSubstr("Option C"), HasSubstr("Option D finds")));
  EXPECT_THAT(read_text(*folder_ / "afterwards/savings.html"), HasSubstr("data-figure=\"forecast"));
}

TEST_F(EcmCommand, SaysWhatIsWrongWithAFileOfMeasures) {
  const auto refused = [](std::string_view change) {
    const auto done =
        ecm("[[measure]]\nname = \"one\"\n[[measure.change]]\n" + std::string{change});
    EXPECT_EQ(done.exit_code, kFailure);
    return done.err;
  };
  EXPECT_THAT(
      refused("parameter = \"lightning_use\"\nchange = \"scale\"\nvalue = 0.6\n"),
      HasSubstr("measures.toml:4: [measure.change] unknown parameter 'lightning_use'; did you "
                "mean 'lighting_use'?"));
  EXPECT_THAT(
      refused("targets = [\"Lights/*/watts_per_floor_area\"]\nchange = \"scale\"\n"
              "value = 0.6\n"),
      HasSubstr("'targets' are objects of an EnergyPlus file, and this site's model is epc"));
  EXPECT_THAT(
      refused("parameter = \"outdoor_airflow\"\nchange = \"scale\"\nvalue = [0.9, 0.5, 1]\n"),
      HasSubstr("'value' must be [min, mode, max] in ascending order"));
  EXPECT_THAT(refused("parameter = \"outdoor_airflow\"\nchange = \"times\"\nvalue = 1\n"),
              HasSubstr("'change' is \"times\"; it must be one of set, scale, add"));
  EXPECT_THAT(refused("parameter = \"closet_share\"\nchange = \"set\"\nvalue = 1.5\n"),
              HasSubstr("it is at most 1"));
  EXPECT_THAT(refused("change = \"set\"\nvalue = 1.5\n"), HasSubstr("'parameter' is missing"));
  EXPECT_THAT(ecm("").err, HasSubstr("there is no [[measure]]"));
  EXPECT_THAT(ecm(std::string{kMore} + std::string{kMore}).err,
              HasSubstr("two measures are called 'Warmer rooms'"));
}

TEST_F(EcmCommand, NeedsOneOfItsTwoQuestions) {
  EXPECT_EQ(run({"ecm", *folder_ / "plain/site.toml"}).exit_code, kUsage);
  const auto early = run({"ecm", *folder_ / "plain/site.toml", "--since", "2020-07-01"});
  EXPECT_EQ(early.exit_code, kFailure);
  EXPECT_THAT(early.err, HasSubstr("leaves no whole month before it: the meters have 2021-01 to"));
  EXPECT_EQ(run({"ecm", *folder_ / "plain/site.toml", "--since", "July"}).exit_code, kUsage);
}

}  // namespace
}  // namespace recald::daemon::ecm_command_test
