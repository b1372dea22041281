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

TEST(SignalsDeathTest, OneThatEndsEndsAProcessThatDoesNotHoldItYetOrAnyMore) {
  EXPECT_EXIT(
      {
        auto signals = Signals::open().value();
        ::kill(::getpid(), SIGTERM);
        ::alarm(20);  // rather than for ever, if it is lost
        ::pause();
      },
      ::testing::KilledBySignal(SIGTERM), "");
  EXPECT_EXIT(
      {
        auto signals = Signals::open().value();
        signals.hold_ends();
        signals.let_ends_through();
        ::kill(::getpid(), SIGINT);
        ::alarm(20);  // rather than for ever, if it is lost
        ::pause();
      },
      ::testing::KilledBySignal(SIGINT), "");
}

}  // namespace
}  // namespace recald::daemon::signals_test
