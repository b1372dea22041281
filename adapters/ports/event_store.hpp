/// What has happened, and how far destinations have been sent of it.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald {

enum class Severity : std::uint8_t { info, warning, error };

/// Of what an event says, in bytes: what is longer is shortened when it is stored, and when it is
/// read from a store or a message of before.
inline constexpr std::size_t kEventTextMax = 4'000;
inline constexpr std::size_t kEventWordMax = 200;  ///< Of its kind, and of its subject.
/// Of events that are read at once; one longer event is read alone.
inline constexpr std::size_t kEventsBytesMax = 1'000'000;

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

  /// Calls visit for each event that first happened until `until`, the newest first, as long as it
  /// returns true: none is held longer than its visit.
  virtual Result<void> for_each_event(metering::Instant until,
                                      const std::function<bool(const StoreEvent&)>& visit) = 0;

  /// The newest first; fewer than `limit` where they exceed `kEventsBytesMax`.
  virtual Result<std::vector<StoreEvent>> events(int limit) = 0;

  /// Those with a greater number, in order of their numbers; fewer than `limit` likewise.
  virtual Result<std::vector<StoreEvent>> events_after(std::int64_t number, int limit) = 0;

  /// Meters whose silence was reported and not their answering again.
  virtual Result<std::set<std::string>> silent_meters() = 0;

  /// How far a destination outside has been told; nothing for an unknown one.
  virtual Result<std::optional<std::int64_t>> cursor(const std::string& destination) = 0;

  virtual Result<void> put_cursor(const std::string& destination, std::int64_t position) = 0;
};

}  // namespace recald
