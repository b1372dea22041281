/// The pipeline from readings to closed months: many meters, one reading at a time,
/// constant memory.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/metering/months/close_month.hpp"

namespace recald::metering {

/// Months that must be closed even if a meter has no readings in them. Inclusive.
struct MonthRange {
  Month first;
  Month last;
};

/// Readings up to this long after a month are used to check its last slots.
inline constexpr std::chrono::hours kJudgedAfterwards{48};

/// The readings that affect these months: from the month before, which shows the meter's behaviour,
/// to two days after, which are needed to check the last slots.
[[nodiscard]] TimeSpan span_judged_by(const MonthRange& months, const LocalCalendar& calendar);

struct CloserOptions {
  ClosingOptions closing;
  /// A month closes when the meter's own readings reach this far beyond its end.
  std::chrono::seconds watermark{72 * 3600};
  int months_kept =
      2;  ///< Closed months whose readings are kept, so that late ones can reopen them.
  /// A single stamp this far ahead of the last one is held until the next reading confirms it,
  /// because one wrong year must not close the record.
  std::chrono::seconds leap_max{62 * 86'400};
  std::optional<MonthRange> period;
};

/// What happened to a meter's readings.
struct MeterCounts {
  std::int64_t accepted = 0;    ///< Entered in their slot, blanks included.
  std::int64_t duplicates = 0;  ///< Same interval, same value: the first one stays.
  std::int64_t conflicts = 0;   ///< Same interval, other value: first value kept, `suspect`.
  std::int64_t late = 0;        ///< For a closed month that was reopened.
  std::int64_t too_late = 0;    ///< For a month no longer kept: refused.
  std::int64_t off_grid = 0;    ///< The start is not an interval start of the meter: refused.
  std::int64_t stray = 0;  ///< Far ahead and not confirmed, or outside the known years: refused.
};

/// Collects readings per meter and passes on each month once it is complete, and again with a
/// higher revision when late readings change it. Readings of one meter come in event-time order,
/// apart from late ones; meters may be interleaved or one after the other. A meter's months come in
/// order, including those without readings.
class MonthCloser {
 public:
  using Sink = std::function<void(ClosedMonth&&)>;

  MonthCloser(LocalCalendar calendar, std::vector<Meter> meters, CloserOptions options, Sink sink);

  /// Sets the interval and phase found in a file. @pre no reading of that meter was added.
  void set_grid(std::uint32_t meter, std::chrono::seconds interval, std::chrono::seconds phase);

  /// @pre reading.meter is an index into the meters.
  void add(const Reading& reading);

  /// Closes months that are over by wall time, for silent meters, and passes on reopened months. A
  /// daemon calls it from time to time; a replay calls it with its virtual clock.
  void close_due(Instant now);

  /// The record ends here: closes every open month, and the rest of `period`.
  void finish();

  [[nodiscard]] const std::vector<Meter>& meters() const { return meters_; }
  [[nodiscard]] const MeterCounts& counts(std::uint32_t meter) const {
    return states_[meter].counts;
  }

 private:
  struct Record {
    MonthSlots slots;  ///< As received.
    bool closed = false;
    bool changed = false;  ///< Since it was last passed on.
    int revision = 0;
  };
  struct MeterState {
    std::deque<Record> records;  ///< Consecutive months: kept closed ones, then open ones.
    std::optional<Instant> newest_end;
    Instant next_deadline = Instant::max();  ///< When the first open month closes.
    std::optional<Reading> held;             ///< Far ahead, not yet confirmed.
    /// The place of the next interval, as long as it is an ordinary one in an open month.
    Record* next_record = nullptr;
    std::size_t next_slot = 0;
    Instant next_start{};
    std::optional<double> largest_believed_kW;
    bool handed_out = false;
    MeterCounts counts;
  };

  void place(const Reading& reading);
  void take_newest(MeterState& state, Record& record, std::size_t slot, const Reading& reading);
  void put(MeterState& state, Record& record, std::size_t slot, const Reading& reading) const;
  [[nodiscard]] bool is_lone_stray(const MeterState& state, const Reading& reading) const;
  Record* record_for(std::uint32_t meter, Instant start);
  Record* prepend_until(std::uint32_t meter, Instant start);
  void append(std::uint32_t meter, Month month);
  void set_deadline(MeterState& state) const;
  void close_until(std::uint32_t meter, Instant event_time);
  void hand_out(std::uint32_t meter, std::size_t index);
  void hand_out_reopened(std::uint32_t meter);
  static void remember_largest(MeterState& state, const MonthSlots& month);
  void forget_old(MeterState& state) const;
  std::shared_ptr<const MonthGrid> grid_for(Month month, const Meter& meter);

  LocalCalendar calendar_;
  std::vector<Meter> meters_;
  CloserOptions options_;
  Sink sink_;
  std::vector<MeterState> states_;
  std::deque<std::shared_ptr<const MonthGrid>> grids_;  ///< The few in use, shared by meters.
};

}  // namespace recald::metering
