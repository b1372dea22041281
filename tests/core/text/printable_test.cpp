#include "core/text/printable.hpp"

#include <gtest/gtest.h>

#include "core/result.hpp"

namespace recald {
namespace {

TEST(Printable, WritesControlCharactersOut) {
  EXPECT_EQ(printable("kWh\nerror: none"), "kWh\\x0Aerror: none");
  EXPECT_EQ(printable("\x1B[2J\t\x7F"), "\\x1B[2J\\x09\\x7F");
  EXPECT_EQ(printable(std::string_view{"\0", 1}), "\\x00");
}

TEST(Printable, WritesOutWhatIsNotSeenBeyondAscii) {
  EXPECT_EQ(printable("a\u202Eb\u2066c\u2069"), "a\\u202Eb\\u2066c\\u2069");
  EXPECT_EQ(printable("\u0085\u009B31m\u2028"), "\\u0085\\u009B31m\\u2028");
  EXPECT_EQ(printable("\xE2\x80"), "\xE2\x80");  // cut within a character
}

TEST(Printable, KeepsTheLinesOfATextThatHasSome) {
  EXPECT_EQ(printable("one\n\ttwo\x1B", "\n\t"), "one\n\ttwo\\x1B");
}

TEST(Printable, LeavesEverythingElse) {
  EXPECT_EQ(printable(""), "");
  EXPECT_EQ(printable("São Paulo – 21.5 °C … 東京 ✖ 🏢 ~"), "São Paulo – 21.5 °C … 東京 ✖ 🏢 ~");
}

TEST(Printable, IsWhatEveryErrorSays) {
  const Error error{ErrorCode::malformed, "it ends within <link\b>"};
  EXPECT_EQ(error.message, "it ends within <link\\x08>");
  const Result<int> failed = failure(ErrorCode::malformed, "unit 'k\x1BWh'");
  EXPECT_EQ(failed.error().message, "unit 'k\\x1BWh'");
}

}  // namespace
}  // namespace recald
