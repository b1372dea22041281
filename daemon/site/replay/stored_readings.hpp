/// Readings of live meters from the daemon's store, for calibrating, diagnosing or replaying while
/// the daemon keeps writing.
#pragma once

#include <memory>
#include <string>

#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/replay/recording.hpp"

namespace recald::daemon {

class StoredReadings final : public LiveReadings {
 public:
  /// Opens the site's store for reading.
  /// @return not_found when there is none yet; or as stores::open_to_read.
  [[nodiscard]] static Result<std::unique_ptr<StoredReadings>> open(const SiteConfig& site);
  ~StoredReadings() override;

  Result<std::vector<metering::MonthlyFigure>> months(const MeterConfig& meter) override;
  Result<int> waiting_months(const MeterConfig& meter) override;
  Result<std::uint64_t> for_each(const MeterConfig& meter, const metering::TimeSpan& span,
                                 const ReadingSink& sink) override;
  Result<std::optional<metering::Instant>> first_start(const MeterConfig& meter) override;

  /// SHA-256 of all months and readings that were returned. Finishes the digest.
  [[nodiscard]] std::string digest();

 private:
  struct Impl;
  explicit StoredReadings(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// The readings of the site's weather sensors. Null for a site without sensors, or one whose daemon
/// has not run yet: the weather file may be enough.
/// @return or as StoredReadings::open.
[[nodiscard]] Result<std::unique_ptr<StoredReadings>> open_sensors(const SiteConfig& site);

}  // namespace recald::daemon
