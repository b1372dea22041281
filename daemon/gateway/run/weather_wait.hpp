/// A calibration that lacked weather is made again when more of it has come.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "adapters/ports/loop.hpp"
#include "adapters/ports/store.hpp"
#include "adapters/ports/worker.hpp"
#include "core/metering/month_closer.hpp"

namespace recald::daemon {

/// How much is known of the weather of these months now. Called on the worker; may be slow.
using LookAtWeather =
    std::function<Result<std::vector<MonthWeather>>(const metering::MonthRange& months)>;

/// Once an hour, as long as the newest calibration has months whose weather is not all known. It is
/// asked for again when one of them gets from unknown to patchy, or to good: twice a month at most,
/// however often a file grows.
class WeatherWait {
 public:
  struct Ports {
    Loop& loop;
    Store& store;
    Worker& worker;
  };
  WeatherWait(Ports ports, LookAtWeather look, std::function<void()> ask);
  ~WeatherWait() = default;
  WeatherWait(const WeatherWait&) = delete;
  WeatherWait& operator=(const WeatherWait&) = delete;

  void start();
  /// Another site file holds from now on.
  void set_look(LookAtWeather look) { look_ = std::move(look); }

 private:
  void look_every_hour();
  void look_again();
  void compare(const std::vector<MonthWeather>& then, const std::vector<MonthWeather>& now) const;

  Ports ports_;
  LookAtWeather look_;
  std::function<void()> ask_;
  bool is_looking_ = false;
  std::shared_ptr<WeatherWait*> self_;
};

}  // namespace recald::daemon
