/// A simulated building's three years from readings to report: what must not change a result, and
/// that everything promised is there.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>

#include "command_line.hpp"
#include "core/metering/civil_time.hpp"
#include "simulators/scenario/building_feed.hpp"
#include "tests/daemon/on_simulated_building.hpp"
#include "tests/support/sample_site.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using metering::Instant;
using recald::testing::edited;
using recald::testing::read_text;
using recald::testing::write_text;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::run;
using ::testing::StartsWith;

/// `text` with every match replaced.
std::string replaced(const std::string& text, const char* pattern, const char* by) {
  return std::regex_replace(text, std::regex{pattern}, by);
}

Instant parse_instant(const std::string& text) {
  int y, mo, d, h, mi;
  if (std::sscanf(text.c_str(), "%d-%d-%dT%d:%d:00Z", &y, &mo, &d, &h, &mi) != 5) {
    throw std::runtime_error("no time stamp: " + text);
  }
  const auto day = std::chrono::year{y} / mo / d;
  return std::chrono::sys_days{day} + std::chrono::hours{h} + std::chrono::minutes{mi};
}

std::vector<std::string> csv_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in{text};
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

class EndToEnd : public testing::OnSimulatedBuilding {
 protected:
  static void TearDownTestSuite() {
    calibrated_.reset();
    OnSimulatedBuilding::TearDownTestSuite();
  }

  [[nodiscard]] std::string path(std::string_view name) const { return (folder_ / name).string(); }

  /// The months.csv that replaying a site file leaves.
  std::string months_of(const std::string& site) {
    const Outcome outcome = run({"replay", path(site), "--out", path("replayed")});
    EXPECT_EQ(outcome.exit_code, kSuccess) << outcome.err;
    return read_text(folder_ / "replayed/months.csv");
  }

