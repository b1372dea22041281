#include "daemon/gateway/poll/latency_histogram.hpp"

#include <gmock/gmock.h>

#include "daemon/gateway/poll/bus_counters.hpp"

namespace recald::daemon::latency_histogram_test {
namespace {

using std::chrono::milliseconds;
using ::testing::Each;

std::size_t class_of(double bound_s) {
  const auto& bounds = LatencyHistogram::kBounds_s;
  return static_cast<std::size_t>(std::ranges::find(bounds, bound_s) - bounds.begin());
}

TEST(LatencyHistogram, ClassesContainTheirBounds) {
  LatencyHistogram histogram;
  histogram.observe(milliseconds{100});
  histogram.observe(milliseconds{101});
  EXPECT_EQ(histogram.at_most()[class_of(0.1)], 1u);
  EXPECT_EQ(histogram.at_most()[class_of(0.05)], 0u);
  EXPECT_EQ(histogram.at_most()[class_of(0.25)], 2u);
  EXPECT_EQ(histogram.count(), 2u);
  EXPECT_NEAR(histogram.sum_s(), 0.201, 1e-12);
}

TEST(LatencyHistogram, WhatIsLongerThanAllIsCounted) {
  LatencyHistogram histogram;
  histogram.observe(milliseconds{10'001});
  EXPECT_THAT(histogram.at_most(), Each(0u));
  EXPECT_EQ(histogram.count(), 1u);
}

TEST(LatencyHistogram, BelowZeroIsZero) {
  LatencyHistogram histogram;
  histogram.observe(milliseconds{-500});
  EXPECT_THAT(histogram.at_most(), Each(1u));
  EXPECT_EQ(histogram.sum_s(), 0.0);
}

TEST(RequestResult, NoConnectionIsATimeout) {
  using modbus::ReadFault;
  const auto of = [](ReadFault fault) {
    return result_of(tl::unexpected(modbus::ReadFailure{fault}));
  };
  EXPECT_EQ(result_of(modbus::Words{1}), RequestResult::ok);
  EXPECT_EQ(of(ReadFault::timeout), RequestResult::timeout);
  EXPECT_EQ(of(ReadFault::refused), RequestResult::timeout);
  EXPECT_EQ(of(ReadFault::closed), RequestResult::timeout);
  EXPECT_EQ(of(ReadFault::exception), RequestResult::exception);
  EXPECT_EQ(of(ReadFault::mismatch), RequestResult::mismatch);
  EXPECT_EQ(of(ReadFault::crc), RequestResult::crc);
  EXPECT_EQ(kRequestResults[static_cast<std::size_t>(RequestResult::crc)], "crc");
  EXPECT_EQ(kRequestResults[static_cast<std::size_t>(RequestResult::mismatch)], "mismatch");
}

}  // namespace
}  // namespace recald::daemon::latency_histogram_test
