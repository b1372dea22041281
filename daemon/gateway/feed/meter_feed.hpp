/// One meter or weather sensor whose readings come in while the daemon runs: polled on a bus, in a
/// broker's messages, or pushed over HTTP.
#pragma once

#include <cassert>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adapters/ports/store.hpp"
#include "daemon/gateway/ingest/gateway_status.hpp"
#include "daemon/gateway/ingest/meter_progress.hpp"
#include "daemon/gateway/poll/bus_runner.hpp"

namespace recald::daemon {

class MeterFeed {
 public:
  virtual ~MeterFeed() = default;
  MeterFeed(const MeterFeed&) = delete;
  MeterFeed& operator=(const MeterFeed&) = delete;

  [[nodiscard]] const std::string& id() const { return id_; }
  /// One of a meter, or one per quantity of a sensor.
  [[nodiscard]] std::span<MeterProgress> progress() { return progress_; }
  [[nodiscard]] std::span<const MeterProgress> progress() const { return progress_; }
  [[nodiscard]] bool is_sensor() const { return progress_.front().channel.has_value(); }

  /// Id, poll and live values; what is stored of it is added by the gateway.
  [[nodiscard]] virtual MeterStatus status(metering::Instant now) const = 0;
  /// When a meter last gave a value, in this process; nothing of a sensor, whose quantities are
  /// watched one by one.
  [[nodiscard]] virtual std::optional<metering::Instant> measured_at() const = 0;
  /// The last value of a sensor's quantity, in its unit.
  [[nodiscard]] virtual std::optional<double> now(std::uint32_t /*number*/) const { return {}; }

  /// Whether its intervals come from a counter, whose samples are kept.
  [[nodiscard]] virtual bool has_counter() const { return false; }

  // Of feeds by registers; pushed ones have none.
  [[nodiscard]] virtual StoreBatch take(const PolledRead& /*read*/, metering::Instant /*at*/) {
    return {};
  }
  /// A counter sample from the time without a store, in order of time.
  [[nodiscard]] virtual StoreBatch take_kept(const metering::RegisterSample& /*sample*/) {
    return {};
  }
  virtual void clock_was_set() {}
  /// What was wrong with its stored state, once; empty: nothing.
  [[nodiscard]] virtual std::string take_doubt() { return {}; }

 protected:
  /// @pre progress is not empty
  MeterFeed(std::string id, std::vector<MeterProgress> progress)
      : id_(std::move(id)), progress_(std::move(progress)) {
    assert(!progress_.empty());
  }

 private:
  std::string id_;
  std::vector<MeterProgress> progress_;
};

}  // namespace recald::daemon