  Outcome calibrate(const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {
        "calibrate", path("site.toml"), "--draws", "2000",  "--burn-in",
        "500",       "--chains",        "2",       "--out", path(out)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  /// The building's calibration as it comes.
  const Outcome& calibrated() {
    if (!calibrated_) calibrated_ = calibrate("out", {"--json"});
    return *calibrated_;
  }

  inline static std::optional<Outcome> calibrated_;
};

TEST_F(EndToEnd, MonthsAreThoseOfTheBuilding) {
  const Outcome outcome = run({"replay", path("site.toml"), "--out", path("replayed")});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  EXPECT_EQ(csv_lines(outcome.out).size(), 3u * 36);
  const auto rows = csv_lines(read_text(folder_ / "replayed/months.csv"));
  ASSERT_EQ(rows.size(), 1u + 3 * 36);

  // Against the clean figures behind the faults. A gap of days in spring costs chilled water, which
  // follows the weather, more than electricity, which follows the calendar.
  const Json truth = Json::parse(read_text(folder_ / "truth.json"));
  for (const auto& [meter, tolerance] :
       {std::pair{"electricity", 0.015}, std::pair{"chilled_water", 0.05}}) {
    for (const Json& clean : truth["meters"][meter]["monthly"]) {
      const std::string key = clean["month"].get<std::string>() + "," + meter + ",";
      const auto row = std::ranges::find_if(
          rows, [&](const std::string& candidate) { return candidate.starts_with(key); });
      ASSERT_NE(row, rows.end()) << key;
      const double expected_kWh = clean["daily_average_kWh"];
      EXPECT_NEAR(std::stod(row->substr(key.size())), expected_kWh, tolerance * expected_kWh)
          << key;
    }
  }
}

TEST_F(EndToEnd, EndStampsAndOrderOfRowsDoNotMatter) {
  const std::string months = months_of("site.toml");
  auto rows = csv_lines(read_text(folder_ / "readings.csv"));
  const std::string header = rows.front();
  rows.erase(rows.begin());

  std::vector<std::string> end_stamped = {header};
  for (const std::string& row : rows) {
    const Instant end = parse_instant(row) + std::chrono::minutes{15};
    end_stamped.push_back(metering::to_string(end) + row.substr(row.find(',')));
  }
  write_text(folder_ / "end.csv", joined(end_stamped));
  const std::string site = read_text(folder_ / "site.toml");
  write_text(folder_ / "end.toml", replaced(site, "file = \"readings.csv\"\nstamps = \"start\"",
                                            "file = \"end.csv\"\nstamps = \"end\""));
  EXPECT_EQ(months_of("end.toml"), months);

  const auto meter_of = [](const std::string& row) {
    const std::size_t begin = row.find(',') + 1;
    return row.substr(begin, row.find(',', begin) - begin);
  };
  std::ranges::stable_sort(rows, std::greater{}, meter_of);
  rows.insert(rows.begin(), header);
  write_text(folder_ / "grouped.csv", joined(rows));
  write_text(folder_ / "grouped.toml", replaced(site, "readings\\.csv", "grouped.csv"));
  EXPECT_EQ(months_of("grouped.toml"), months);
}

std::string with_no_wall_time(const std::string& text) {
  return replaced(text, "\"wall_s\": [0-9.e-]+", "\"wall_s\": _");
}

void expect_contract(const Json& json) {
  for (const char* key : {"model", "months", "parameters", "hyperparameters", "before",
                          "prior_mean", "after", "guideline14", "extrapolation", "warnings",
                          "sampler", "seed", "data_revision", "model_version", "wall_s"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  ASSERT_EQ(json["parameters"].size(), 3u);
  for (const Json& parameter : json["parameters"]) {
    for (const char* key : {"name", "unit", "prior", "mean", "sd", "q05", "q50", "q95",
                            "contraction", "rhat", "ess_bulk", "ess_tail"}) {
      EXPECT_TRUE(parameter.contains(key)) << key;
    }
    EXPECT_LE(parameter["prior"]["min"], parameter["q05"]);
    EXPECT_LE(parameter["q05"], parameter["q50"]);
    EXPECT_LE(parameter["q50"], parameter["q95"]);
    EXPECT_LE(parameter["q95"], parameter["prior"]["max"]);
  }
  for (const char* stage : {"before", "prior_mean", "after"}) {
    for (const char* period : {"calibration", "validation"}) {
      const Json& metrics = json[stage][period]["chilled_water_daily_kWh"];
      EXPECT_EQ(metrics["nmbe_g14"].get<double>(), -metrics["nmbe_sim_minus_meas"].get<double>());
      EXPECT_GT(metrics["cvrmse"], 0.0);
    }
  }
  EXPECT_TRUE(json["guideline14"]["pass"].is_boolean());
  EXPECT_TRUE(json["guideline14"]["why"].is_string());
  EXPECT_EQ(json["months"].size(), 36u);
  EXPECT_EQ(json["seed"], 3);
}

TEST_F(EndToEnd, CalibrationLeavesEverythingAndRepeatsItself) {
  ::setenv("SOURCE_DATE_EPOCH", "1790000000", 1);
  const Outcome one = calibrate("one", {"--seed", "3", "--threads", "1", "--json"});
  ASSERT_EQ(one.exit_code, kSuccess) << one.err;
  const Outcome two = calibrate("two", {"--seed", "3", "--threads", "2"});
  ASSERT_EQ(two.exit_code, kSuccess) << two.err;
  const Outcome other = calibrate("other", {"--seed", "4"});
  ASSERT_EQ(other.exit_code, kSuccess) << other.err;
  const Outcome page = run({"report", path("site.toml"), "--seed", "3", "--draws", "2000",
                            "--burn-in", "500", "--chains", "2", "--out", path("page.html")});
  ASSERT_EQ(page.exit_code, kSuccess) << page.err;
  ::unsetenv("SOURCE_DATE_EPOCH");

  // Same seed, same bytes, whatever the number of threads.
  // (Compared as a whole: a difference would print megabytes.)
  for (const char* name :
       {"draws_1.csv", "draws_2.csv", "months.csv", "profile.json", "report.html"}) {
    EXPECT_TRUE(read_text(folder_ / "one" / name) == read_text(folder_ / "two" / name)) << name;
  }
  EXPECT_EQ(with_no_wall_time(read_text(folder_ / "one/calibration.json")),
            with_no_wall_time(read_text(folder_ / "two/calibration.json")));
  EXPECT_TRUE(read_text(folder_ / "page.html") == read_text(folder_ / "one/report.html"));
  EXPECT_NE(read_text(folder_ / "one/draws_1.csv"), read_text(folder_ / "other/draws_1.csv"));
  EXPECT_NE(read_text(folder_ / "one/draws_1.csv"), read_text(folder_ / "one/draws_2.csv"));

  // --json says what the file says.
  EXPECT_EQ(one.out, read_text(folder_ / "one/calibration.json"));
  expect_contract(Json::parse(one.out));
  EXPECT_THAT(two.out, HasSubstr("Guideline 14, chilled water, daily mean: "));

  const auto draws = csv_lines(read_text(folder_ / "one/draws_2.csv"));
  const auto header =
      std::ranges::find_if(draws, [](const std::string& line) { return !line.starts_with('#'); });
  ASSERT_NE(header, draws.end());
  EXPECT_THAT(*header, StartsWith("lp__,accept_stat__,occupancy_density,outdoor_airflow,"
                                  "cooling_setpoint,lambda_delta,lambda_eps,beta_"));
  EXPECT_EQ(draws.end() - header - 1, 1500);  // iterations less burn-in
  for (auto line = header + 1; line != draws.end(); ++line) {
    ASSERT_EQ(std::ranges::count(*line, ','), std::ranges::count(*header, ','));
  }
  EXPECT_THAT(draws, ::testing::Contains("# num_samples = 1500"));
  EXPECT_THAT(draws, ::testing::Contains("# seed = 3"));

  EXPECT_EQ(csv_lines(read_text(folder_ / "one/months.csv")).size(), 1u + 3 * 36);
  const std::string report = read_text(folder_ / "one/report.html");
  EXPECT_THAT(report, HasSubstr("Campus laboratory building"));
  EXPECT_THAT(report, HasSubstr("2026-09-21"));  // SOURCE_DATE_EPOCH
}

// Fail closed: what stands in the folder is a calibration that passed its gate, and stays.
TEST_F(EndToEnd, AFailedCalibrationDoesNotReplaceAGoodOne) {
  std::filesystem::create_directories(folder_ / "kept");
  const std::string good = "{\"status\": \"converged\"}\n";
  std::ofstream(folder_ / "kept/calibration.json") << good;
  const Outcome failed = run({"calibrate", path("site.toml"), "--draws", "120", "--burn-in", "20",
                              "--chains", "2", "--design-runs", "40", "--out", path("kept")});
  EXPECT_EQ(failed.exit_code, kFailure);
  EXPECT_THAT(failed.err, HasSubstr("the chains have not converged"));
  EXPECT_THAT(failed.err, HasSubstr("is kept; this one is in"));
  EXPECT_EQ(read_text(folder_ / "kept/calibration.json"), good);
  const Json json = Json::parse(read_text(folder_ / "kept/unconverged/calibration.json"));
  EXPECT_EQ(json["status"], "unconverged");
  EXPECT_EQ(json["sampling"]["draws"], 100);
}

// The sampler sees two years of chilled water, so the posterior must know more than the prior about
// the air that is cooled most of all: most of what the monthly model's own errors leave to be
// known.
TEST_F(EndToEnd, CalibrationLearnsTheOutdoorAir) {
  const Outcome& outcome = calibrated();
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const Json json = Json::parse(outcome.out);
  const Json& airflow = json["parameters"][1];
  ASSERT_EQ(airflow["name"], "outdoor_airflow");
  EXPECT_GT(airflow["contraction"], 0.5 * airflow["contraction_max"].get<double>());
  EXPECT_EQ(airflow["identified"], true);
  EXPECT_NEAR(airflow["contraction_max"], 1.0 / (1.0 + 1.5 * 1.5), 1e-9);
}

// What the seed had: no errors of the model's own, every meter fitted, and so more is "known".
TEST_F(EndToEnd, TheSeedsDiscrepancyIsOneOptionAway) {
  const Outcome outcome = calibrate("out", {"--json", "--discrepancy", "seed"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["parameters"][1]["contraction_max"], 1.0);
  EXPECT_GT(json["parameters"][1]["contraction"], 0.5);
}

// The forecast knows what the calibration months said of the model's error; the model alone does
// not.
TEST_F(EndToEnd, ForecastsOfUnseenMonthsAreBetterThanTheModelAlone) {
  const Outcome& outcome = calibrated();
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const Json json = Json::parse(outcome.out);
  const Json& forecast = json["forecast"]["validation"]["chilled_water_daily_kWh"];
  ASSERT_FALSE(forecast.is_null());
  EXPECT_LT(forecast["cvrmse"], json["after"]["validation"]["chilled_water_daily_kWh"]["cvrmse"]);
  EXPECT_FALSE(json["yardstick"]["validation"]["chilled_water_daily_kWh"].is_null());
  const std::size_t outputs = json["outputs"].size();
  EXPECT_EQ(json["predictions"].size(), outputs * json["months"].size());
}

TEST_F(EndToEnd, MonthWithoutWeatherIsLeftOutAndNamed) {
  std::vector<std::string> kept;
  for (const std::string& row : csv_lines(read_text(folder_ / "weather.csv"))) {
    if (!row.starts_with("2022-06-")) kept.push_back(row);
  }
  write_text(folder_ / "weather.csv", joined(kept));
  const Outcome outcome = run({"calibrate", path("site.toml"), "--draws", "200", "--burn-in", "100",
                               "--chains", "2", "--json"});
  ASSERT_EQ(outcome.exit_code, kSuccess) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_THAT(json["warnings"].get<std::vector<std::string>>(),
              ::testing::Contains(
                  ::testing::MatchesRegex("June 2022 is left out: only [0-9]+ % of its outdoor "
                                          "temperature was measured\\.")));
  EXPECT_EQ(json["months"].size(), 35u);
}

/// The station's weather as a file of hourly values at the stamp; radiation is the hour's.
/// @param rows  weather.csv of a year in means of 15 minutes, its first local hour the first.
std::string as_epw(const std::vector<std::string>& rows) {
  std::vector<std::vector<double>> quarters;  // dry_bulb, humidity, wind, direction, sun
  for (std::size_t i = 1; i < rows.size(); ++i) {
    std::istringstream fields{rows[i].substr(rows[i].find(',') + 1)};
    std::vector<double>& values = quarters.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) values.push_back(std::stod(field));
  }
  std::string text =
      "LOCATION,Campus,GA,USA,AMY,0,33.65,-84.43,-5.0,308.0\nDESIGN CONDITIONS,0\n"
      "TYPICAL/EXTREME PERIODS,0\nGROUND TEMPERATURES,0\nHOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0\n"
      "COMMENTS 1,\nCOMMENTS 2,\nDATA PERIODS,1,1,Data,Friday,1/1,12/31\n";
  for (std::size_t hour = 0; 4 * hour + 3 < quarters.size(); ++hour) {
    const auto& before = quarters[4 * hour + 3];
    const auto& after = quarters[std::min(4 * hour + 4, quarters.size() - 1)];
    double sun_W_m2 = 0.0;
    for (std::size_t i = 0; i < 4; ++i) sun_W_m2 += 0.25 * quarters[4 * hour + i][4];
    const std::chrono::year_month_day day = std::chrono::sys_days{std::chrono::year{2021} / 1 / 1} +
                                            std::chrono::days{static_cast<int>(hour / 24)};
    const auto at_stamp = [&](std::size_t k) { return 0.5 * (before[k] + after[k]); };
    text += fmt::format(
        "2021,{},{},{},0,x,{:.2f},99.9,{:.1f},999999,9999,9999,9999,{:.1f},9999,9999,9999,9999,"
        "9999,"
        "9999,{:.0f},{:.2f},9999,9999,9999,9999,9999,9999,9999,9999,9999,9999,9999,9999,9999\n",
        static_cast<unsigned>(day.month()), static_cast<unsigned>(day.day()), hour % 24 + 1,
        at_stamp(0), at_stamp(1), sun_W_m2, before[3], at_stamp(2));
  }
  return text;
}

// Read half an hour late, such a file makes the clock of a sound building's meter look wrong in the
// residuals.
TEST(WeatherAtTheStamp, NamesNoClockOfASoundBuilding) {
  const recald::testing::TemporaryFolder folder;
  const simulators::Scenario sound{.period = {.years = 1}, .care = simulators::MeterCare::perfect};
  const auto written =
      simulators::write_building_feed({.out = folder.path(), .scenario = sound, .seed = 7});
  ASSERT_TRUE(written.has_value()) << written.error().message;
  write_text(folder / "weather.epw", as_epw(csv_lines(read_text(folder / "weather.csv"))));
  const std::string site = edited(read_text(folder / "site.toml"),
                                  "file = \"weather.csv\"\nformat = \"csv\"\nstamps = \"start\"\n"
                                  "values = \"mean\"\n",
                                  "file = \"weather.epw\"\nformat = \"epw\"\n");
  const auto diagnose = [&](const std::string& text) {
    write_text(folder / "site.toml", text);
    const Outcome outcome = run({"diagnose", (folder / "site.toml").string(), "--json"});
    EXPECT_EQ(outcome.exit_code, kSuccess) << outcome.err;
    return Json::parse(outcome.out);
  };
  const Json json = diagnose(site);
  EXPECT_EQ(json["outcome"], "none");
  for (const Json& candidate : json["candidates"]) {
    if (candidate["effect"] == "clock_offset") {
      EXPECT_LT(candidate["probability"].get<double>(), 0.05);
    }
  }
}

}  // namespace
}  // namespace recald::daemon
