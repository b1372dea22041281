#include "core/text/nearest.hpp"

#include <gtest/gtest.h>

#include <array>

namespace recald {
namespace {

constexpr std::array<std::string_view, 4> kKeys = {"timezone", "latitude_deg", "longitude_deg",
                                                   "id"};

TEST(NearestName, FindsWhatATypingErrorMeant) {
  EXPECT_EQ(nearest_name("timezon", kKeys), "timezone");       // one letter lost
  EXPECT_EQ(nearest_name("timezonee", kKeys), "timezone");     // one too many
  EXPECT_EQ(nearest_name("timezome", kKeys), "timezone");      // one wrong
  EXPECT_EQ(nearest_name("latitude", kKeys), "latitude_deg");  // a unit forgotten: distance 4 of 12
  EXPECT_EQ(nearest_name("timezone", kKeys), "timezone");
}

TEST(NearestName, SaysNothingRatherThanSomethingAbsurd) {
  EXPECT_EQ(nearest_name("colour", kKeys), "");
  EXPECT_EQ(nearest_name("", kKeys), "");
  EXPECT_EQ(nearest_name("timezone", {}), "");
}

// Half of the candidate's length is the limit, and half itself still counts.
TEST(NearestName, AcceptsUpToHalfTheCandidatesLength) {
  constexpr std::array<std::string_view, 1> four = {"abcd"};
  EXPECT_EQ(nearest_name("abxy", four), "abcd");
  EXPECT_EQ(nearest_name("axyz", four), "");
  EXPECT_EQ(nearest_name("abcdxy", four), "abcd");  // two to delete
  EXPECT_EQ(nearest_name("abcdxyz", four), "");
  EXPECT_EQ(nearest_name("ab", four), "abcd");  // two to insert
  EXPECT_EQ(nearest_name("a", four), "");
}

TEST(NearestName, OfEquallyNearNamesTheFirstIsTaken) {
  constexpr std::array<std::string_view, 2> names = {"steam_a", "steam_b"};
  EXPECT_EQ(nearest_name("steam_c", names), "steam_a");
  EXPECT_EQ(nearest_name("steam_b", names), "steam_b");
}

}  // namespace
}  // namespace recald
