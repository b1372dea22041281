#include "core/random/streams.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <span>

namespace recald::streams {
namespace {

bool are_apart(const Block& one, const Block& other) {
  return one.first + one.size <= other.first || other.first + other.size <= one.first;
}

void expect_apart(std::span<const Block> blocks) {
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    EXPECT_GT(blocks[i].size, 0U);
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_TRUE(are_apart(blocks[i], blocks[j])) << "blocks " << j << " and " << i;
    }
  }
}

TEST(Streams, OfTwoPurposesOfOneRunNeverMeet) {
  for (const std::span<const Block> run :
       {std::span<const Block>{kOfCalibration}, std::span<const Block>{kOfDiagnosis},
        std::span<const Block>{kOfFollowing}}) {
    expect_apart(run);
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
