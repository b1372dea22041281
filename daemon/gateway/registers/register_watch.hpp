/// Keeps the registers up to date, a little at a time.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adapters/ports/alive.hpp"
#include "adapters/ports/loop.hpp"
#include "daemon/gateway/registers/month_so_far.hpp"
#include "daemon/gateway/registers/register_facts.hpp"
#include "daemon/gateway/serve/api/served.hpp"

namespace recald::daemon {

/// What the gateway knows is asked every two seconds. What the store has of a meter's months is
/// read when the meter has a new interval, one meter in a step of the loop; what a calibration says
/// when something has changed, and every six hours all of it.
class RegisterWatch {
 public:
  /// Called with all values, every two seconds.
  using Publish = std::function<void(const SiteFacts&)>;

  RegisterWatch(Loop& loop, Served served, Publish publish);
  RegisterWatch(const RegisterWatch&) = delete;
  RegisterWatch& operator=(const RegisterWatch&) = delete;

  void start();

  /// A month was closed or a job has ended: months and results are read again.
  void refresh();

  /// As of now, with what has been read so far.
  [[nodiscard]] SiteFacts facts() const { return facts_of(served_.status()); }

 private:
  struct MeterMonths {
    std::optional<MonthSoFar> open;
    std::optional<metering::MonthlyFigure> closed;
    std::optional<metering::Instant> last_start;  ///< Of the last interval that was heard of.
    bool has_news = true;                         ///< To be read on …
    bool is_due = true;                           ///< … or from the month's beginning.
  };
  struct Results {
    std::optional<metering::Instant> calibrated;
    std::optional<DriftSummary> drift;
    AlarmCode named = AlarmCode::none;
    std::vector<StoredForecast> forecasts;
  };

  void renew();
  void note_news(const GatewayStatus& status);
  void refresh_every_six_hours();
  void read_results();
  void read_next();
  void read(const MeterConfig& config, MeterMonths& months);
  [[nodiscard]] SiteFacts facts_of(const GatewayStatus& status) const;
  [[nodiscard]] MeterFacts facts_of(const MeterConfig& config, const MeterStatus* status) const;
  void add_months(const MeterConfig& config, MeterFacts& facts) const;
  void add_expected(const std::string& meter, MeterFacts& facts) const;
  void add_forecast(const ExpectedMonth& month, MeterFacts& facts) const;

  Loop& loop_;
  Served served_;
  Publish publish_;
  std::map<std::string, MeterMonths> months_;  ///< By meter.
  Results results_;
  bool results_are_due_ = true;
  bool is_reading_ = false;  ///< A step is on its way.
  std::size_t next_ = 0;     ///< Place in the site of the meter to look at next.
  Alive alive_;
};

}  // namespace recald::daemon
