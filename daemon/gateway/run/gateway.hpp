/// The core of the daemon: meters that are polled, told by a broker or pushed become intervals,
/// which are committed, and months, which are closed.
///
/// Everything here runs on the loop's thread. Access to the outside comes as ports, so all of it
/// also runs on a virtual clock with scripted buses.
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

#include "adapters/ports/alive.hpp"
#include "adapters/ports/bus.hpp"
#include "adapters/ports/loop.hpp"
#include "adapters/ports/store.hpp"
#include "daemon/gateway/feed/live_bus.hpp"
#include "daemon/gateway/feed/mqtt_feed.hpp"
#include "daemon/gateway/feed/pushed_feed.hpp"
#include "daemon/gateway/ingest/committer.hpp"
#include "daemon/gateway/ingest/correction.hpp"
#include "daemon/gateway/ingest/gateway_status.hpp"
#include "daemon/gateway/ingest/meter_message.hpp"
#include "daemon/gateway/ingest/meter_watch.hpp"
#include "daemon/gateway/ingest/month_keeper.hpp"
#include "daemon/gateway/recording/entry.hpp"
#include "daemon/gateway/run/clock_watch.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// Called for each event when it happens, whether or not the store accepts it.
using OnEvent = std::function<void(const StoreEvent&)>;

/// The gateway's access to the outside. All of it outlives the gateway.
struct GatewayPorts {
  Loop& loop;
  Store& store;
  /// Empty: no bus is opened and nothing is done by the hour, because a recording says what is read
  /// (`take_read`) and when what is done (`tick`).
  std::function<std::unique_ptr<Bus>(const BusConfig&)> make_bus;
  std::string time_zone_release;
  std::uint64_t seed = 1;
  /// Absent: the loop's time is a trial's.
  std::optional<ClockEvidence> clock = {};
  OnEvent on_event = {};
  recording::Listener* recorder = nullptr;  ///< Is told of all that comes in.
};

/// Called when a month has closed, or closed again.
using OnMonth = std::function<void(const metering::Meter&, const metering::MonthlyFigure&)>;

class Gateway {
 public:
  /// Registers the meters with the store and restores their counters.
  /// @return the gateway, or the store's failure; unsupported if a meter's reads cannot be planned.
  [[nodiscard]] static Result<std::unique_ptr<Gateway>> open(
      const SiteConfig& site, const metering::LocalCalendar& calendar, const GatewayPorts& ports,
      OnMonth on_month);
  ~Gateway();
  Gateway(const Gateway&) = delete;
  Gateway& operator=(const Gateway&) = delete;

  /// Takes over what a gateway kept in memory while this one's store could not be opened:
  /// counters continue through its samples, and intervals of other meters are added. Call it
  /// before the start.
  /// @param on_progress  Called from time to time.
  /// @return or the store's failure: then nothing was taken over, and this gateway cannot be used.
  [[nodiscard]] Result<void> take_over(Store& memory,
                                       const std::function<void()>& on_progress = {});

  /// Starts polling, and closes months that became due while the daemon was not running.
  void start();

  /// Continues with another site file. All buses restart. A bus with the same description keeps its
  /// meters and their counters; the others are opened from the state in the store.
  /// @return or an error as in `open`; then nothing has changed.
  /// @pre the site's time zone is the same
  Result<void> reload(const SiteConfig& site);

  /// Restarts all buses soon, one after the other: closes each connection and forgets misses,
  /// learned time-outs and refusals. Counters continue.
  void begin_buses_anew();

  /// Stores pushed readings, of a meter with source = "http" or of a channel of such a weather
  /// sensor ("roof.dry_bulb_C"). They are on disk when this returns.
  /// @param readings    Their `meter` is ignored.
  /// @param correction  If given, they replace good readings too, as an edit.
  /// @return the counts; or not_found for a meter that accepts none, or the store's failure; then
  ///         nothing is stored.
  [[nodiscard]] Result<CommitCounts> take_pushed(const std::string& meter,
                                                 std::vector<metering::Reading> readings,
                                                 const std::optional<Correction>& correction = {});

  /// Takes samples of a counter that are pushed, of a meter with source = "http" and a counter.
  /// They, and what they make of its intervals, are on disk when this returns.
  /// @return how many were taken, and as duplicates how many are not later than the last; or
  ///         not_found for a meter without such a counter, or the store's failure: then nothing is
  ///         acknowledged, and sending them again does no harm.
  [[nodiscard]] Result<CommitCounts> take_samples(const std::string& meter,
                                                  std::vector<metering::RegisterSample> samples);

  /// Takes a value of a meter with source = "mqtt". One that is not later than the last is left
  /// out: a broker may deliver twice, and out of order.
  /// @return whether it was taken; not_found for a meter that lacks such a value.
  [[nodiscard]] Result<bool> accept_mqtt(const MeterValue& value);

  /// Takes a read of a recording at the loop's time, as if a bus had made it.
  /// @return or unsupported, if this program makes no such read of that meter.
  [[nodiscard]] Result<void> take_read(const recording::Read& read);

  /// Does what falls due each minute or hour.
  void tick(recording::Tick which);

  /// All meters and channels of weather sensors.
  [[nodiscard]] std::vector<StoredMeter> meters() const;

  /// Adds an event for people to find.
  void note(StoreEvent event) { submit({.events = {std::move(event)}}); }

  /// Counts an event that somebody else has stored.
  void count_stored(const StoreEvent& event);

