#include "adapters/energyplus/run/error_file.hpp"

#include <gtest/gtest.h>

namespace recald::energyplus::error_file_test {
namespace {

constexpr std::string_view kText =
    "Program Version,EnergyPlus, Version 25.2.0\n"
    "   ** Warning ** Something is odd.\n"
    "   **   ~~~   ** It goes on.\n"
    "   ** Severe  ** GetPeople: the schedule is missing.\n"
    "   **   ~~~   ** Object=People, name=Core.\n"
    "   ** Severe  ** Another one.\n"
    "   **  Fatal  ** Errors found in the input.\n"
    "   ...Summary of Errors that led to program termination:\n"
    "   ************* EnergyPlus Terminated--Fatal Error Detected. 1 Warning; 2 Severe Errors\n";

TEST(ErrorFile, SaysTheCauseWithItsObject) {
  const ErrorFile file = parse_error_file(kText);
  EXPECT_EQ(file.words(), "GetPeople: the schedule is missing. Object=People, name=Core.");
  EXPECT_EQ(file.severe_count, 2u);
  EXPECT_EQ(file.warning_count, 1u);
  ASSERT_EQ(file.fatal.size(), 1u);
  EXPECT_EQ(file.fatal.front(), "Errors found in the input.");
  EXPECT_TRUE(file.is_complete);
}

// Wherever a file that is still being written ends.
TEST(ErrorFile, CutAnywhereItIsRead) {
  for (std::size_t length = 0; length < kText.size(); ++length) {
    const ErrorFile file = parse_error_file(kText.substr(0, length));
    EXPECT_LE(file.severe_count, 2u);
    EXPECT_EQ(file.is_complete, length > kText.find("EnergyPlus Terminated") + 20) << length;
  }
}

TEST(ErrorFile, OneThatIsNotThereHasNoWords) {
  EXPECT_EQ(read_error_file("/no/such/eplusout.err").words(), "");
}

}  // namespace
}  // namespace recald::energyplus::error_file_test
