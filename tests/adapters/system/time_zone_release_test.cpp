#include "adapters/system/time_zone_release.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

namespace recald::system {
namespace {

TEST(TimeZoneRelease, IsAYearAndALetterOrUnknown) {
  const std::string release = time_zone_release();
  if (std::filesystem::exists("/usr/share/zoneinfo/tzdata.zi")) {
    // Distributions append their own revision to the release's name.
    EXPECT_TRUE(std::regex_search(release, std::regex{"^20[0-9]{2}[a-z]"})) << release;
  } else {
    EXPECT_EQ(release, "unknown");
  }
}

}  // namespace
}  // namespace recald::system
