/// What following the months says of effects that begin on a day: whether it sees them, when, and
/// whether it blames the right side.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "tests/blind/scoring/intervals.hpp"
#include "tests/blind/scoring/scored_case.hpp"

namespace recald::blind {

/// The method whose lines tell of the months followed instead of a diagnosis.
inline constexpr std::string_view kDrift = "drift";

/// By case; those that could not be followed are absent.
using Drifts = std::map<std::string, Drift>;

[[nodiscard]] Drifts drifts_of(std::span<const CaseResult> results);

/// Whether a cause is what a hidden effect would be called, at best: the meter that it falsifies;
/// the effect, or one of its kind (another use of electricity, another that changes the same
/// parameter); the parameter; a use of electricity; else something that the model lacks.
[[nodiscard]] bool is_right_cause(const HiddenEffect& hidden, const DriftCause& cause);
/// Whether it blames the meters or the building rightly; nothing blamed is never right.
[[nodiscard]] bool is_right_side(const HiddenEffect& hidden, const DriftCause& cause);

/// Dated: a single effect that begins in a month that was watched. Causes are those of the first
/// alarm from that month on. All absent without such lines.
struct DriftScores {
  std::optional<Score> found;         ///< Of the dated.
  std::optional<Score> found_large;   ///< Of those that move 3 % and more of a meter.
  std::optional<Score> delay_months;  ///< Median, of those found.
  std::optional<Score> early;         ///< Of the dated: alarmed before anything changed.
  std::optional<Score> cause_right;   ///< Of those found.
  std::optional<Score> side_right;    ///< Of those found.
  std::optional<Score> sure_right;    ///< Of causes said with P of 0.8 or more.
  std::optional<Score> false_alarms;  ///< Of cases that hide nothing.
};

[[nodiscard]] DriftScores drift_scores(const ScoredCases& cases, const Drifts& drifts);

}  // namespace recald::blind
