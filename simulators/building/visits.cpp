#include "simulators/building/visits.hpp"

#include <algorithm>
#include <cmath>

namespace recald::simulators {
namespace {

constexpr std::size_t kSlotsPerHour = kSlotsPerDay / 24;

double hazard_of(double chance) { return -std::log1p(-std::clamp(chance, 0.0, 1.0 - 1e-12)); }

/// First slot, from `slot` on, at which the summed hazard exceeds an exponentially
/// distributed waiting time.
std::size_t next_event(const SlotShares& hazard, std::size_t slot, Rng& rng) {
  if (slot >= kSlotsPerDay) return kSlotsPerDay;
  const double used = slot == 0 ? 0.0 : hazard[slot - 1];
  const double due = used - std::log(rng.uniform());
  const auto* const from = hazard.data() + slot;
  const auto* const end = hazard.data() + kSlotsPerDay;
  return static_cast<std::size_t>(std::lower_bound(from, end, due) - hazard.data());
}

}  // namespace

SlotShares shares_by_slot(const HourlyShares& shares) {
  SlotShares slots{};
  for (std::size_t slot = 0; slot < kSlotsPerDay; ++slot) {
    const double hour = (static_cast<double>(slot) + 0.5) / kSlotsPerHour;
    const double at = std::clamp(hour - 0.5, 0.0, 23.0);
    const auto before = std::min<std::size_t>(static_cast<std::size_t>(at), 22);
    const double share = at - static_cast<double>(before);
    slots[slot] = (1.0 - share) * shares[before] + share * shares[before + 1];
  }
  return slots;
}

HourlyShares hourly_means(const HourlyShares& shares) {
  const SlotShares slots = shares_by_slot(shares);
  HourlyShares means{};
  for (std::size_t slot = 0; slot < kSlotsPerDay; ++slot) {
    means[slot / kSlotsPerHour] += slots[slot] / kSlotsPerHour;
  }
  return means;
}

// With l the chance to leave in a slot and a the chance to be taken, p' = p (1 - l) + (1 - p) a.
VisitDay::VisitDay(const SlotShares& shares, double before, double stay_h) {
  const double usual = std::min(1.0, 1.0 / (kSlotsPerHour * stay_h));
  double taking = 0.0;
  double leaving = 0.0;
  double last = before;
  for (std::size_t slot = 0; slot < kSlotsPerDay; ++slot) {
    const double share = shares[slot];
    const double staying = last * (1.0 - usual);
    const bool empties = share < staying;
    leaving += hazard_of(empties ? 1.0 - share / last : usual);
    taking += hazard_of(empties ? 0.0 : (share - staying) / (1.0 - last));
    taking_[slot] = taking;
    leaving_[slot] = leaving;
    last = share;
  }
}

std::size_t VisitDay::next_taken(std::size_t slot, Rng& rng) const {
  return next_event(taking_, slot, rng);
}

std::size_t VisitDay::next_left(std::size_t slot, Rng& rng) const {
  return next_event(leaving_, slot, rng);
}

}  // namespace recald::simulators
