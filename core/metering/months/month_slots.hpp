/// The intervals of one meter in one local month, as dense arrays.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/metering/months/fill_rule.hpp"
#include "core/metering/reading.hpp"

namespace recald::metering {

/// The intervals of a local month, and the place of each in its local day. Built from the zone's
/// own transitions: 92 or 100 quarter hours on most change days, 94 or 98 if the change is half an
/// hour. A slot belongs to the month that contains its start. Meters with the same grid share it.
class MonthGrid {
 public:
  /// @pre `interval` divides a day and is at least a minute; 0 <= phase < interval.
  MonthGrid(const LocalCalendar& calendar, Month month, std::chrono::seconds interval,
            std::chrono::seconds phase);

  [[nodiscard]] Month month() const { return month_; }
  [[nodiscard]] std::chrono::seconds interval() const { return interval_; }
  [[nodiscard]] std::chrono::seconds phase() const { return phase_; }
  [[nodiscard]] TimeSpan month_span() const { return month_span_; }  ///< Of the local month.
  [[nodiscard]] int slots() const { return static_cast<int>(time_of_day_.size()); }
  [[nodiscard]] int days() const { return days_in(month_); }
  [[nodiscard]] int times_of_day() const;  ///< Slots in a plain day: 96 for quarter hours.
  [[nodiscard]] double interval_h() const {
    return static_cast<double>(interval_.count()) / 3600.0;
  }

  [[nodiscard]] Instant start(int slot) const { return first_ + slot * interval_; }
  [[nodiscard]] Instant end() const { return start(slots()); }

  /// The slot that starts at `t`, or nothing if `t` is outside the month or off the grid.
  [[nodiscard]] std::optional<int> slot_at(Instant t) const {
    const auto past = t - first_;
    if (past < std::chrono::seconds{0} || past % interval_ != std::chrono::seconds{0}) return {};
    const auto slot = past / interval_;
    if (slot >= slots()) return {};
    return static_cast<int>(slot);
  }

  /// First slot of each local day, and the number of slots at the end: days + 1 entries.
  [[nodiscard]] const std::vector<int>& day_begins() const { return day_begins_; }

  /// Day 0…days−1 and time of day 0…times_of_day−1 of a slot, by the wall clock at its start.
  [[nodiscard]] int day(int slot) const { return day_[static_cast<std::size_t>(slot)]; }
  [[nodiscard]] int time_of_day(int slot) const {
    return time_of_day_[static_cast<std::size_t>(slot)];
  }

 private:
  void find_day_begins();

  Month month_;
  std::chrono::seconds interval_;
  std::chrono::seconds phase_;
  TimeSpan month_span_;
  Instant first_;
  std::vector<std::uint16_t> time_of_day_;
  std::vector<std::uint8_t> day_;
  std::vector<int> day_begins_;
};

/// One month of one meter. All arrays have `grid->slots()` entries.
struct MonthSlots {
  explicit MonthSlots(std::shared_ptr<const MonthGrid> month_grid);

  std::shared_ptr<const MonthGrid> grid;
  std::vector<double> measured_kW;  ///< As received, including suspect values; NaN: none.
  std::vector<double> used_kW;      ///< Used in the figures; if not measured, NaN until filled.
  std::vector<Validity> validity;   ///< A suspect slot stays so when its used value is estimated.
  std::vector<Reason> reasons;
  std::vector<FillMethod> method;
  std::vector<std::uint8_t> late;  ///< 1: arrived after its month had closed.

  [[nodiscard]] int slots() const { return grid->slots(); }
  [[nodiscard]] bool is_ok(int slot) const {
    return validity[static_cast<std::size_t>(slot)] == Validity::ok;
  }
  /// Whether the slot's own energy counts: measured, or with a sum known from a counter.
  [[nodiscard]] bool has_energy(int slot) const {
    const Validity v = validity[static_cast<std::size_t>(slot)];
    return v == Validity::ok || v == Validity::scaled;
  }
};

}  // namespace recald::metering
