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
#include <functional>
#include <memory>

#include "adapters/ports/worker.hpp"

namespace recald::http {

/// Of the sessions of one loop. A long answer is followed by a pause as long as it took, so that
/// answers have half of the loop's time at most, however many ask.
class Turns {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param pause_after  Answers that take longer are followed by a pause.
  explicit Turns(Clock::duration pause_after = std::chrono::milliseconds{5})
      : pause_after_(pause_after) {}

  /// A place in the queue, and the turn while it lasts; then the next one has it.
  class Turn {
   public:
    template <class Executor>
    Turn(Turns& turns, const Executor& executor)
        : turns_(turns), timer_{executor, Clock::time_point::max()} {
      turns_.waiting_.push_back(&timer_);
    }
    ~Turn() {
      std::erase(turns_.waiting_, &timer_);
      if (!turns_.waiting_.empty()) turns_.waiting_.front()->cancel();
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

    boost::asio::awaitable<void> come() {
      while (turns_.waiting_.front() != &timer_ || Clock::now() < turns_.free_at_) {
        const bool is_next = turns_.waiting_.front() == &timer_;
        timer_.expires_at(is_next ? turns_.free_at_ : Clock::time_point::max());
        boost::system::error_code woken;
        co_await timer_.async_wait(boost::asio::redirect_error(boost::asio::use_awaitable, woken));
      }
    }

    /// Makes an answer on the loop's own thread.
    template <class Answer>
    auto make(Answer answer) {
      const auto begin = Clock::now();
      auto answered = answer();
      const auto end = Clock::now();
      if (end - begin > turns_.pause_after_) turns_.free_at_ = end + (end - begin);
      return answered;
    }

   private:
    Turns& turns_;
    boost::asio::steady_timer timer_;
  };

 private:
  std::deque<boost::asio::steady_timer*> waiting_;
  const Clock::duration pause_after_;
  Clock::time_point free_at_{};
};

/// Does `work` on the worker's thread, which nobody else uses meanwhile.
inline boost::asio::awaitable<void> elsewhere(Worker& worker, std::function<void()> work) {
  co_await boost::asio::async_initiate<const boost::asio::use_awaitable_t<>, void()>(
      [&](auto handler) {
        const auto kept = std::make_shared<decltype(handler)>(std::move(handler));
        worker.run(std::move(work), [kept] { std::move (*kept)(); });
      },
      boost::asio::use_awaitable);
}

}  // namespace recald::http
