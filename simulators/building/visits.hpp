/// People who come and go all day: customers, guests, patients, shifts.
///
/// One visitor after the other takes and leaves a place (a bed, a seat, room for one more
/// customer). The drawings give the share of places taken by hour. The visits are a Markov
/// chain with exactly this expectation, so the schedule in the site file matches what happens
/// in the building.
#pragma once

#include <array>
#include <cstddef>

#include "core/random/rng.hpp"

namespace recald::simulators {

/// A share, 0 to 1, for each local hour.
using HourlyShares = std::array<double, 24>;

inline constexpr std::size_t kSlotsPerDay = 288;  ///< Of five minutes.
using SlotShares = std::array<double, kSlotsPerDay>;

/// Visits to the rooms of one kind.
struct Visits {
  double stay_h;         ///< Mean length of a visit.
  HourlyShares workday;  ///< Places taken, in the middle of each hour.
  HourlyShares saturday;
  HourlyShares sunday;
  HourlyShares awake;  ///< Of those present: the share that uses lights, devices and hot water.
};

/// Straight lines between the middles of the hours; constant in the first and last half hour.
[[nodiscard]] SlotShares shares_by_slot(const HourlyShares& shares);

/// The mean of `shares_by_slot` over each hour.
[[nodiscard]] HourlyShares hourly_means(const HourlyShares& shares);

/// One day of a place, as a chain of two states in steps of five minutes. Visits end at random with
/// the given mean length, or sooner if the share falls faster than that.
class VisitDay {
 public:
  /// @param shares  Chance that the place is taken, by slot; below 1.
  /// @param before  The same in the last slot of the previous day.
  VisitDay(const SlotShares& shares, double before, double stay_h);

  /// Draws the day and calls `visit(first, end)`, in slots, for each visit or part of one.
  /// @param taken  Whether the place was taken at the end of the previous day.
  /// @return whether it is taken at the end of this day
  template <class Visit>
  bool draw(bool taken, Rng& rng, const Visit& visit) const;

 private:
  /// The slot, from `slot` on, in which a free place is taken; `kSlotsPerDay` if it stays free.
  [[nodiscard]] std::size_t next_taken(std::size_t slot, Rng& rng) const;
  /// As above, in which a taken place becomes free.
  [[nodiscard]] std::size_t next_left(std::size_t slot, Rng& rng) const;

  SlotShares taking_{};   ///< Hazard of being taken, summed over the day.
  SlotShares leaving_{};  ///< As above, of being left.
};

template <class Visit>
bool VisitDay::draw(bool taken, Rng& rng, const Visit& visit) const {
  std::size_t first = 0;
  if (!taken) first = next_taken(0, rng);
  std::size_t may_leave = taken ? 0 : first + 1;
  while (first < kSlotsPerDay) {
    const std::size_t end = next_left(may_leave, rng);
    visit(first, end);
    if (end == kSlotsPerDay) return true;
    first = next_taken(end + 1, rng);
    may_leave = first + 1;
  }
  return false;
}

}  // namespace recald::simulators
