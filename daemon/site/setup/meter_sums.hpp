/// Which meters are the sums of others.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "core/metering/civil_time.hpp"

namespace recald::daemon {

/// A meter's readings at some of its stamps, chosen alike for all meters, so that memory is bounded
/// and different meters meet at the same stamps.
class SampledReadings {
 public:
  void take(metering::Instant start, double mean_kW);

  /// Kept so far, by time; only those that the coarsest of all meters has can be compared.
  [[nodiscard]] const std::map<metering::Instant, double>& kept() const { return kept_; }

 private:
  std::uint64_t every_ = 1;  ///< A power of two: so many stamps for one that is kept.
  std::map<metering::Instant, double> kept_;
};

struct FoundSum {
  std::size_t sum;
  std::vector<std::size_t> parts;  ///< Two or more.
};

/// Meters that equal the sum of two or more smaller ones at every common stamp, but for rounding.
/// Parts are no sums themselves.
/// @note O(m^4) in the number of meters; up to forty are looked at.
[[nodiscard]] std::vector<FoundSum> find_sums(std::span<const SampledReadings* const> meters);

}  // namespace recald::daemon
