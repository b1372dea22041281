/// Closed months, the rules that closed them, and what was forecast of them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/metering/months/monthly_figure.hpp"
#include "core/result.hpp"

namespace recald {

/// A closed month as stored.
struct StoredMonth {
  metering::MonthlyFigure figure;
  metering::Instant closed_at;
  std::string time_zone_release;  ///< Used when it was closed.
};

struct MeterMonth {
  std::uint32_t meter;
  metering::Month month;

  bool operator==(const MeterMonth&) const = default;
};

/// A forecast of one month of one output, made before its figure was seen, and how it compared.
struct StoredForecast {
  std::string output;  ///< "steam_daily_kWh"
  metering::Month month;
  int revision = 0;  ///< Set by the store, per output and month.
  std::string model_version;
  std::string data_revision;  ///< Of the readings when the forecast was made.
  metering::Instant made;
  double mean = 0.0, sd = 0.0;  ///< In the output's unit, as the next four.
  double q05 = 0.0, q50 = 0.0, q95 = 0.0;
  double measured = 0.0;
  double pit = 0.0;
  double standardised = 0.0;
  double log_score = 0.0;
  double crps = 0.0;
};

class MonthStore {
 public:
  virtual ~MonthStore() = default;

  /// Closed months that have changed since, until they are stored again.
  virtual Result<std::vector<MeterMonth>> reopened() = 0;

  /// Stores a month's figure, as revision 0 or the next. @return the revision.
  virtual Result<int> put_month(std::uint32_t meter, const metering::MonthlyFigure& figure,
                                const std::string& time_zone_release, metering::Instant now) = 0;

  /// The latest revision of each month, ascending.
  virtual Result<std::vector<StoredMonth>> months(std::uint32_t meter) = 0;

  /// The rules by which the meter's months were closed; empty: none yet.
  virtual Result<std::string> closing_rules(std::uint32_t meter) = 0;

  /// Sets the rules by which the meter's months are closed from now on. If they differ from the
  /// previous ones, closed months are reopened. @return how many.
  virtual Result<int> put_closing_rules(std::uint32_t meter, const std::string& rules) = 0;

  /// Adds only new forecasts. If the same model version already forecast the same figure, the old
  /// one stays; another figure or model version adds a revision. A forecast with a NaN is skipped:
  /// it could not be compared, and a caller that retries after failures would retry forever.
  virtual Result<void> add_forecasts(std::span<const StoredForecast> forecasts) = 0;

  /// Ordered by output, month and revision.
  virtual Result<std::vector<StoredForecast>> forecasts() = 0;
};

}  // namespace recald