  /// Commits everything pending. Call it before the end.
  Result<void> flush() { return committer_.flush(); }

  [[nodiscard]] GatewayStatus status() const;
  /// Why readings cannot be stamped yet; empty: they can.
  [[nodiscard]] const std::string& clock_doubt() const { return clock_.doubt(); }

  /// The status of one meter, without the others. @return nothing for one without stored readings.
  [[nodiscard]] std::optional<MeterStatus> meter_status(std::string_view id) const;

 private:
  /// A read from before the clock was right.
  struct HeldRead {
    std::uint32_t meter;  ///< Its number, since a reload may replace the meter meanwhile.
    PolledRead read;
  };

  Gateway(const metering::LocalCalendar& calendar, const SiteConfig& site,
          const GatewayPorts& ports, OnMonth on_month);

  /// Opens the buses of `site`, except those among `kept`.
  [[nodiscard]] Result<std::vector<std::unique_ptr<LiveBus>>> open_buses(
      const SiteConfig& site, std::span<const std::unique_ptr<LiveBus>> kept);
  void start(LiveBus& bus, metering::Instant now);
  [[nodiscard]] LiveBus::Ports ports_of(const LiveBus& bus) const;
  /// Opens the meters with source = "mqtt".
  [[nodiscard]] Result<std::vector<std::unique_ptr<MqttFeed>>> open_mqtt(const SiteConfig& site);
  /// Opens the pushed meters and weather sensors of `site`, which go on from those already open.
  [[nodiscard]] Result<std::vector<std::unique_ptr<PushedFeed>>> open_pushed(
      const SiteConfig& site);
  void gather_feeds();
  void note_doubt(MeterFeed& feed, metering::Instant now);
  /// Meters and weather sensors that stay are watched further.
  void watch_meters_of(const SiteConfig& site);
  void watch_sensors_of(const SiteConfig& site);
  void tick_again(recording::Tick which, std::chrono::milliseconds every);
  /// Tells the recorder. Call it after `watch_clock`, and before anything is done.
  void tell(const Moment& at, recording::What what);
  void tell_read(const MeterFeed& feed, const PolledRead& read);
  void evaluate_meters(const Moment& at);
  void evaluate_sensors(metering::Instant now);
  [[nodiscard]] MeterFeed* find_feed(std::uint32_t number);
  [[nodiscard]] std::vector<MeterProgress*> all_progress();
  [[nodiscard]] MeterProgress* find_progress(std::uint32_t number);
  [[nodiscard]] Result<void> take_over_all(Store& memory, const std::function<void()>& on_progress);
  [[nodiscard]] Result<void> take_over_samples(MeterFeed& feed,
                                               std::span<const metering::RegisterSample> samples);
  [[nodiscard]] Result<void> take_over_intervals(MeterProgress& progress, Store& memory,
                                                 std::uint32_t number);
  /// Passes a batch to the committer.
  void submit(StoreBatch batch);
  void take(MeterFeed& feed, const PolledRead& read);
  void take_or_hold(MeterFeed& feed, const PolledRead& read);
  void take_at(MeterFeed& feed, const PolledRead& read, metering::Instant at);
  void watch_clock(const Moment& now);
  void release_held(const Moment& now);
  /// Commits the batch and, if it changes anything, its edit at once.
  [[nodiscard]] Result<CommitCounts> commit_pushed(StoreBatch& batch,
                                                   const std::optional<Correction>& correction,
                                                   metering::Instant now);
  void report_pushed(const std::string& meter, const CommitCounts& counts,
                     const std::optional<Correction>& correction, metering::Instant now);
  /// @param why  Of the store; empty: it accepts again.
  void report_refusal(const std::string& why);
  void note_committed(const StoreBatch& batch, const CommitCounts& counts);
  [[nodiscard]] MeterStatus status_of(const MeterFeed& feed) const;
  void add_quantity(MeterStatus& status, const MeterProgress& progress,
                    std::optional<double> now) const;
  [[nodiscard]] double coverage_of(const MeterProgress& progress) const;
  void close_months(const Moment& at);
  void close_months_of(std::vector<std::uint32_t> meters, metering::Instant now);
  /// @return whether there may be more.
  bool close_months_of(const MeterProgress& meter, metering::Instant now);
  /// Does it after whatever else waits for the loop.
  void post_step(std::function<void(const Moment&)> step);

  metering::LocalCalendar calendar_;
  GatewayPorts ports_;
  OnMonth on_month_;
  Committer committer_;
  MonthKeeper keeper_;
  std::vector<std::unique_ptr<LiveBus>> buses_;  ///< In order of the site file.
  std::vector<std::unique_ptr<MqttFeed>> mqtt_;
  std::vector<std::unique_ptr<PushedFeed>> pushed_;
  std::vector<MeterFeed*> feeds_;                    ///< All of them: polled, of a broker, pushed.
  std::map<std::string, MeterWatch> meter_watches_;  ///< By id.
  std::map<std::string, SensorWatch> watches_;       ///< By id of the weather sensor.
  ClockWatch clock_;
  std::array<std::uint64_t, 3> events_{};                         ///< Committed, by Severity.
  std::optional<std::chrono::milliseconds> refusal_reported_at_;  ///< By the monotonic clock.
  bool is_refusal_reported_ = false;                              ///< It goes on.
  std::deque<HeldRead> held_;
  Alive alive_;
};

}  // namespace recald::daemon
