#include "core/text/limited.hpp"

#include <gtest/gtest.h>

namespace recald {
namespace {

TEST(Limited, LeavesWhatIsShort) {
  EXPECT_EQ(limited("", 40), "");
  EXPECT_EQ(limited(std::string(40, 'a'), 40), std::string(40, 'a'));
}

TEST(Limited, SaysHowLongALongTextWas) {
  EXPECT_EQ(limited(std::string(41, 'a'), 40), "aaaaaaaaaaaaaaaaaa \u2026 (41 bytes in all)");
  EXPECT_EQ(limited(std::string(186'015, 'x'), 4'000).size(), 4'000U);
}

TEST(Limited, IsCutBetweenTwoCharacters) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += "\u20AC";  // three bytes each
  for (std::size_t most = 40; most < 60; ++most) {
    const std::string shown = limited(text, most);
    EXPECT_LE(shown.size(), most);
    EXPECT_EQ(shown.find(" \u2026") % 3, 0U) << most;
  }
}

}  // namespace
}  // namespace recald
