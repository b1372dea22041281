/// The daemon's heart: buses are polled, registers become intervals, intervals are committed,
/// months close.
///
/// Everything that happens here happens on the loop's thread. What it needs of the outside comes as
/// ports, so that the whole of it runs on a virtual clock with scripted buses.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adapters/ports/bus.hpp"
#include "adapters/ports/loop.hpp"
#include "adapters/ports/store.hpp"
#include "daemon/config/site_config.hpp"
#include "daemon/ingest/committer.hpp"
#include "daemon/ingest/meter_track.hpp"
#include "daemon/poll/bus_runner.hpp"
#include "daemon/run/month_keeper.hpp"

namespace recald::daemon {

/// What the gateway needs of the outside. All of it outlives the gateway.
struct GatewayPorts {
  Loop& loop;
  Store& store;
  std::function<std::unique_ptr<Bus>(const BusConfig&)> make_bus;
  std::string time_zone_release;
  std::uint64_t seed = 1;
};

/// A month has closed, or closed again.
using OnMonth = std::function<void(const metering::Meter&, const metering::MonthlyFigure&)>;

/// One live meter as people see it.
struct MeterStatus {
  std::string id;
  std::string bus;
  UnitState state = UnitState::up;
  LiveValues live;
  std::optional<metering::Reading> last_interval;  ///< Committed.
  std::uint64_t skipped_polls = 0;
};

struct GatewayStatus {
  bool clock_ok = false;
  CommitHealth store;
  std::vector<MeterStatus> meters;
};

class Gateway {
 public:
  /// Registers the meters with the store and takes up their counters where they stopped.
  /// @return or the store's failure; unsupported where a meter's reads cannot be planned.
  [[nodiscard]] static Result<std::unique_ptr<Gateway>> open(
      const SiteConfig& site, const metering::LocalCalendar& calendar, const GatewayPorts& ports,
      OnMonth on_month);
  ~Gateway();
  Gateway(const Gateway&) = delete;
  Gateway& operator=(const Gateway&) = delete;

  /// Polls begin, and months that fell due while nobody ran are closed.
  void start();

  /// Commits what is still on its way. Call it before the end.
  Result<void> flush() { return committer_.flush(); }

  [[nodiscard]] GatewayStatus status() const;

 private:
  struct LiveMeter {
    StoredMeter stored;
    LiveMeterConfig config;
    MeterTrack track;
    std::vector<modbus::PlannedRead> reads;
    std::size_t bus;   ///< Index into buses_.
    std::size_t unit;  ///< Index on that bus.
    std::optional<metering::Reading> last_interval;
    metering::Instant closed_until = metering::Instant::min();  ///< End of the last closed month.
  };
  struct LiveBus {
    BusConfig config;
    std::vector<std::size_t> meters;  ///< By unit on the bus.
    std::unique_ptr<BusRunner> runner;
  };
  /// A read from before the clock was right.
  struct HeldRead {
    std::size_t meter;
    PolledRead read;
  };

  Gateway(const metering::LocalCalendar& calendar, const SiteConfig& site,
          const GatewayPorts& ports, OnMonth on_month);

  [[nodiscard]] Result<void> add_meter(const MeterConfig& config);
  [[nodiscard]] Result<void> restore(LiveMeter& meter);
  void make_runners();
  void take(std::size_t bus, const PolledRead& read);
  void take_for_meter(std::size_t meter, const PolledRead& read, metering::Instant at);
  void watch_clock(const Moment& now);
  void release_held(const Moment& now);
  void mark_late(StoreBatch& batch, LiveMeter& meter);
  void note_committed(const StoreBatch& batch);
  void close_months();
  void close_months_every_hour();

  metering::LocalCalendar calendar_;
  GatewayPorts ports_;
  OnMonth on_month_;
  Committer committer_;
  MonthKeeper keeper_;
  std::vector<LiveMeter> meters_;
  std::vector<LiveBus> buses_;
  std::optional<std::chrono::milliseconds> wall_minus_monotonic_;
  bool clock_ok_ = false;
  std::deque<HeldRead> held_;
  std::shared_ptr<Gateway*> self_;
};

}  // namespace recald::daemon
