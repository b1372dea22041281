/// Requests a calibration that lacked weather again once more weather has arrived.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "adapters/ports/alive.hpp"
#include "adapters/ports/job_store.hpp"
#include "adapters/ports/loop.hpp"
#include "adapters/ports/worker.hpp"
#include "core/metering/months/month_closer.hpp"

namespace recald::daemon {

/// How much of the weather of these months is known now. Called on the worker; may be slow.
using CheckWeather =
    std::function<Result<std::vector<MonthWeather>>(const metering::MonthRange& months)>;

/// Checks once an hour, as long as the newest calibration has months with incomplete weather; once
/// a day if all of these ended long ago. Requests a calibration when one of them changes from
/// unknown to patchy, or to good: twice per month at most, however often a file grows.
class WeatherWait {
 public:
  struct Ports {
    Loop& loop;
    JobStore& store;
    Worker& worker;
  };
  WeatherWait(Ports ports, CheckWeather look, std::function<void()> ask);
  ~WeatherWait() = default;
  WeatherWait(const WeatherWait&) = delete;
  WeatherWait& operator=(const WeatherWait&) = delete;

  void start();
  /// Replaces the look-up, for another site file.
  void set_check(CheckWeather look) {
    look_ = std::move(look);
    looked_at_.reset();
  }

 private:
  /// What was known of the weather when a calibration was made, or was requested
  /// again because of it.
  struct Known {
    std::int64_t job;
    std::vector<MonthWeather> months;
  };

  void check_every_hour();
  void refresh();
  [[nodiscard]] std::optional<Known> last_known() const;
  void compare(const Known& then, std::vector<MonthWeather> now);

  Ports ports_;
  CheckWeather look_;
  std::function<void()> ask_;
  bool is_looking_ = false;
  std::optional<std::chrono::milliseconds> looked_at_;  ///< Monotonic.
  /// Whatever happens to the request, it is not repeated for the same weather.
  std::optional<Known> asked_;
  Alive alive_;
};

}  // namespace recald::daemon
