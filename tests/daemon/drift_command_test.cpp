/// recald drift on a simulated building of which one meter is tampered with.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "command_line.hpp"
#include "on_simulated_building.hpp"
#include "tampered_readings.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::json;
using recald::testing::read_text;
using recald::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::multiplied;
using testing::run;

/// Readings without those of one meter in some months: nobody came to read it.
std::string without(const std::string& readings, const std::string& meter,
                    const std::set<std::string>& months) {
  std::istringstream in{readings};
  std::string text;
  for (std::string line; std::getline(in, line);) {
    const bool is_meters = line.find("," + meter + ",") != std::string::npos;
    if (!is_meters || !months.contains(line.substr(0, 7))) text += line + '\n';
  }
  return text;
}

class DriftCommand : public testing::OnSimulatedBuilding {
 protected:
  testing::Outcome drift(const std::string& out, const char* threads) {
    return run({"drift", folder_ / "site.toml", "--out", folder_ / out, "--particles", "128",
                "--threads", threads});
  }
  [[nodiscard]] Json result(const std::string& out) const {
    Json json = Json::parse(read_text(folder_ / out / "drift.json"));
    json.erase("wall_s");
    return json;
  }
};

TEST_F(DriftCommand, FindsSinceWhenAMeterReadsTooMuch) {
  const std::string readings = read_text(folder_ / "readings.csv");
  const std::string first = readings.substr(readings.find('\n') + 1, 4);  // its year
  const std::string year = std::to_string(std::stoi(first) + 2);
  write_text(folder_ / "readings.csv",
             multiplied(readings, "chilled_water", year + "-06-01T04:00:00Z", 1.4));
  write_text(folder_ / "site.toml",
             read_text(folder_ / "site.toml") +
                 "[tariff]\ncurrency = \"EUR\"\n[tariff.chilled_water]\nper_kWh = 0.1\n");
  const auto done = drift("once", "2");
  ASSERT_EQ(done.exit_code, kSuccess) << done.err;
  const Json json = result("once");
  EXPECT_EQ(json["learning_months"], 12);
  EXPECT_EQ(json["windows"].size(), 4U);
  EXPECT_EQ(json["windows"][0]["parameters"][0]["months"].size(), 25U);
  ASSERT_FALSE(json["alarms"].empty()) << done.out;
  const Json& alarm = json["alarms"][0];
  EXPECT_EQ(alarm["output"], "chilled_water_daily_kWh");
  EXPECT_EQ(alarm["direction"], "more");
  EXPECT_EQ(alarm["since"], year + "-06");
  EXPECT_THAT(alarm["sentence"].get<std::string>(),
              AllOf(HasSubstr("Chilled water, daily mean has been more"),
                    HasSubstr("If it goes on, it costs about "), HasSubstr(" EUR a year.")));
  // Its days tell before the month is over.
  EXPECT_EQ(alarm["causes"][0]["kind"], "meter") << alarm["sentence"];
  ASSERT_FALSE(alarm["days"].is_null());
  EXPECT_EQ(alarm["month"], year + "-06");
  EXPECT_GE(alarm["days"]["since_latest"], year + "-06-01");
  EXPECT_LE(alarm["days"]["since_earliest"], year + "-06-01");
  EXPECT_NEAR(alarm["days"]["excess"].get<double>(), 0.4, 0.15);
  double sum = 0.0;
  for (const Json& cause : alarm["causes"]) sum += cause["probability"].get<double>();
  EXPECT_NEAR(sum, 1.0, 1e-9);
  EXPECT_THAT(done.out, HasSubstr(alarm["sentence"].get<std::string>()));
}

// The new meter's kilowatt-hours are megawatt-hours: nothing that a building could do.
TEST_F(DriftCommand, AMeterThatIsReplacedByOneOfAnotherUnitIsNamedAndOnAnyThreads) {
  const std::string readings = read_text(folder_ / "readings.csv");
  const std::string first = readings.substr(readings.find('\n') + 1, 4);
  const std::string year = std::to_string(std::stoi(first) + 2);
  write_text(folder_ / "readings.csv",
             multiplied(readings, "chilled_water", year + "-03-10T04:00:00Z", 0.001));
  const auto done = drift("out", "2");
  ASSERT_EQ(done.exit_code, kSuccess) << done.err;
  const Json json = result("out");
  ASSERT_EQ(json["meter_changes"].size(), 1U) << done.out;
  const Json& change = json["meter_changes"][0];
  EXPECT_EQ(change["meter"], "chilled_water");
  EXPECT_EQ(change["kind"], "unit");
  EXPECT_THAT(done.out, HasSubstr(change["sentence"].get<std::string>()));
  // Its days have noticed at once; nothing is concluded from them about the building.
  ASSERT_EQ(json["alarms"].size(), 1U) << done.out;
  const Json& alarm = json["alarms"][0];
  EXPECT_EQ(alarm["days"]["since"], year + "-03-10");
  EXPECT_EQ(alarm["causes"][0]["kind"], "meter") << alarm["sentence"];
  EXPECT_NEAR(std::log10(alarm["causes"][0]["mean"].get<double>()), -3.0, 0.2);
  EXPECT_EQ(alarm["consequence"], "meter_set_aside");

  ASSERT_EQ(drift("again", "1").exit_code, kSuccess);
  EXPECT_EQ(result("again"), json);
}

