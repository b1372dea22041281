#include "daemon/gateway/ingest/meter_watch.hpp"

#include <gmock/gmock.h>

namespace recald::daemon::meter_watch_test {
namespace {

using metering::Instant;
using std::chrono::hours;
using std::chrono::minutes;
using ::testing::HasSubstr;

const Instant kStart = std::chrono::sys_days{std::chrono::year{2026} / 2 / 3};

class MeterWatchTest : public ::testing::Test {
 protected:
  /// Kind of the event at this time; empty: none.
  std::string evaluate(std::optional<Instant> heard_at, Instant now) {
    const auto event = watch_.evaluate(heard_at, now);
    text_ = event ? event->text : "";
    return event ? event->kind : "";
  }
  MeterWatch watch_{"main", minutes{30}};
  std::string text_;
};

TEST_F(MeterWatchTest, SilenceIsToldOnceAndItsEndToo) {
  EXPECT_EQ(evaluate({}, kStart), "");
  EXPECT_EQ(evaluate(kStart + minutes{1}, kStart + minutes{31}), "");
  EXPECT_EQ(evaluate(kStart + minutes{1}, kStart + minutes{32}), "meter_silent");
  EXPECT_THAT(text_, HasSubstr("meter 'main' has given no reading since 2026-02-03T00:01:00Z"));
  EXPECT_EQ(evaluate(kStart + minutes{1}, kStart + hours{50}), "");
  EXPECT_EQ(evaluate(kStart + hours{50}, kStart + hours{50}), "meter_answers");
  EXPECT_EQ(evaluate(kStart + hours{50}, kStart + hours{51}), "meter_silent");
}

TEST_F(MeterWatchTest, OneThatWasNeverHeardIsSilentToo) {
  EXPECT_EQ(evaluate({}, kStart), "");
  EXPECT_EQ(evaluate({}, kStart + minutes{31}), "meter_silent");
}

// A clock that is set two hours on is no silence of two hours.
TEST_F(MeterWatchTest, ASkippedTimeIsNoSilence) {
  EXPECT_EQ(evaluate(kStart, kStart), "");
  watch_.clock_was_set();
  EXPECT_EQ(evaluate(kStart, kStart + hours{2}), "");
  EXPECT_EQ(evaluate(kStart, kStart + hours{2} + minutes{31}), "meter_silent");
}

TEST_F(MeterWatchTest, AClockThatIsSetIsNoAnswer) {
  EXPECT_EQ(evaluate(kStart, kStart), "");
  EXPECT_EQ(evaluate(kStart, kStart + hours{1}), "meter_silent");
  watch_.clock_was_set();
  EXPECT_EQ(evaluate(kStart, kStart + hours{5}), "");
  EXPECT_EQ(evaluate(kStart, kStart + hours{6}), "");
  EXPECT_EQ(evaluate(kStart + hours{6}, kStart + hours{6}), "meter_answers");
}

// Stamps from before lie in the future then.
TEST_F(MeterWatchTest, AClockThatIsSetBackHidesNoSilence) {
  EXPECT_EQ(evaluate(kStart + hours{10}, kStart + hours{10}), "");
  watch_.clock_was_set();
  EXPECT_EQ(evaluate(kStart + hours{10}, kStart), "");
  EXPECT_EQ(evaluate(kStart + hours{10}, kStart + minutes{31}), "meter_silent");
  EXPECT_EQ(evaluate(kStart + minutes{40}, kStart + minutes{40}), "meter_answers");
}

TEST_F(MeterWatchTest, WhatAnEarlierProcessToldIsNotToldAgain) {
  MeterWatch again{"main", minutes{30}, {}, true};
  EXPECT_FALSE(again.evaluate({}, kStart).has_value());
  EXPECT_FALSE(again.evaluate({}, kStart + hours{1}).has_value());
  EXPECT_EQ(again.evaluate(kStart + hours{1}, kStart + hours{1})->kind, "meter_answers");
}

// One that sends once a day would never be missed on a machine that restarts every day.
TEST_F(MeterWatchTest, OfAPushedMeterTheStoreKnowsSinceWhen) {
  MeterWatch pushed{"main", hours{36}, kStart - hours{40}};
  EXPECT_EQ(pushed.evaluate({}, kStart)->kind, "meter_silent");
}

// A reload opens a meter again, which then has not been heard.
TEST_F(MeterWatchTest, WhatItHeardItRemembers) {
  EXPECT_EQ(evaluate(kStart, kStart), "");
  EXPECT_EQ(evaluate(kStart + hours{5}, kStart + hours{5}), "");
  EXPECT_EQ(evaluate({}, kStart + hours{5} + minutes{5}), "");
}

TEST(MeterSilence, DependsOnTheInterval) {
  EXPECT_EQ(meter_silence_max(minutes{15}, true), minutes{30});
  EXPECT_EQ(meter_silence_max(minutes{60}, true), minutes{120});
  EXPECT_EQ(meter_silence_max(minutes{15}, false), hours{36});
}

}  // namespace
}  // namespace recald::daemon::meter_watch_test
