/// The depot's year with its temperature alone: it calibrates, says what is assumed, and counts it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "daemon/commands/open_site.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"
#include "tests/daemon/command_line.hpp"
#include "tests/daemon/depot_year.hpp"

namespace recald::daemon {
namespace {

using recald::testing::read_text;
using recald::testing::write_text;
using ::testing::Contains;
using ::testing::ElementsAre;

constexpr const char* kSentence =
    "Humidity, wind and sun are not measured: they are assumed from the temperature and the clear "
    "sky, and count as uncertain.";

class AssumedWeather : public ::testing::Test {
 protected:
  AssumedWeather() { recald::testing::write_depot_year(folder_.path()); }

  /// Leaves the stamps and the temperatures.
  void take_the_rest_away() {
    std::istringstream lines{read_text(folder_ / "weather.csv")};
    std::string text;
    for (std::string line; std::getline(lines, line);) {
      text += line.substr(0, line.find(',', line.find(',') + 1)) + "\n";
    }
    write_text(folder_ / "weather.csv", text);
  }

  [[nodiscard]] PreparedSite prepared() const {
    std::ostringstream ignored;
    const auto opened =
        open_modelled_site(folder_ / "site.toml", Console{ignored, ignored, false}, ModelKind::epc);
    if (!opened) throw std::runtime_error(ignored.str());
    auto made = prepare_site(opened->site.config, opened->site.calendar, opened->recording,
                             opened->weather);
    if (!made) throw std::runtime_error(made.error().message);
    return std::move(*made);
  }

  recald::testing::TemporaryFolder folder_;
};

TEST_F(AssumedWeather, ACalibrationSaysWhatIsAssumed) {
  take_the_rest_away();
  const auto outcome =
      testing::run({"calibrate", (folder_ / "site.toml").string(), "--json", "--sampler", "dram",
                    "--draws", "400", "--burn-in", "200", "--chains", "2", "--design-runs", "50"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_THAT(json["warnings"].get<std::vector<std::string>>(), Contains(kSentence));
  EXPECT_THAT(json["weather_assumed"].get<std::vector<std::string>>(),
              ElementsAre("rel_humidity_pct", "wind_speed_m_s", "ghi_W_m2"));
  ASSERT_EQ(json["weather"].size(), 12U);
  for (const auto& month : json["weather"]) {
    EXPECT_NEAR(month["known"].get<double>(), 1.0, 1e-9);  // of the temperature
    EXPECT_NEAR(month["from"]["weather.csv"].get<double>(), 0.25, 1e-9);
    EXPECT_NEAR(month["from"]["assumed"].get<double>(), 0.75, 1e-9);
  }
}

TEST_F(AssumedWeather, EachVariableIsAnErrorCommonToAllMonths) {
  const PreparedSite measured = prepared();
  take_the_rest_away();
  const PreparedSite site = prepared();

  const std::size_t known = measured.common_errors.size();
  ASSERT_EQ(site.common_errors.size(), known + 3);
  ASSERT_EQ(site.problem.common_errors.size(), known + 3);
  // Electricity, then heat, 12 months each. January's heat: more wind takes more of it, more sun
  // less.
  const Eigen::VectorXd& wind = site.common_errors[known + 1];
  const Eigen::VectorXd& sun = site.common_errors[known + 2];
  ASSERT_EQ(wind.size(), 24);
  EXPECT_GT(wind[12], 0.0);
  EXPECT_LT(sun[12], 0.0);
  // The problem has the first nine months of each.
  EXPECT_EQ(site.problem.common_errors[known + 2].segment(9, 9), sun.segment(12, 9));
  // A discrepancy may follow what is measured.
  EXPECT_THAT(site.problem.inputs.names, ElementsAre("dry_bulb_C"));
  EXPECT_THAT(measured.problem.inputs.names, Contains("rel_humidity_pct"));
}

}  // namespace
}  // namespace recald::daemon
