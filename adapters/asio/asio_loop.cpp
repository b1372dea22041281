#include "adapters/asio/asio_loop.hpp"

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>

namespace recald::asio {

using std::chrono::microseconds;
using std::chrono::milliseconds;

namespace {

constexpr std::chrono::minutes kAgainAfterThrow{1};

}  // namespace

AsioLoop::AsioLoop(boost::asio::io_context& context, std::optional<metering::TrialClock> trial)
    : context_(context),
      trial_(trial),
      began_(std::chrono::steady_clock::now()),
      real_at_begin_(std::chrono::floor<microseconds>(std::chrono::system_clock::now())) {}

Moment AsioLoop::now() const {
  const auto steady = std::chrono::steady_clock::now();
  if (trial_) {
    const auto real = real_at_begin_ + std::chrono::floor<microseconds>(steady - began_);
    const auto wall = trial_->simulated(real);
    return {wall, wall - trial_->simulated(real_at_begin_)};
  }
  return {std::chrono::floor<milliseconds>(std::chrono::system_clock::now()),
          std::chrono::duration_cast<milliseconds>(steady.time_since_epoch())};
}

void AsioLoop::after(milliseconds wait, Call call) {
  call_after(wait, std::make_shared<Call>(std::move(call)));
}

void AsioLoop::call_after(milliseconds wait, const std::shared_ptr<Call>& call) {
  const std::chrono::nanoseconds real_wait = trial_ ? trial_->real_wait(wait) : wait;
  // The handler owns the timer until it fires or the context ends.
  auto timer = std::make_shared<boost::asio::steady_timer>(context_, real_wait);
  timer->async_wait([this, timer, call](const boost::system::error_code& error) {
    if (error) return;
    try {
      (*call)();
    } catch (...) {
      call_after(kAgainAfterThrow, call);
      throw;
    }
  });
}

void AsioLoop::post(Call call) { boost::asio::post(context_, std::move(call)); }

}  // namespace recald::asio
