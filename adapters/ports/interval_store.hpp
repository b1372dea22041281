/// Readings, the counters that explain them, and what people changed in them.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "adapters/ports/event_store.hpp"
#include "adapters/ports/month_store.hpp"
#include "core/metering/reading.hpp"
#include "core/metering/registers/interval_book.hpp"
#include "core/metering/registers/power_book.hpp"
#include "core/result.hpp"

namespace recald {

/// A reading as stored, with the number of corrections.
struct StoredInterval {
  metering::Reading reading;
  int revision = 0;
};

/// One register of one meter between two samples: everything that must survive a restart.
struct RegisterState {
  std::string field;  ///< Name in the register map.
  metering::CounterState counter;
  metering::IntervalBook book;
  metering::PowerBook power;           ///< Replaces both for a meter without a counter.
  metering::CounterSettings settings;  ///< The settings under which the state was reached.
  std::string identity;                ///< Serial number as read; empty: the map has none.
};

/// A register as read, before any processing.
struct RawSample {
  std::uint32_t meter;
  std::string field;
  metering::Instant time;
  double value;  ///< In the field's unit; NaN: the register's "no value".
};

/// In bytes, of an edit; what is longer is refused where it comes in.
inline constexpr std::size_t kReasonMax = 2'000;
inline constexpr std::size_t kAuthorMax = 200;

/// Readings that a person entered.
struct StoreEdit {
  metering::Instant time;
  std::string author;
  std::string reason;  ///< Not empty.
  std::string file;    ///< File name without the folder.
  std::string sha256;  ///< Of the file's bytes.
};

/// The content of one commit: intervals together with the states that explain them.
struct StoreBatch {
  struct Interval {
    metering::Reading reading;
    bool supersedes = false;
  };
  struct Register {
    std::uint32_t meter;
    RegisterState state;
  };
  std::vector<Interval> intervals;
  std::vector<Register> registers;
  std::vector<RawSample> samples;
  std::vector<StoreEvent> events;
  std::vector<MeterMonth> reopened;  ///< Closed months that the intervals change.
  std::optional<std::int64_t> edit;  ///< The edit by hand that the intervals belong to.

  [[nodiscard]] bool empty() const {
    return intervals.empty() && registers.empty() && samples.empty() && events.empty() &&
           reopened.empty();
  }
};

/// What a commit did with its intervals.
struct CommitCounts {
  int taken = 0;                             ///< New intervals, or better than the stored ones.
  int duplicates = 0;                        ///< Equal to the stored ones.
  int weaker = 0;                            ///< Worse than the stored ones.
  std::vector<metering::Reading> conflicts;  ///< Equally good, but another value; the first stays.
  std::vector<bool> was_taken;               ///< One per interval of the batch.
  std::string doubt = {};  ///< Why readings that were sent are not believed, in words; else empty.
};

class IntervalStore {
 public:
  virtual ~IntervalStore() = default;

  /// The number of a meter in this store; an unknown id gets a new one.
  /// @return the number, or unsupported when the meter is stored with another interval.
  virtual Result<std::uint32_t> meter_number(const std::string& id,
                                             std::chrono::seconds interval) = 0;

  /// The number of a meter that is already stored; also works on a store opened to read.
  virtual Result<std::optional<std::uint32_t>> find_meter(const std::string& id) = 0;

  /// Commits all or nothing. Intervals are placed by `metering::place`; meters are store numbers.
  virtual Result<CommitCounts> commit(const StoreBatch& batch) = 0;

  /// The latest revision of each interval that starts in the span, in order of time.
  virtual Result<void> for_each_interval(
      std::uint32_t meter, const metering::TimeSpan& span,
      const std::function<void(const StoredInterval&)>& visit) = 0;

  /// First start and last start, if there is any.
  virtual Result<std::optional<metering::TimeSpan>> interval_extent(std::uint32_t meter) = 0;

  /// Whether any meter has a good interval that starts in the span.
  virtual Result<bool> was_read_in(const metering::TimeSpan& span) = 0;

  virtual Result<std::vector<RegisterState>> registers(std::uint32_t meter) = 0;

  /// The kept samples of one field, in order of time.
  virtual Result<void> for_each_sample(
      std::uint32_t meter, const std::string& field,
      const std::function<void(const metering::RegisterSample&)>& visit) = 0;

  /// Deletes samples from before `keep_from`, at most `rows_max` at a time.
  /// @return how many; fewer than `rows_max` when none are left.
  virtual Result<int> delete_samples(metering::Instant keep_from, int rows_max) = 0;

  /// Adds an edit, to which intervals then refer. @return its number, or invalid_value
  /// without a reason.
  virtual Result<std::int64_t> add_edit(const StoreEdit& edit) = 0;

  /// Deletes an edit that no interval refers to.
  virtual Result<void> remove_edit(std::int64_t number) = 0;

  /// UTC days, given as their midnights, with intervals from an edit, in any revision.
  virtual Result<std::set<metering::Instant>> edited_days(std::uint32_t meter) = 0;
};

}  // namespace recald
