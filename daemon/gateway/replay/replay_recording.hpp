/// Does again what a gateway did, from a recording of what came in.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "adapters/csv/line_reader.hpp"
#include "adapters/ports/store.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

struct ReplayedRecording {
  SiteConfig site;      ///< As it was last.
  std::string program;  ///< Version that recorded.
  std::size_t reads = 0;
  std::size_t pushes = 0;  ///< Bodies, not readings.
  std::size_t values = 0;  ///< Of brokers.
  std::optional<metering::Instant> begin;
  std::optional<metering::Instant> end;
  /// What the recording lacks, and in what this program differs from the one that recorded; a
  /// sentence each.
  std::vector<std::string> remarks;
  std::size_t intervals = 0;     ///< Committed by the recorded program.
  std::size_t different = 0;     ///< Of them those that this program has made otherwise.
  std::string first_difference;  ///< A sentence; empty: none.
};

/// Runs a gateway on the clock of the recording, without any bus.
/// @param name   Of the recording, for messages.
/// @param store  Empty; holds afterwards what the recorded gateway's store held of the time.
/// @return what was replayed, or why it cannot be: malformed or unsupported, with the line; where
///         this program does not do as the recorded one did, with the time and the meter.
[[nodiscard]] Result<ReplayedRecording> replay_recording(const csv::ByteSource& source,
                                                         const std::string& name, Store& store);

}  // namespace recald::daemon
