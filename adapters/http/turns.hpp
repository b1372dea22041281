/// Requests whose answers take long, one after the other: between two of them the loop does what
/// else waits, such as a supervisor's probe and the polls of meters.
#pragma once

#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <boost/asio/awaitable.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <chrono>
#include <deque>

namespace recald::http {

/// Of the sessions of one loop. A long answer is followed by a pause as long as it took, so that
/// answers have half of the loop's time at most, however many ask.
class Turns {
 public:
  using Clock = std::chrono::steady_clock;

  /// Waits for the turn of one request, and then calls answer(). If the caller's coroutine ends
  /// meanwhile, its turn passes to the next.
  template <class Executor, class Answer>
  boost::asio::awaitable<std::invoke_result_t<Answer>> in_turn(Executor executor, Answer answer) {
    boost::asio::steady_timer timer{executor, Clock::time_point::max()};
    const Place place{*this, timer};
    while (waiting_.front() != &timer || Clock::now() < free_at_) {
      timer.expires_at(waiting_.front() == &timer ? free_at_ : Clock::time_point::max());
      boost::system::error_code woken;
      co_await timer.async_wait(boost::asio::redirect_error(boost::asio::use_awaitable, woken));
    }
    const auto begin = Clock::now();
    auto answered = answer();
    const auto end = Clock::now();
    if (end - begin > kShort) free_at_ = end + (end - begin);
    co_return answered;
  }

 private:
  static constexpr std::chrono::milliseconds kShort{5};

  class Place {
   public:
    Place(Turns& turns, boost::asio::steady_timer& timer) : turns_(turns), timer_(timer) {
      turns_.waiting_.push_back(&timer_);
    }
    ~Place() {
      std::erase(turns_.waiting_, &timer_);
      if (!turns_.waiting_.empty()) turns_.waiting_.front()->cancel();
    }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

   private:
    Turns& turns_;
    boost::asio::steady_timer& timer_;
  };

  std::deque<boost::asio::steady_timer*> waiting_;
  Clock::time_point free_at_{};
};

}  // namespace recald::http
