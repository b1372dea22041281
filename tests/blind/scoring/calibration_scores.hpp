/// What calibrating does to a model where nothing is hidden: there is nothing to find, and it must
/// do no harm.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>

#include "tests/blind/scoring/intervals.hpp"
#include "tests/blind/scoring/scored_case.hpp"

namespace recald::blind {

/// The method whose lines tell of a calibration instead of a diagnosis.
inline constexpr std::string_view kCalibrate = "calibrate";

/// Whether a method answers for itself: the oracle, a calibration and what follows drift do not.
[[nodiscard]] bool competes(std::string_view method);

/// By case.
using Calibrations = std::map<std::string, std::map<std::string, CalibrationFit>>;

[[nodiscard]] Calibrations calibrations_of(std::span<const CaseResult> results);

/// CV(RMSE) over unseen months of mean daily energy, shares of one; medians over the meters of all
/// cases with nothing hidden. Intervals take meters as independent, so they are a little too narrow
/// where a building has several. Absent without such lines.
struct CalibrationScores {
  std::optional<Score> before;     ///< The model by its drawings.
  std::optional<Score> after;      ///< The calibrated model alone.
  std::optional<Score> forecast;   ///< What recald forecasts with it.
  std::optional<Score> yardstick;  ///< A regression of the meter on temperature.
  std::optional<Score> harmed;     ///< Meters whose model calibrating made worse.
  std::optional<Score> beaten;     ///< Meters that the yardstick forecasts better.
};

[[nodiscard]] CalibrationScores calibration_scores(const ScoredCases& cases,
                                                   const Calibrations& calibrations);

}  // namespace recald::blind
