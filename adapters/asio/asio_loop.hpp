/// The loop on Boost.Asio: system clocks, timers, one thread.
#pragma once

#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <boost/asio/io_context.hpp>

#include "adapters/ports/loop.hpp"

namespace recald::asio {

class AsioLoop final : public Loop {
 public:
  /// @param context  Run by one thread; outlives this.
  explicit AsioLoop(boost::asio::io_context& context) : context_(context) {}

  [[nodiscard]] Moment now() const override;
  void after(std::chrono::milliseconds wait, Call call) override;
  void post(Call call) override;

 private:
  boost::asio::io_context& context_;
};

}  // namespace recald::asio
