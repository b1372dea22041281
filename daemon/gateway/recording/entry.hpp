/// What comes into a gateway from outside, and when: all that its intervals, months and events
/// follow from.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "adapters/ports/clock.hpp"
#include "adapters/ports/register_read.hpp"
#include "core/metering/reading.hpp"
#include "daemon/gateway/ingest/correction.hpp"
#include "daemon/gateway/ingest/meter_message.hpp"
#include "daemon/gateway/poll/poll_times.hpp"

namespace recald::daemon::recording {

/// The gateway begins to poll and to close months.
struct Start {};

/// The outcome of one read of a bus.
struct Read {
  std::string meter;  ///< Its id.
  std::size_t read;   ///< Which of the meter's reads.
  modbus::ReadRequest request;
  WallTime due;
  bool is_probe;
  modbus::ReadResult result;
  std::chrono::milliseconds duration;
};

/// Readings of POST /api/v1/readings. The `meter` of each is 0.
struct Push {
  std::string meter;  ///< Or a channel of a weather sensor, "roof.dry_bulb_C".
  std::vector<metering::Reading> readings;
  std::optional<Correction> correction;
};

/// What a broker said of a meter.
struct Value {
  MeterValue value;
};

/// The gateway does what falls due.
enum class Tick : std::uint8_t {
  minute,  ///< Looks for meters that are silent.
  hour,    ///< Looks at weather sensors and closes months.
  step,    ///< Goes on with what it has put off until others had their turn.
};

/// The gateway continues with another site file.
struct Reload {};

using What = std::variant<Start, Read, Push, Value, Tick, Reload>;

struct Entry {
  Moment at;
  std::string
      clock_doubt;  ///< Why the clock is not believed, after it was looked at; empty: it is.
  What what;
};

/// Is told of everything in the order in which a gateway takes it, on the loop's thread.
class Listener {
 public:
  virtual ~Listener() = default;

  /// @param entry  Anything but a reload.
  virtual void entered(const Entry& entry) = 0;
  /// @param at  With `what` as it comes.
  virtual void reloaded(const Entry& at, const SiteConfig& site) = 0;
  /// An interval was committed that is new, or better than the stored one.
  virtual void stored(const std::string& meter, const metering::Reading& reading) = 0;
};

}  // namespace recald::daemon::recording
