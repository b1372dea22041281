#include "adapters/asio/asio_loop.hpp"

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>

namespace recald::asio {

using std::chrono::microseconds;
using std::chrono::milliseconds;

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
  const std::chrono::nanoseconds real = trial_ ? trial_->real_wait(wait) : wait;
  // The timer lives in its own handler, until it has fired or the context ends.
  auto timer = std::make_shared<boost::asio::steady_timer>(context_, real);
  timer->async_wait([timer, call = std::move(call)](const boost::system::error_code& error) {
    if (!error) call();
  });
}

void AsioLoop::post(Call call) { boost::asio::post(context_, std::move(call)); }

}  // namespace recald::asio
