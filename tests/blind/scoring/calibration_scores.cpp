#include "tests/blind/scoring/calibration_scores.hpp"

#include <vector>

#include "tests/blind/scoring/drift_scores.hpp"
#include "tests/blind/scoring/gap_scores.hpp"

namespace recald::blind {

bool competes(std::string_view method) {
  return method != kOracle && method != kCalibrate && method != kDrift;
}

Calibrations calibrations_of(std::span<const CaseResult> results) {
  Calibrations calibrations;
  for (const CaseResult& result : results) {
    if (result.method == kCalibrate) calibrations[result.case_id] = result.calibration;
  }
  return calibrations;
}

CalibrationScores calibration_scores(const ScoredCases& cases, const Calibrations& calibrations) {
  std::vector<double> before, after, forecast, yardstick;
  int harmed = 0;
  int beaten = 0;
  for (const ScoredCase& scored : cases) {
    const auto found = calibrations.find(scored.answer->case_id);
    if (!scored.answer->effects.empty() || found == calibrations.end()) continue;
    for (const auto& [meter, fit] : found->second) {
      before.push_back(fit.before);
      after.push_back(fit.after);
      forecast.push_back(fit.forecast);
      yardstick.push_back(fit.yardstick);
      if (fit.after > fit.before) ++harmed;
      if (fit.yardstick < fit.forecast) ++beaten;
    }
  }
  const int meters = static_cast<int>(before.size());
  return {.before = median_score(std::move(before)),
          .after = median_score(std::move(after)),
          .forecast = median_score(std::move(forecast)),
          .yardstick = median_score(std::move(yardstick)),
          .harmed = share_score(harmed, meters),
          .beaten = share_score(beaten, meters)};
}

}  // namespace recald::blind
