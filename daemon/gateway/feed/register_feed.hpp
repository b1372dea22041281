/// A meter or weather sensor whose registers come in one after the other, with its counters.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "daemon/gateway/feed/meter_feed.hpp"
#include "daemon/gateway/ingest/meter_track.hpp"
#include "daemon/gateway/ingest/weather_track.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// What site file and store say of it.
struct OpenedRegisters {
  std::string id;
  std::vector<MeterProgress> progress;
  LiveMeterConfig config;
  std::string text;  ///< As in MeterConfig.
  std::variant<MeterTrack, WeatherTrack> track;
  std::vector<modbus::PlannedRead> reads;
  std::string doubt = {};
};

/// Registers a meter with the store and restores its counters.
/// @param live  What its registers are: of a meter that is polled its `live`.
/// @return the meter, or the store's failure; unsupported if its reads cannot be planned.
[[nodiscard]] Result<OpenedRegisters> open_meter_registers(const MeterConfig& config,
                                                           const LiveMeterConfig& live,
                                                           const metering::LocalCalendar& calendar,
                                                           Store& store);

/// The same of a weather sensor that is polled.
[[nodiscard]] Result<OpenedRegisters> open_sensor_registers(const MeterConfig& config,
                                                            const metering::LocalCalendar& calendar,
                                                            Store& store);

class RegisterFeed : public MeterFeed {
 public:
  [[nodiscard]] const LiveMeterConfig& config() const { return config_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::vector<modbus::PlannedRead>& reads() const { return reads_; }
  /// Whether its read of that number asks for this.
  [[nodiscard]] bool makes(std::size_t read, const modbus::ReadRequest& request) const;
  [[nodiscard]] std::chrono::seconds interval() const {
    return progress().front().stored.meter.interval;
  }
  [[nodiscard]] std::vector<RefusedRegisters> refused() const;

  [[nodiscard]] MeterStatus status(metering::Instant now) const override;
  [[nodiscard]] std::optional<metering::Instant> measured_at() const override;
  [[nodiscard]] std::optional<double> now(std::uint32_t number) const override;
  [[nodiscard]] bool has_counter() const override {
    return std::holds_alternative<MeterTrack>(track_);
  }
  [[nodiscard]] StoreBatch take(const PolledRead& read, metering::Instant at) override;
  [[nodiscard]] StoreBatch take_kept(const metering::RegisterSample& sample) override;
  void clock_was_set() override;
  [[nodiscard]] std::string take_doubt() override { return std::exchange(doubt_, {}); }

 protected:
  explicit RegisterFeed(OpenedRegisters opened);
  /// @pre it is a meter
  [[nodiscard]] const MeterTrack& meter() const { return std::get<MeterTrack>(track_); }

 private:
  LiveMeterConfig config_;
  std::string text_;
  std::variant<MeterTrack, WeatherTrack> track_;
  std::vector<modbus::PlannedRead> reads_;
  std::string doubt_;
};

}  // namespace recald::daemon
