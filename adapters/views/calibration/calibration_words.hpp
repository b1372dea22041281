/// What a client is told first of a calibration: does the model use what the building uses?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/views/frame/report_data.hpp"
#include "core/assessment/output_assessment.hpp"

namespace recald::views {

/// One meter's daily means, before and after. Biases are shares, model less meter.
struct FittedMeter {
  std::string label;                    ///< "Chilled water"
  bool unseen = false;                  ///< Months that nothing was fitted to; else fitted ones.
  double before;                        ///< Bias of the uncalibrated model; NaN: not known.
  double after;                         ///< Of the calibrated one, likewise.
  double scatter;                       ///< CV(RMSE) of its months.
  std::optional<double> forecast = {};  ///< Bias of the forecast.
};

/// Months that were not fitted count where there are any. Absent: too few are measured.
[[nodiscard]] std::optional<FittedMeter> fitted_meter(std::string label,
                                                      const assessment::OutputAssessment& fit);

/// One sentence, what follows from it, and three numbers with signs. A fit that calibrating made
/// worse comes first, then what it did not mend, then what it left.
/// @param converged  False: the figures are rough, which stands before all.
[[nodiscard]] FirstScreen calibration_first_screen(const std::vector<FittedMeter>& meters,
                                                   bool converged);

/// Whether something is missing in the model, so that a diagnosis is worth its time.
[[nodiscard]] bool asks_for_diagnosis(const std::vector<FittedMeter>& meters);

}  // namespace recald::views
