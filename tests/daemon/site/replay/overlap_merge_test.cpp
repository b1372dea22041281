/// Files of one meter that overlap: the later one's values count, whatever its order in time.
#include "daemon/site/replay/overlap_merge.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "core/absent.hpp"
#include "core/random/rng.hpp"

namespace recald::daemon::overlap_merge_test {
namespace {

using metering::Instant;
using metering::Reading;

constexpr Instant kBegin = std::chrono::sys_days{std::chrono::year{2025} / 1 / 1};

Instant hour(int index) { return kBegin + std::chrono::hours{index}; }

// Files drawn at random over two months of hours, with blanks, holes and values of their own.
TEST(OverlapMerge, TheLastFileThatHasAnIntervalCounts) {
  Rng rng{11};
  for (int draw = 0; draw < 200; ++draw) {
    std::vector<Reading> got;
    const csv::ReadingsSink sink{.on_meter = {},
                                 .on_reading = [&](const Reading& one) { got.push_back(one); }};
    OverlapMerge merge{1, sink};
    std::map<int, double> expected;
    std::uint64_t corrected = 0;
    const auto files = 2 + static_cast<int>(rng.below(4));
    for (int file = 0; file < files; ++file) {
      const int first = static_cast<int>(rng.below(1000));
      const int count = 1 + static_cast<int>(rng.below(400));
      for (int i = first; i < first + count; ++i) {
        if (rng.below(10) == 0) continue;
        const bool is_blank = rng.below(20) == 0;
        const double value = rng.below(3) == 0 ? 10.0 + file : 10.0;
        merge.take({.start = hour(i), .mean_kW = is_blank ? kAbsent : value});
        const auto known = expected.find(i);
        const bool is_known = known != expected.end() && !std::isnan(known->second);
        if (is_known && !is_blank && known->second != value) ++corrected;
        if (known == expected.end() || !is_blank) expected[i] = is_blank ? kAbsent : value;
      }
      merge.end_file();
    }
    merge.finish();
    ASSERT_EQ(got.size(), expected.size()) << draw;
    std::size_t at = 0;
    for (const auto& [index, value] : expected) {
      const Reading& one = got[at++];
      ASSERT_EQ(one.start, hour(index)) << draw;
      ASSERT_TRUE(one.mean_kW == value || (std::isnan(one.mean_kW) && std::isnan(value))) << draw;
    }
    ASSERT_EQ(merge.corrected(), corrected) << draw;
  }
}

// Of one file the first value of an interval counts, as of a file alone.
TEST(OverlapMerge, AnIntervalTwiceInAFileKeepsItsFirstValue) {
  std::vector<double> got;
  const csv::ReadingsSink sink{
      .on_meter = {}, .on_reading = [&](const Reading& one) { got.push_back(one.mean_kW); }};
  OverlapMerge merge{1, sink};
  merge.take({.start = hour(0), .mean_kW = 1.0});
  merge.take({.start = hour(0), .mean_kW = 2.0});
  merge.end_file();
  merge.finish();
  EXPECT_THAT(got, ::testing::ElementsAre(1.0));
  EXPECT_EQ(merge.corrected(), 0U);
}

}  // namespace
}  // namespace recald::daemon::overlap_merge_test
