/// The daemon's heart: buses are polled, registers become intervals, intervals are committed,
/// months close.
///
/// Everything that happens here happens on the loop's thread. What it needs of the outside comes as
/// ports, so that the whole of it runs on a virtual clock with scripted buses.
#pragma once

#include <array>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/ports/bus.hpp"
#include "adapters/ports/loop.hpp"
#include "adapters/ports/store.hpp"
#include "daemon/gateway/ingest/committer.hpp"
#include "daemon/gateway/ingest/correction.hpp"
#include "daemon/gateway/ingest/gateway_status.hpp"
#include "daemon/gateway/ingest/month_keeper.hpp"
#include "daemon/gateway/run/live_bus.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// Told of each event as it happens, whether the store takes it or not.
using OnEvent = std::function<void(const StoreEvent&)>;

/// What the gateway needs of the outside. All of it outlives the gateway.
struct GatewayPorts {
  Loop& loop;
  Store& store;
  std::function<std::unique_ptr<Bus>(const BusConfig&)> make_bus;
  std::string time_zone_release;
  std::uint64_t seed = 1;
  /// The clock is about to be set; not asked any more once it has said no. Absent: never.
  std::function<bool()> is_clock_settling = {};
  OnEvent on_event = {};
};

/// A month has closed, or closed again.
using OnMonth = std::function<void(const metering::Meter&, const metering::MonthlyFigure&)>;

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

  /// Takes over what a gateway has kept in memory while this one's store could not be opened:
  /// counters go on through its samples, and other meters' intervals are added. Call it before the
  /// start.
  /// @param on_progress  Told now and then that it goes on.
  /// @return or the store's failure: then nothing was taken over, and this gateway cannot be used.
  [[nodiscard]] Result<void> take_over(Store& memory,
                                       const std::function<void()>& on_progress = {});

  /// Starts polling, and closes months that became due while the daemon was not running.
  void start();

  /// Continues with another site file. All buses restart. A bus that is described as before keeps
  /// its meters with their counters; the others are opened from the state in the store.
  /// @return or why not, as `open`; then everything is as it was.
  /// @pre the site's time zone is the same
  Result<void> reload(const SiteConfig& site);

  /// Soon, one after the other: each connection is closed, and misses, learned time-outs and
  /// refusals are forgotten. Counters go on.
  void begin_buses_anew();

  /// Pushed readings, of a meter with source = "http" or of a channel of such a weather sensor
  /// ("roof.dry_bulb_C"). They are stored when it answers.
  /// @param readings    Their `meter` is not looked at.
  /// @param correction  With a correction they replace good readings too, as an edit.
  /// @return not_found for a meter that takes none, or the store's failure; then nothing is stored.
  [[nodiscard]] Result<CommitCounts> take_pushed(const std::string& meter,
                                                 std::vector<metering::Reading> readings,
                                                 const std::optional<Correction>& correction = {});

  /// For people to find it among the events.
  void note(StoreEvent event) { hand_in({.events = {std::move(event)}}); }

  /// Commits what is still on its way. Call it before the end.
  Result<void> flush() { return committer_.flush(); }

  [[nodiscard]] GatewayStatus status() const;

  /// Of one meter, without looking at all. @return nothing for one that the store keeps nothing of.
  [[nodiscard]] std::optional<MeterStatus> meter_status(std::string_view id) const;

 private:
  /// A meter with source = "http", or a quantity of such a sensor: its readings come in by HTTP.
  struct PushedMeter {
    MeterProgress progress;
    std::optional<metering::Instant> heard_at;  ///< Since the process began.
  };

  /// A read from before the clock was right.
  struct HeldRead {
    std::uint32_t meter;  ///< Its number: a reload may replace the meter meanwhile.
    PolledRead read;
  };

  Gateway(const metering::LocalCalendar& calendar, const SiteConfig& site,
          const GatewayPorts& ports, OnMonth on_month);

  /// Opens the buses of `site`, but those that are among `kept`.
  [[nodiscard]] Result<std::vector<std::unique_ptr<LiveBus>>> open_buses(
      const SiteConfig& site, std::span<const std::unique_ptr<LiveBus>> kept);
  void start(LiveBus& bus);
  [[nodiscard]] LiveBus::Ports ports_of(const LiveBus& bus) const;
  /// Opens the pushed meters and weather sensors of `site`; what is known of them stays.
  Result<void> open_pushed(const SiteConfig& site);
  [[nodiscard]] PushedMeter again_pushed(MeterProgress progress) const;
  /// Weather sensors that stay are watched on.
  void watch_sensors_of(const SiteConfig& site);
  void judge_sensors();
  [[nodiscard]] LiveMeter* find_meter(std::uint32_t number);
  [[nodiscard]] std::vector<MeterProgress*> all_progress();
  [[nodiscard]] MeterProgress* find_progress(std::uint32_t number);
  [[nodiscard]] Result<void> take_over_all(Store& memory, const std::function<void()>& on_progress);
  [[nodiscard]] Result<void> take_over_samples(LiveMeter& meter,
                                               std::span<const metering::RegisterSample> samples);
  [[nodiscard]] Result<void> take_over_intervals(MeterProgress& progress, Store& memory,
                                                 std::uint32_t number);
  /// To be committed soon.
  void hand_in(StoreBatch batch);
  void take(LiveMeter& meter, const PolledRead& read);
  void take_at(LiveMeter& meter, const PolledRead& read, metering::Instant at);
  void watch_clock(const Moment& now);
  void release_held(const Moment& now);
  /// As one commit: the batch, and the edit that it belongs to if it changes anything.
  [[nodiscard]] Result<CommitCounts> commit_pushed(StoreBatch& batch,
                                                   const std::optional<Correction>& correction,
                                                   metering::Instant now);
  void tell_of_pushed(const std::string& meter, const CommitCounts& counts,
                      const std::optional<Correction>& correction, metering::Instant now);
  void note_committed(const StoreBatch& batch, const CommitCounts& counts);
  [[nodiscard]] MeterStatus status_of(const LiveBus& bus, std::size_t unit,
                                      const BusRunner& runner) const;
  [[nodiscard]] MeterStatus status_of(const PushedMeter& meter) const;
  [[nodiscard]] MeterStatus status_of_pushed_sensor(const std::string& sensor) const;
  void add_quantity(MeterStatus& status, const MeterProgress& progress,
                    std::optional<double> now) const;
  [[nodiscard]] double coverage_of(const MeterProgress& progress) const;
  void close_months();
  void close_months_of(std::vector<std::uint32_t> meters);
  /// @return whether it may have more.
  bool close_months_of(const MeterProgress& meter);
  void close_months_every_hour();

  metering::LocalCalendar calendar_;
  GatewayPorts ports_;
  OnMonth on_month_;
  Committer committer_;
  MonthKeeper keeper_;
  std::vector<std::unique_ptr<LiveBus>> buses_;  ///< In order of the site file.
  std::optional<std::chrono::milliseconds> wall_minus_monotonic_;
  std::vector<PushedMeter> pushed_;
  std::map<std::string, SensorWatch> watches_;  ///< By id of a weather sensor.
  bool clock_ok_ = false;
  std::array<std::uint64_t, 3> events_{};  ///< Committed, by Severity.
  std::deque<HeldRead> held_;
  std::shared_ptr<Gateway*> self_;
};

}  // namespace recald::daemon