TEST_F(DriftCommand, MissingMonthsHaveNoForecastAndStopNothing) {
  const std::string readings = read_text(folder_ / "readings.csv");
  const std::string first = readings.substr(readings.find('\n') + 1, 4);
  const std::string year = std::to_string(std::stoi(first) + 1);
  const std::set<std::string> missing{year + "-03", year + "-08", year + "-09", year + "-10"};
  write_text(folder_ / "readings.csv", without(readings, "chilled_water", missing));
  const auto done = run({"drift", folder_ / "site.toml", "--out", folder_ / "out", "--particles",
                         "64", "--learn", "9", "--threads", "2"});
  ASSERT_EQ(done.exit_code, kSuccess) << done.err;
  const Json json = result("out");
  EXPECT_EQ(json["learning_months"], 9);
  for (const Json& output : json["outputs"]) {
    std::set<std::string> forecast;
    for (const Json& month : output["months"]) forecast.insert(month["month"]);
    for (const std::string& month : missing) {
      EXPECT_EQ(forecast.contains(month), output["meter"] != "chilled_water") << month;
    }
    EXPECT_TRUE(forecast.contains(year + "-11"));  // and goes on
  }
  EXPECT_THAT(read_text(folder_ / "out" / "drift.html"), HasSubstr("data-figure=\"forecast\""));
}

// Dawid's principle, to the last digit: what was said of a month hangs on no later one. A figure
// that is put right a year after changes what is said from the next month on, and nothing before.
TEST_F(DriftCommand, AMonthThatIsRevisedChangesNothingThatWasSaidBefore) {
  const auto said = [&](const std::string& out) {
    const auto done = run({"drift", folder_ / "site.toml", "--out", folder_ / out, "--particles",
                           "64", "--threads", "2"});
    EXPECT_EQ(done.exit_code, kSuccess) << done.err;
    std::map<std::string, std::map<std::string, Json>> months;
    const Json json = result(out);
    for (const Json& output : json["outputs"]) {
      for (const Json& month : output["months"]) months[month["month"]][output["name"]] = month;
    }
    return months;
  };
  const std::string readings = read_text(folder_ / "readings.csv");
  const auto before = said("before");
  auto revised_at = before.begin();
  std::advance(revised_at, 6);
  const std::string revised = revised_at->first;
  const std::string after = std::next(revised_at)->first;
  const std::string too_much =
      multiplied(readings, "chilled_water", revised + "-02T00:00:00Z", 1.01);
  write_text(folder_ / "readings.csv",
             multiplied(too_much, "chilled_water", revised + "-25T00:00:00Z", 1.0 / 1.01));
  const auto since = said("after");
  for (const auto& [month, outputs] : before) {
    for (const auto& [name, forecast] : outputs) {
      const Json& now = since.at(month).at(name);
      if (month > revised) continue;
      EXPECT_EQ(now["mean"], forecast["mean"]) << month << ' ' << name;
      EXPECT_EQ(now["q05"], forecast["q05"]) << month << ' ' << name;
      const bool is_revised = month == revised && name == "chilled_water_daily_kWh";
      EXPECT_EQ(now["measured"] == forecast["measured"], !is_revised) << month << ' ' << name;
    }
  }
  EXPECT_NE(since.at(after).at("chilled_water_daily_kWh")["mean"],
            before.at(after).at("chilled_water_daily_kWh")["mean"]);
}

TEST_F(DriftCommand, AYoungSiteIsTold) {
  std::istringstream in{read_text(folder_ / "readings.csv")};
  std::string year;
  for (std::string line; std::getline(in, line) && year.size() < 2'500'000;) year += line + "\n";
  write_text(folder_ / "readings.csv", year);
  const auto refused = drift("out", "1");
  EXPECT_EQ(refused.exit_code, kFailure);
  EXPECT_THAT(refused.err, HasSubstr("needs 13 months of all modelled meters"));
}

}  // namespace
}  // namespace recald::daemon
