#include "daemon/fleet/work/site_description.hpp"

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Key;

class SiteDescriptionTest : public ::testing::Test {
 protected:
  SiteDescriptionTest() {
    std::filesystem::create_directories(folder_ / "site" / "weather");
    testing::write_text(folder_ / "site" / "weather" / "city.csv", "time,dry_bulb_C\n");
    testing::write_text(folder_ / "elsewhere.csv", "time,dry_bulb_C\n");
  }

  Result<record::SiteDescription> describe_with(const std::string& weather,
                                                const std::string& model = kModel) {
    const auto file = folder_ / "site" / "tower.toml";
    testing::write_text(file, R"([site]
id = "tower"
name = "The tower"
timezone = "Europe/Berlin"
latitude_deg = 52.5
longitude_deg = 13.4
[http]
[weather]
file = ")" + weather + R"("
[tariff]
currency = "EUR"
[[meter]]
id = "east"
source = "http"
utility = "electricity"
[[meter]]
id = "west"
source = "http"
utility = "electricity"
[[meter]]
id = "main"
utility = "electricity"
sum_of = ["east", "west"]
)" + model);
    auto config = load_site(file);
    if (!config) return failure(ErrorCode::malformed, config.error().front());
    return describe({std::move(*config), metering::LocalCalendar::open("Europe/Berlin").value()});
  }

  static constexpr auto kModel = R"([building]
floor_area_m2 = 5000
[[model]]
outputs = ["main"]
)";
  testing::TemporaryFolder folder_;
};

TEST_F(SiteDescriptionTest, HasTheSitesFileAndEveryFileThatItNames) {
  const auto site = describe_with("weather/city.csv");
  ASSERT_TRUE(site) << site.error().message;
  EXPECT_EQ(site->id, "tower");
  EXPECT_EQ(site->name, "The tower");
  EXPECT_EQ(site->site_file, "tower.toml");
  EXPECT_THAT(site->files, ElementsAre(Key("tower.toml"), Key("weather/city.csv")));
  // What is stored, not what is summed.
  EXPECT_THAT(site->outputs, ElementsAre("east", "west"));
  EXPECT_EQ(site->floor_area_m2, 5000.0);
  EXPECT_EQ(site->latitude_deg, 52.5);
  EXPECT_EQ(site->currency, "EUR");
}

TEST_F(SiteDescriptionTest, RefusesWhatAWorkerWouldNotFind) {
  const auto site = describe_with("../elsewhere.csv");
  ASSERT_FALSE(site);
  EXPECT_THAT(site.error().message, HasSubstr("elsewhere.csv' lies outside the folder"));
}

TEST_F(SiteDescriptionTest, RefusesAFileThatIsNotThereAndASiteWithoutAModel) {
  EXPECT_THAT(describe_with("weather/none.csv").error().message, HasSubstr("none.csv"));
  EXPECT_FALSE(describe_with("weather/city.csv", ""));
}

}  // namespace
}  // namespace recald::daemon
