#include "daemon/site/config/service/store_config.hpp"

#include <gmock/gmock.h>

#include "daemon/site/config/site_config.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::store_config_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kSite = R"([site]
id = "tower"
timezone = "America/Chicago"
[[meter]]
id = "main"
utility = "electricity"
file = "main.csv"
)";

TEST(StoreConfig, HasDefaults) {
  const StoreConfig store = parse_site(kSite, "/srv/tower.toml")->store;
  EXPECT_EQ(store.file, "/srv/tower.db");
  EXPECT_EQ(store.backup_folder, "/srv/backups");
  EXPECT_EQ(store.backup_at, std::chrono::minutes{195});
  EXPECT_EQ(store.raw_kept, std::chrono::days{400});
  EXPECT_EQ(store.events_kept, std::chrono::days{730});
  EXPECT_EQ(store.results_kept, 24);
}

TEST(StoreConfig, SaysWhereAndWhen) {
  const StoreConfig store =
      parse_site(kSite + "[store]\nfile = \"data/site.db\"\nbackup = \"23:59\"\nraw_days = 30\n",
                 "/srv/tower.toml")
          ->store;
  EXPECT_EQ(store.file, "/srv/data/site.db");
  EXPECT_EQ(store.backup_folder, "/srv/data/backups");  // beside the store, wherever that is
  EXPECT_EQ(store.backup_at, std::chrono::minutes{23 * 60 + 59});
  EXPECT_EQ(store.raw_kept, std::chrono::days{30});
  const StoreConfig elsewhere =
      parse_site(kSite + "[store]\nbackup_folder = \"/mnt/b\"\nbackup = \"never\"\n",
                 "/srv/tower.toml")
          ->store;
  EXPECT_EQ(elsewhere.backup_folder, "/mnt/b");
  EXPECT_FALSE(elsewhere.backup_at.has_value());
}

// A daemon of a package writes beside its store alone; earlier versions stay where they are.
TEST(StoreConfig, VersionsOfTheModelAreBesideTheStore) {
  const recald::testing::TemporaryFolder folder;
  const auto beside = [&](const std::string& more) {
    return parse_site(kSite + more, folder / "tower.toml")->versions_beside();
  };
  const std::string elsewhere = "[store]\nfile = \"/var/lib/recald/tower/any.db\"\n";
  EXPECT_EQ(beside(""), folder / "tower.toml");
  EXPECT_EQ(beside(elsewhere), "/var/lib/recald/tower/tower.toml");
  std::filesystem::create_directory(folder / "tower.models");
  EXPECT_EQ(beside(elsewhere), folder / "tower.toml");
}

TEST(StoreConfig, EachMistakeHasItsSentence) {
  for (const char* time : {"3:15", "03.15", "24:00", "12:60", "0a:15", "-1:15", "daily", ""}) {
    const auto refused =
        parse_site(kSite + "[store]\nbackup = \"" + time + "\"\n", "/srv/tower.toml");
    ASSERT_FALSE(refused.has_value()) << time;
    EXPECT_THAT(refused.error(),
                ElementsAre(HasSubstr("write a local time of day such as \"03:15\", or \"never\"")))
        << time;
  }
  EXPECT_FALSE(parse_site(kSite + "[store]\nraw_days = 0\n", "/srv/tower.toml").has_value());
  EXPECT_FALSE(parse_site(kSite + "[store]\nraw_days = 1.5\n", "/srv/tower.toml").has_value());
}

}  // namespace
}  // namespace recald::daemon::store_config_test
