/// A meter or weather sensor whose readings are sent to the daemon's API.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "daemon/gateway/feed/meter_feed.hpp"
#include "daemon/gateway/feed/rising_watch.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

class PushedFeed final : public MeterFeed {
 public:
  /// Of a meter, or of a weather sensor with all its quantities.
  /// @return or the store's failure
  [[nodiscard]] static Result<std::unique_ptr<PushedFeed>> open(
      const MeterConfig& config, const metering::LocalCalendar& calendar, Store& store);

  /// Takes over what those of an earlier site file counted and heard.
  void go_on_from(std::span<const std::unique_ptr<PushedFeed>> before);

  /// What is stored under this id: the meter, or one quantity of the sensor; null: nothing.
  [[nodiscard]] MeterProgress* find(std::string_view stored_id);

  /// Marks readings as suspect that look like those of a register, where nothing says how much the
  /// meter can measure.
  [[nodiscard]] RisingWatch::Doubt doubt_rising(const MeterProgress& of,
                                                std::vector<metering::Reading>& readings);

  /// @param has_new  Something in what was sent was not stored yet.
  void note_heard(const MeterProgress& of, metering::Instant at, bool has_new);

  [[nodiscard]] MeterStatus status(metering::Instant now) const override;
  [[nodiscard]] std::optional<metering::Instant> measured_at() const override {
    return is_sensor() ? std::nullopt : heard_.front().new_at;
  }

 private:
  /// Since the process started.
  struct Heard {
    std::optional<metering::Instant> at = {};
    std::optional<metering::Instant> new_at = {};  ///< It sent something new.
  };

  PushedFeed(std::string id, std::vector<MeterProgress> progress)
      : MeterFeed(std::move(id), std::move(progress)), heard_(this->progress().size()) {}

  std::vector<Heard> heard_;  ///< By progress.
  RisingWatch rising_;
};

}  // namespace recald::daemon
