#include "daemon/fleet/work/site_description.hpp"

#include <gmock/gmock.h>

#include "tests/support/sample_site.hpp"
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
    recald::testing::write_text(folder_ / "site" / "weather" / "city.csv", "time,dry_bulb_C\n");
    recald::testing::write_text(folder_ / "site" / "readings.csv", "timestamp,meter,value,unit\n");
    recald::testing::write_text(folder_ / "elsewhere.csv", "time,dry_bulb_C\n");
  }

  Result<record::SiteDescription> describe_with(const std::string& weather,
                                                bool has_model = true) const {
    const auto file = folder_ / "site" / "depot.toml";
    std::string text{recald::testing::kSampleMeters};
    if (has_model) text += recald::testing::kSampleModel;
    if (const auto at = text.find("weather.csv"); at != std::string::npos) {
      text.replace(at, std::string_view{"weather.csv"}.size(), weather);
    }
    recald::testing::write_text(file, text);
    auto config = load_site(file);
    if (!config) return failure(ErrorCode::malformed, config.error().front());
    return describe({std::move(*config), metering::LocalCalendar::open("Europe/Zurich").value()});
  }

  recald::testing::TemporaryFolder folder_;
};

TEST_F(SiteDescriptionTest, HasTheSitesFileAndEveryFileThatItNames) {
  const auto site = describe_with("weather/city.csv");
  ASSERT_TRUE(site) << site.error().message;
  EXPECT_EQ(site->id, "depot");
  EXPECT_EQ(site->name, "Tram depot");
  EXPECT_EQ(site->site_file, "depot.toml");
  EXPECT_THAT(site->files,
              ElementsAre(Key("depot.toml"), Key("readings.csv"), Key("weather/city.csv")));
  EXPECT_EQ(site->files.at("weather/city.csv"), "time,dry_bulb_C\n");
  EXPECT_THAT(site->outputs, ElementsAre("electricity", "district_heat"));
  EXPECT_EQ(site->floor_area_m2, 2400.0);
  EXPECT_EQ(site->latitude_deg, 47.4);
}

TEST_F(SiteDescriptionTest, RefusesWhatAWorkerWouldNotFind) {
  const auto site = describe_with("../elsewhere.csv");
  ASSERT_FALSE(site);
  EXPECT_THAT(site.error().message, HasSubstr("elsewhere.csv' lies outside the folder"));
}

// What they lead to would lie in the record, for everybody who reads it.
TEST_F(SiteDescriptionTest, RefusesLinksThatLeaveTheFolder) {
  namespace fs = std::filesystem;
  const fs::path site = folder_ / "site";
  const auto refusal = [&](const std::string& weather) {
    const auto described = describe_with(weather);
    return described ? std::string{"taken"} : described.error().message;
  };
  fs::create_symlink("/etc/hostname", site / "weather" / "out.csv");
  EXPECT_THAT(refusal("weather/out.csv"), HasSubstr("'weather/out.csv' is a link"));
  fs::create_symlink("../../elsewhere.csv", site / "weather" / "up.csv");
  EXPECT_THAT(refusal("weather/up.csv"), HasSubstr("'weather/up.csv' is a link"));
  fs::create_directory_symlink(folder_.path(), site / "behind");
  EXPECT_THAT(refusal("behind/elsewhere.csv"),
              HasSubstr("'behind/elsewhere.csv' is a link, or lies"));
  fs::create_symlink("city.csv", site / "weather" / "inside.csv");
  EXPECT_EQ(refusal("weather/inside.csv"), "taken");
}

TEST_F(SiteDescriptionTest, RefusesAFileThatIsNotThereAndASiteWithoutAModel) {
  const auto lacking = describe_with("weather/none.csv");
  ASSERT_FALSE(lacking);
  EXPECT_THAT(lacking.error().message, HasSubstr("none.csv"));
  EXPECT_FALSE(describe_with("weather/city.csv", /*has_model=*/false));
}

}  // namespace
}  // namespace recald::daemon
