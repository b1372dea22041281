#include "adapters/system/parallel_for.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace recald::system {
namespace {

TEST(ParallelFor, RunsEachIndexOnce) {
  for (const unsigned threads : {0u, 1u, 2u, 7u}) {
    for (const std::size_t count : {0, 1, 3, 1000}) {
      SCOPED_TRACE(std::to_string(count) + " turns on " + std::to_string(threads) + " threads");
      std::vector<std::atomic<int>> runs(count);
      parallel_for(threads)(count, [&](std::size_t i) { ++runs.at(i); });
      for (const auto& n : runs) ASSERT_EQ(n, 1);
    }
  }
}

TEST(ParallelFor, CanBeUsedAgain) {
  const ForEachIndex executor = parallel_for(2);
  std::atomic<int> sum{0};
  for (int round = 0; round < 3; ++round) {
    executor(10, [&](std::size_t i) { sum += static_cast<int>(i); });
  }
  EXPECT_EQ(sum, 3 * 45);
}

TEST(ParallelFor, ExceptionReachesTheCallerAfterAllTurns) {
  for (const unsigned threads : {1u, 4u}) {
    SCOPED_TRACE(threads);
    std::atomic<int> finished{0};
    const auto body = [&](std::size_t i) {
      if (i == 3) throw std::domain_error("turn 3");
      ++finished;
    };
    try {
      parallel_for(threads)(50, body);
      ADD_FAILURE() << "nothing was thrown";
    } catch (const std::domain_error& error) {
      EXPECT_STREQ(error.what(), "turn 3");
    }
    EXPECT_EQ(finished, 49);
  }
}

TEST(ParallelFor, OfSeveralExceptionsOneIsKept) {
  EXPECT_THROW(parallel_for(4)(20, [](std::size_t) { throw std::domain_error("each"); }),
               std::domain_error);
}

}  // namespace
}  // namespace recald::system
