/// How far apart the rows of a meter are, which need not be its interval.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/metering/civil_time.hpp"

namespace recald::csv {

inline constexpr std::chrono::seconds kIntervalMin{60};
inline constexpr std::chrono::seconds kIntervalMax{3600};

/// From a row on, rows are so far apart.
struct RowStep {
  std::uint64_t line;
  metering::Instant stamp;  ///< Of that row.
  std::chrono::seconds step;
  std::uint64_t left_out = 0;  ///< Rows, because the step is longer than the meter's interval.
  std::uint64_t spread = 0;    ///< Rows of days, each counted evenly over its time.
};

/// The distances between neighbouring stamps.
struct StampSteps {
  std::chrono::seconds commonest{0};  ///< The smaller of equals.
  std::chrono::seconds median{0};
  double share = 0.0;          ///< Of the steps that are the commonest.
  bool are_multiples = false;  ///< The others are multiples of it.

  /// Whether rows come at regular times, apart from gaps.
  [[nodiscard]] bool is_regular() const { return are_multiples || share >= 0.5; }
};

/// @param stamps  In any order. @return nothing for fewer than two different stamps.
[[nodiscard]] std::optional<StampSteps> steps_of(std::vector<metering::Instant> stamps);

/// Whether rows so far apart can be the intervals of a meter.
[[nodiscard]] bool is_interval(std::chrono::seconds step);

/// The shortest interval of a site file that is hardly shorter than the step; nothing if the step
/// is longer than an hour.
[[nodiscard]] std::optional<std::chrono::seconds> interval_for(std::chrono::seconds step);

/// "15 minutes", "10 seconds", "day"
[[nodiscard]] std::string in_words(std::chrono::seconds span);

/// What happened to rows that are not the meter's intervals, a sentence each; empty if all are.
[[nodiscard]] std::vector<std::string> step_sentences(std::span<const RowStep> steps,
                                                      std::chrono::seconds interval);

}  // namespace recald::csv
