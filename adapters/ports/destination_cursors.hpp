/// Cursors (Store::cursor) that a destination of the outbox may have beside its position and that
/// over the events. A destination that is taken out loses them.
#pragma once

#include <string>

namespace recald {

/// The number of the last finished job that the destination has had.
[[nodiscard]] inline std::string results_cursor(const std::string& destination) {
  return "results of " + destination;
}

/// The number of the last entry of the store's past that the destination has had; removed with its
/// identity, so that the past is told again.
[[nodiscard]] inline std::string history_cursor(const std::string& destination) {
  return "history of " + destination;
}

/// Which numbering the destination's positions are of: no position, but a number by chance. It is
/// removed wherever numbers of entries and events are given again: from a backup that is restored,
/// and when a damaged store is recovered.
[[nodiscard]] inline std::string identity_cursor(const std::string& destination) {
  return "identity for " + destination;
}

/// The identity under which the destination has taken something of the outbox; removed with it.
[[nodiscard]] inline std::string taken_cursor(const std::string& destination) {
  return identity_cursor(destination) + ", as it knows it";
}

}  // namespace recald
