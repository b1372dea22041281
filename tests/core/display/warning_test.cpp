#include "core/display/warning.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace recald::display {
namespace {

TEST(Warning, ANoteIsCutAfterItsFirstSentence) {
  const Warning two = warning_of("Run 17 is left out: approx. 5 times the others. Check that run.");
  EXPECT_EQ(two.sentence, "Run 17 is left out: approx. 5 times the others.");
  EXPECT_EQ(two.details, "Check that run.");
  EXPECT_EQ(two.text(), "Run 17 is left out: approx. 5 times the others. Check that run.");
  EXPECT_EQ(warning_of("Nothing else.").details, "");
}

TEST(Warning, TheDearestIsPrintedFirstAndWithoutDetails) {
  const Warnings warnings{{.sentence = "A note."},
                          {.sentence = "Half.", .details = "Which ones.", .share = 0.5},
                          {.sentence = "All.", .share = 1.0},
                          {.sentence = "Another note."}};
  EXPECT_EQ(warning_lines(warnings), "! All.\n! Half.\n! A note.\n! Another note.\n");
  EXPECT_THAT(texts_of(warnings),
              ::testing::ElementsAre("A note.", "Half. Which ones.", "All.", "Another note."));
}

}  // namespace
}  // namespace recald::display
