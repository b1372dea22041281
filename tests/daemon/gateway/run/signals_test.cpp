/// Signals that come while nobody listens.
#include "daemon/gateway/run/signals.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <set>

namespace recald::daemon::signals_test {
namespace {

TEST(Signals, WaitUntilSomebodyListens) {
  auto signals = Signals::open().value();
  signals.hold_ends();
  for (const int signal : {SIGHUP, SIGTERM, SIGUSR1, SIGINT}) ::kill(::getpid(), signal);
  std::set<int> heard;
  while (const auto signal = signals.next()) heard.insert(*signal);
  EXPECT_EQ(heard, (std::set{SIGHUP, SIGTERM, SIGUSR1, SIGINT}));
  EXPECT_FALSE(signals.next().has_value());
}

// Whoever starts recald with nohup may reload it all the same.
TEST(Signals, AnIgnoredOneIsHeard) {
  ::signal(SIGHUP, SIG_IGN);
  auto signals = Signals::open().value();
  ::kill(::getpid(), SIGHUP);
  EXPECT_EQ(signals.next(), SIGHUP);
}

TEST(SignalsDeathTest, OneThatEndsEndsAProcessThatDoesNotHoldItYetOrAnyMore) {
  EXPECT_EXIT(
      {
        auto signals = Signals::open().value();
        ::kill(::getpid(), SIGTERM);
        ::pause();
      },
      ::testing::KilledBySignal(SIGTERM), "");
  EXPECT_EXIT(
      {
        auto signals = Signals::open().value();
        signals.hold_ends();
        signals.let_ends_through();
        ::kill(::getpid(), SIGINT);
        ::pause();
      },
      ::testing::KilledBySignal(SIGINT), "");
}

}  // namespace
}  // namespace recald::daemon::signals_test
