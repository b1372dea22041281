#include "simulators/feed/feed_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "simulators/scenario/archetypes.hpp"
#include "simulators/scenario/scenario_files.hpp"

namespace recald::simulators::feed_files_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Scenario one_year() {
  Scenario scenario;
  scenario.period = {2023, 1};
  return scenario;
}

const metering::LocalCalendar& calendar() {
  static const auto opened = metering::LocalCalendar::open("America/New_York");
  return *opened;
}

struct FeedOf {
  explicit FeedOf(std::uint64_t seed)
      : simulated(*simulate(one_year(), seed, calendar())),
        feeds(read_feeds(one_year(), seed, simulated, calendar())),
        truth(truth_json(one_year(), seed, simulated, feeds.meters, feeds.weather, calendar())) {}
  Simulated simulated;
  Feeds feeds;
  std::string truth;
};

const FeedOf& feed_of_seed_4() {
  static const FeedOf feed(4);
  return feed;
}

TEST(FeedFiles, ReadingsParseBackToWhatTheMetersShowed) {
  const FeedOf& feed = feed_of_seed_4();
  std::istringstream text(readings_csv(feed.simulated.recording, feed.feeds.meters));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "timestamp,meter,value,unit");
  std::string before;
  for (std::size_t slot = 0; slot < feed.simulated.recording.power.size(); ++slot) {
    for (const MeterFeed& meter : feed.feeds.meters) {
      const Cell& cell = meter.cells[slot];
      if (cell.state == CellState::absent) continue;
      ASSERT_TRUE(std::getline(text, line));
      const MeterPlate& plate = meter.plate;
      const std::string prefix = metering::to_string(feed.simulated.recording.start_of(slot)) +
                                 "," + std::string(plate.id) + ",";
      ASSERT_EQ(line.substr(0, prefix.size()), prefix);
      ASSERT_GT(prefix, before);  // ordered by time, then meter
      before = prefix;
      const std::string rest = line.substr(prefix.size());
      const std::string value = rest.substr(0, rest.find(','));
      ASSERT_EQ(rest.substr(rest.find(',') + 1), plate.unit);
      if (cell.state == CellState::blank) {
        ASSERT_EQ(value, "");
      } else {
        ASSERT_NEAR(std::stod(value), cell.value, 1e-9);
      }
    }
  }
  EXPECT_FALSE(std::getline(text, line));
}

TEST(FeedFiles, WeatherHasItsHeaderAndOneRowAnInterval) {
  const FeedOf& feed = feed_of_seed_4();
  std::istringstream text(weather_csv(feed.simulated.recording, feed.feeds.weather));
  std::string line;
  std::getline(text, line);
  EXPECT_EQ(line, "timestamp,dry_bulb_C,rel_humidity_pct,wind_speed_m_s,wind_dir_deg,ghi_W_m2");
  for (std::size_t slot = 0; slot < feed.feeds.weather.cells.size(); ++slot) {
    if (feed.feeds.weather.cells[slot].absent) continue;
    ASSERT_TRUE(std::getline(text, line));
    ASSERT_EQ(std::count(line.begin(), line.end(), ','), 5);
    ASSERT_EQ(line.substr(0, 20), metering::to_string(feed.simulated.recording.start_of(slot)));
  }
  EXPECT_FALSE(std::getline(text, line));
}

TEST(FeedFiles, SiteFileQuotesDrawingsAndSplitsThePeriod) {
  Scenario scenario;
  const std::string three = site_toml(scenario);
  EXPECT_NE(three.find("calibration = { from = \"2021-01\", to = \"2022-12\" }"),
            std::string::npos);
  EXPECT_NE(three.find("validation = { from = \"2023-01\", to = \"2023-12\" }"), std::string::npos);
  EXPECT_NE(three.find("floor_area_m2 = 7800\n"), std::string::npos);
  EXPECT_NE(three.find("outdoor_air_m3_s = 13.2\n"), std::string::npos);
  EXPECT_NE(three.find("\"2022-07-04\""), std::string::npos);
  scenario.period = {2024, 1};
  const std::string one = site_toml(scenario);
  EXPECT_NE(one.find("calibration = { from = \"2024-01\", to = \"2024-08\" }"), std::string::npos);
  EXPECT_NE(one.find("validation = { from = \"2024-09\", to = \"2024-12\" }"), std::string::npos);
}

Scenario typical(Use use) {
  Scenario scenario;
  scenario.drawings = draw_up(typical_brief(use));
  return scenario;
}

