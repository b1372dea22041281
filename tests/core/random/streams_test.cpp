#include "core/random/streams.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

namespace recald::streams {
namespace {

bool are_apart(const Block& one, const Block& other) {
  return one.first + one.size <= other.first || other.first + other.size <= one.first;
}

TEST(Streams, OfTwoPurposesNeverMeet) {
  for (std::size_t i = 0; i < kAll.size(); ++i) {
    EXPECT_GT(kAll[i].size, 0U);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_TRUE(are_apart(kAll[i], kAll[j])) << "blocks " << j << " and " << i;
    }
  }
}

// Populations that start anew after a doubling once drew from the bridge's stream.
TEST(Streams, OfPopulationsStayInTheirBlock) {
  for (int doublings = 0; doublings < static_cast<int>(kPopulationRoundsMax); ++doublings) {
    const Block round = populations_of(doublings);
    ASSERT_GE(round.first, kPopulations.first);
    ASSERT_LE(round.first + round.size, kPopulations.first + kPopulations.size);
    ASSERT_TRUE(doublings == 0 || are_apart(populations_of(doublings - 1), round));
  }
}

}  // namespace
}  // namespace recald::streams
