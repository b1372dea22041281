/// One live meter, read once: every field of its map, how long it took, and what is odd about it.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "daemon/commands/meters/field_words.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

struct TimedRead {
  modbus::ReadResult result;
  std::chrono::milliseconds duration;
};

/// One request and its outcome; waits for it, and as long before it as the bus wants.
using AskOnce = std::function<TimedRead(const modbus::ReadRequest&)>;

struct FieldTrial {
  FieldWords found;
  std::chrono::milliseconds duration;  ///< Of the read that brought it.
  bool is_metered;                     ///< Among the energies, the power and the identity.
};

struct MeterTrial {
  std::vector<FieldTrial> fields;     ///< Those that were answered, a refusal included.
  std::vector<std::string> notes;     ///< "SunSpec model 203 at address 40070"
  std::vector<std::string> warnings;  ///< Sentences.
  std::vector<std::string> failures;  ///< Sentences; empty: the daemon can live with it.
  bool is_silent = false;             ///< The device has not answered in time.
};

/// Reads all fields of the meter's map, as few at a time as it takes to know which of them the
/// device refuses. The first read without an answer ends it: one time-out a meter.
/// @param meter  Live; outlives the result.
[[nodiscard]] MeterTrial try_meter(const MeterConfig& meter, const AskOnce& ask);

/// Counters that rose between two trials by more than the load can draw: mostly Wh taken for kWh.
/// @return sentences
[[nodiscard]] std::vector<std::string> impossible_rises(const MeterConfig& meter,
                                                        const MeterTrial& first,
                                                        const MeterTrial& second,
                                                        std::chrono::milliseconds between);

}  // namespace recald::daemon
