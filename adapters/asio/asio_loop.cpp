#include "adapters/asio/asio_loop.hpp"

#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>

namespace recald::asio {

using std::chrono::milliseconds;

Moment AsioLoop::now() const {
  return {std::chrono::floor<milliseconds>(std::chrono::system_clock::now()),
          std::chrono::duration_cast<milliseconds>(
              std::chrono::steady_clock::now().time_since_epoch())};
}

void AsioLoop::after(milliseconds wait, Call call) {
  // The timer lives in its own handler, until it has fired or the context ends.
  auto timer = std::make_shared<boost::asio::steady_timer>(context_, wait);
  timer->async_wait([timer, call = std::move(call)](const boost::system::error_code& error) {
    if (!error) call();
  });
}

void AsioLoop::post(Call call) { boost::asio::post(context_, std::move(call)); }

}  // namespace recald::asio
