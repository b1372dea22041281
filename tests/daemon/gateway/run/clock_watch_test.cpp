/// When a clock is believed, by each kind of evidence, at drawn times.
#include "daemon/gateway/run/clock_watch.hpp"

#include <gmock/gmock.h>

#include <random>

namespace recald::daemon::clock_watch_test {
namespace {

using metering::Instant;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::years;
using ::testing::HasSubstr;

Instant first_of(int year) { return std::chrono::sys_days{std::chrono::year{year} / 1 / 1}; }

const Instant kReleased = first_of(2026);
const Instant kEnd = metering::kLatestInstant - days{62};

class ClockWatchTest : public ::testing::Test {
 protected:
  Instant draw(Instant from, Instant until) {
    return from + seconds{std::uniform_int_distribution<std::int64_t>{
                      0, (until - from).count() - 1}(random_)};
  }
  /// Of a watch that sees the time for the first time.
  std::string doubt(Instant t, std::optional<Instant> newest = {}) {
    ClockWatch watch{evidence_, newest};
    watch.look({t, milliseconds{0}});
    EXPECT_EQ(watch.is_believed(), watch.doubt().empty());
    return watch.doubt();
  }

  std::mt19937_64 random_{17};
  bool hears_server_ = false;
  std::optional<ClockEvidence> evidence_ =
      ClockEvidence{.released = kReleased, .is_synchronised = [this] { return hears_server_; }};
};

TEST_F(ClockWatchTest, NoClockBeforeTheReleaseIsRight) {
  for (const bool is_heard : {false, true}) {
    hears_server_ = is_heard;
    EXPECT_THAT(doubt(Instant{}), HasSubstr("1970"));
    EXPECT_EQ(doubt(first_of(2000)),
              "it says 2000-01-01T00:00:00Z, before this version of recald was made");
    EXPECT_NE(doubt(kReleased - seconds{1}), "");
    EXPECT_EQ(doubt(kReleased), "");
    for (int i = 0; i < 200; ++i) EXPECT_NE(doubt(draw(first_of(1971), kReleased)), "");
  }
}

TEST_F(ClockWatchTest, WithATimeServerAllYearsAfterAreRight) {
  hears_server_ = true;
  for (int i = 0; i < 200; ++i) {
    EXPECT_EQ(doubt(draw(kReleased, kEnd), draw(first_of(1971), kEnd)), "");
  }
  EXPECT_EQ(doubt(kEnd),
            "it says " + metering::to_string(kEnd) + ", but recald knows the years 1971 to 2100");
  EXPECT_NE(doubt(first_of(2106)), "");
}

TEST_F(ClockWatchTest, AloneAClockIsBelievedTwentyYearsAfterWhatIsKnown) {
  for (int i = 0; i < 200; ++i) {
    const Instant newest = draw(kReleased, first_of(2070));
    EXPECT_EQ(doubt(draw(kReleased, kReleased + years{20})), "");
    EXPECT_NE(doubt(draw(kReleased + years{20} + seconds{1}, kEnd)), "");
    EXPECT_EQ(doubt(draw(newest, newest + years{20}), newest), "");
    EXPECT_THAT(
        doubt(draw(newest + years{20} + seconds{1}, kEnd), newest),
        HasSubstr("more than 20 years after the last known, " + metering::to_string(newest)));
  }
}

TEST_F(ClockWatchTest, AloneAClockIsNotBelievedADayBehindTheStore) {
  for (int i = 0; i < 200; ++i) {
    const Instant newest = draw(kReleased + days{2}, first_of(2045));
    EXPECT_EQ(doubt(draw(newest - days{1}, newest), newest), "");
    const Instant behind = draw(kReleased, newest - days{1});
    EXPECT_EQ(doubt(behind, newest),
              "it says " + metering::to_string(behind) + ", but the store has readings until " +
                  metering::to_string(newest) + ", and no time server is heard; set the clock");
  }
}

// Whoever sets it while recald runs knows better than a store that an old clock has stamped.
TEST_F(ClockWatchTest, AClockThatIsSetIsBelievedWhateverTheStoreHas) {
  ClockWatch watch{evidence_, first_of(2045)};
  EXPECT_EQ(watch.look({first_of(2027), milliseconds{0}}), milliseconds{0});
  EXPECT_FALSE(watch.is_believed());
  EXPECT_EQ(watch.look({first_of(2027) + hours{1}, hours{1}}), milliseconds{0});
  EXPECT_FALSE(watch.is_believed());
  EXPECT_EQ(watch.look({first_of(2028), hours{1}}), first_of(2028) - first_of(2027) - hours{1});
  EXPECT_TRUE(watch.is_believed());
}

// As long as it runs it goes on, through decades and when its server is lost; a leap does not.
TEST_F(ClockWatchTest, AClockThatRunsStaysBelieved) {
  bool is_settling = true;
  evidence_->is_settling = [&] { return is_settling; };
  ClockWatch watch{evidence_};
  Moment now{kReleased, milliseconds{0}};
  watch.look(now);
  EXPECT_EQ(watch.doubt(), "the machine has just started and has not heard from a time server");
  is_settling = false;
  watch.look(now);
  is_settling = true;
  for (; now.wall < first_of(2090); now.wall += days{300}, now.monotonic += days{300}) {
    EXPECT_EQ(watch.look(now), milliseconds{0});
    EXPECT_TRUE(watch.is_believed());
  }
  now.wall = first_of(2027);
  EXPECT_LT(watch.look(now), milliseconds{0});
  EXPECT_TRUE(watch.is_believed());
  now.wall = first_of(2048);
  EXPECT_GT(watch.look(now), milliseconds{0});
  EXPECT_FALSE(watch.is_believed());
}

TEST_F(ClockWatchTest, ATrialShowsAnyTimeOfTheKnownYears) {
  evidence_.reset();
  for (int i = 0; i < 200; ++i) {
    EXPECT_EQ(doubt(draw(first_of(1971) + days{1}, kEnd), draw(first_of(1971), kEnd)), "");
  }
  EXPECT_NE(doubt(Instant{}), "");
  EXPECT_NE(doubt(kEnd), "");
}

}  // namespace
}  // namespace recald::daemon::clock_watch_test
