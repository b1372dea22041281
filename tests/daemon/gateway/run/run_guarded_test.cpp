/// A loop whose calls and coroutines throw.
#include "daemon/gateway/run/run_guarded.hpp"

#include <gmock/gmock.h>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <stdexcept>
#include <vector>

#include "adapters/asio/asio_loop.hpp"
#include "adapters/asio/rethrown.hpp"

namespace recald::daemon::run_guarded_test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::SizeIs;

boost::asio::awaitable<void> throws_before_it_awaits() {
  throw std::runtime_error("a coroutine's word");
  co_return;
}

class RunGuarded : public ::testing::Test {
 protected:
  void run() {
    run_guarded(context_, loop_, [this](StoreEvent event) { told_.push_back(std::move(event)); });
  }

  boost::asio::io_context context_{1};
  asio::AsioLoop loop_{context_};
  std::vector<StoreEvent> told_;
};

TEST_F(RunGuarded, WhatACallOrACoroutineThrowsIsAnEventAndTheLoopGoesOn) {
  bool has_gone_on = false;
  loop_.post([] { throw std::runtime_error("a call's word"); });
  boost::asio::co_spawn(context_, throws_before_it_awaits(), asio::rethrown);
  loop_.post([] { throw 3; });
  loop_.after(1ms, [&] {
    has_gone_on = true;
    context_.stop();
  });
  run();
  EXPECT_TRUE(has_gone_on);
  ASSERT_THAT(told_, SizeIs(3));
  const char* words[] = {"a call's word", "a coroutine's word", "no description"};
  for (std::size_t i = 0; i < told_.size(); ++i) {
    EXPECT_EQ(told_[i].kind, "unforeseen");
    EXPECT_EQ(told_[i].severity, Severity::error);
    EXPECT_TRUE(told_[i].is_counted);
    EXPECT_THAT(told_[i].text, HasSubstr(words[i]));
  }
}

TEST_F(RunGuarded, TheSameAgainAndAgainIsToldOnce) {
  for (int i = 0; i < 20; ++i) loop_.post([] { throw std::runtime_error("the same"); });
  loop_.post([] { throw std::runtime_error("another"); });
  loop_.post([this] { context_.stop(); });
  run();
  EXPECT_THAT(told_, SizeIs(2));
}

}  // namespace
}  // namespace recald::daemon::run_guarded_test