// Hours, days, densities and set-points as an engineer with the drawings would write them.
TEST(FeedFiles, SiteFileTellsWhatRunsInEachUse) {
  const std::string shop = site_toml(typical(Use::shop));
  EXPECT_THAT(shop, HasSubstr("occupied_from = 7\noccupied_to = 21\nsaturday_occupied = true\n"));
  EXPECT_THAT(shop, HasSubstr("chiller_cop = 3.3   # packaged units, in the electricity meter\n"));
  EXPECT_THAT(shop, HasSubstr("outputs = [\"electricity\", \"gas\"]\n"));
  EXPECT_THAT(shop, Not(HasSubstr("chilled_water")));
  EXPECT_THAT(shop, HasSubstr("sunday = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,"));
  const std::string hotel = site_toml(typical(Use::hotel));
  EXPECT_THAT(hotel, HasSubstr("holidays = [   # local dates that run like Sundays\n]"));
  EXPECT_THAT(hotel, HasSubstr("cooling_unoccupied_C = 24\n"));
  EXPECT_THAT(hotel, HasSubstr("heating_unoccupied_C = 21\n"));
  EXPECT_THAT(hotel,
              HasSubstr("outdoor_air_unoccupied_fraction = 1.00   # air handlers never stop"));
  const std::string clinic = site_toml(typical(Use::clinic));
  EXPECT_THAT(clinic, HasSubstr("# wards run always"));
  EXPECT_THAT(clinic, Not(HasSubstr("saturday_occupied")));
  EXPECT_THAT(site_toml(typical(Use::warehouse)),
              HasSubstr("cooling_occupied_C = 27\ncooling_unoccupied_C = 32\n"
                        "heating_occupied_C = 16\nheating_unoccupied_C = 11\n"));
  const std::string restaurant = site_toml(typical(Use::restaurant));
  EXPECT_THAT(restaurant, HasSubstr("zone_heat_share = 0.6\n"));
  EXPECT_THAT(restaurant, HasSubstr("\"2022-03-07\""));  // a Monday
}

TEST(FeedFiles, TruthHasTheSharedParametersAndCleanMonths) {
  const FeedOf& feed = feed_of_seed_4();
  const auto json = nlohmann::json::parse(feed.truth);
  const Truth truth = draw_truth({}, 4);
  const auto& parameters = json.at("parameters");
  EXPECT_DOUBLE_EQ(parameters.at("occupancy_density").at("value"),
                   truth.occupancy_density_person_m2);
  EXPECT_DOUBLE_EQ(parameters.at("outdoor_airflow").at("value"), truth.outdoor_airflow_m3_s);
  EXPECT_DOUBLE_EQ(parameters.at("cooling_setpoint").at("value"), truth.cooling_setpoint_C);
  const auto& months = json.at("meters").at("electricity").at("monthly");
  ASSERT_EQ(months.size(), 12u);
  // March has 31 days but 743 hours: the mean power is taken over the slots that exist.
  double march_kWh = 0.0;
  const auto march = calendar().month_span(std::chrono::year{2023} / std::chrono::March);
  double peak_kW = 0.0;
  for (std::size_t slot = 0; slot < feed.simulated.recording.power.size(); ++slot) {
    if (!march.contains(feed.simulated.recording.start_of(slot))) continue;
    march_kWh += 0.25 * feed.simulated.recording.power[slot].electricity_kW;
    peak_kW = std::max(peak_kW, feed.simulated.recording.power[slot].electricity_kW);
  }
  EXPECT_EQ(months[2].at("month"), "2023-03");
  EXPECT_NEAR(months[2].at("daily_average_kWh"), march_kWh / 31.0, 1e-6);
  EXPECT_NEAR(months[2].at("peak_kW"), peak_kW, 1e-9);
}

TEST(FeedFiles, TruthDeclaresEveryFault) {
  const FeedOf& feed = feed_of_seed_4();
  const auto json = nlohmann::json::parse(feed.truth);
  const auto& faults = json.at("meters").at("steam").at("faults");
  const MeterFeed& steam = feed.feeds.meters[2];
  ASSERT_EQ(faults.size(), steam.faults.size());
  ASSERT_FALSE(steam.faults.empty());
  EXPECT_EQ(faults[0].at("kind"), to_string(steam.faults[0].kind));
  EXPECT_EQ(faults[0].at("from"),
            metering::to_string(feed.simulated.recording.start_of(steam.faults[0].first)));
}

}  // namespace
}  // namespace recald::simulators::feed_files_test
