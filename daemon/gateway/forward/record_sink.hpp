/// The record of a fleet as a destination.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include "daemon/gateway/forward/outbox/sink.hpp"
#include "daemon/gateway/forward/record_link.hpp"

namespace recald::daemon {

struct RecordRules {
  std::chrono::milliseconds publish_max{30'000};
  std::chrono::milliseconds confirm_max{60'000};  ///< From the broker's word to the record's.
  std::size_t payload_bytes = 128 * 1024;         ///< Of a message with more than one thing in it.
  /// Of a message with one result: beyond this its document is left out, because what is longer
  /// than 1 MiB does not arrive (adapters/mqtt).
  std::size_t result_bytes = 1'000'000;
};

/// Takes a batch only when the record has said that it is committed: what the broker has
/// acknowledged does not count. Nothing is ever refused for good.
/// @param site    Its id.
/// @param link    Null while there is none: everything waits.
[[nodiscard]] std::unique_ptr<Sink> make_record_sink(std::string site,
                                                     std::shared_ptr<RecordLink> link,
                                                     const RecordRules& rules = {});

}  // namespace recald::daemon
