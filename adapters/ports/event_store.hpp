/// What has happened, and how far destinations have been sent of it.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald {

enum class Severity : std::uint8_t { info, warning, error };

/// An event that people may ask about.
struct StoreEvent {
  metering::Instant time;
  Severity severity = Severity::info;
  std::string kind;     ///< "counter_reset"
  std::string subject;  ///< Id of a meter, bus or model; empty: the site.
  std::string text;     ///< A sentence.
  /// Repeated events are stored as one: an event of the same kind and subject within a day is
  /// counted, and its sentence replaces the last.
  bool is_counted = false;
  int count = 1;                          ///< Set by the store, as the next two.
  std::optional<metering::Instant> last;  ///< Time of the latest, if it happened several times.
  std::int64_t number = 0;  ///< 1, 2, 3 …; one event that is counted keeps its first.
};

class EventStore {
 public:
  virtual ~EventStore() = default;

  /// Deletes events that last happened before `keep_from`, at most `rows_max` at a time.
  /// @return how many; fewer than `rows_max` when none are left.
  virtual Result<int> delete_events(metering::Instant keep_from, int rows_max) = 0;

  /// Newest first.
  virtual Result<std::vector<StoreEvent>> events(int limit) = 0;

  /// Those with a greater number, in order of their numbers.
  virtual Result<std::vector<StoreEvent>> events_after(std::int64_t number, int limit) = 0;

  /// How far a destination outside has been told; nothing for an unknown one.
  virtual Result<std::optional<std::int64_t>> cursor(const std::string& destination) = 0;

  virtual Result<void> put_cursor(const std::string& destination, std::int64_t position) = 0;
};

}  // namespace recald
