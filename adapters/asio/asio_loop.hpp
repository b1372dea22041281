/// The loop on Boost.Asio: system clocks, timers, one thread. An exception of a call leaves the
/// context's run(), which can be called again.
#pragma once

#include <utility>  // Boost 1.74's Asio uses std::exchange without it

#include <boost/asio/io_context.hpp>
#include <memory>
#include <optional>

#include "adapters/ports/loop.hpp"
#include "core/metering/registers/trial_clock.hpp"

namespace recald::asio {

class AsioLoop final : public Loop {
 public:
  /// @param context  Run by one thread; outlives this.
  /// @param trial    The clock of a trial; absent: real time.
  explicit AsioLoop(boost::asio::io_context& context,
                    std::optional<metering::TrialClock> trial = {});

  [[nodiscard]] Moment now() const override;
  void after(std::chrono::milliseconds wait, Call call) override;
  void post(Call call) override;

 private:
  void call_after(std::chrono::milliseconds wait, const std::shared_ptr<Call>& call);

  boost::asio::io_context& context_;
  std::optional<metering::TrialClock> trial_;
  /// In a trial both clocks are derived from one. Otherwise an adjustment of the system clock by a
  /// millisecond would look as if the clock had been set.
  std::chrono::steady_clock::time_point began_;
  metering::TrialClock::Microseconds real_at_begin_;
};

}  // namespace recald::asio
