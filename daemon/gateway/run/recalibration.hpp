/// Decides when to calibrate the site's model again automatically.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "adapters/ports/alive.hpp"
#include "adapters/ports/loop.hpp"
#include "adapters/ports/store.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

class Recalibration {
 public:
  /// @param ask  Requests a calibration; gets the reason, "month" or "schedule".
  Recalibration(Loop& loop, const SiteConfig& site, metering::LocalCalendar calendar,
                std::function<void(const std::string& asked_by)> ask);
  ~Recalibration() = default;
  Recalibration(const Recalibration&) = delete;
  Recalibration& operator=(const Recalibration&) = delete;

  /// Waits for the scheduled times, if there are any. Times when the daemon was not
  /// running are skipped.
  void start();

  /// Requests a calibration if the last common month of all modelled meters has closed and none was
  /// requested since: the process may have been killed in between, or the months were imported.
  /// @return or the store's failure.
  Result<void> catch_up(Store& store, const SiteConfig& site);

  /// Call when a month of this meter has closed, or closed again. Months of several meters that
  /// close within a minute cause one request.
  void month_closed(const std::string& meter);

 private:
  void wait_for(metering::Instant next);

  Loop& loop_;
  Schedule schedule_;
  std::vector<std::string> modelled_meters_;
  metering::LocalCalendar calendar_;
  std::function<void(const std::string&)> ask_;
  bool is_asking_ = false;
  Alive alive_;
};

}  // namespace recald::daemon
