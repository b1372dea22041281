/// Converts between units and the [0, 1] scale of the discrepancy and error priors.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "core/calibration/posterior/findings.hpp"
#include "core/result.hpp"

namespace recald::calibration {

/// Smallest and largest value of one output over all design runs and months, in its unit.
struct OutputScale {
  double min;
  double max;

  [[nodiscard]] double range() const { return max - min; }
  [[nodiscard]] double normalise(double value) const { return (value - min) / range(); }
  [[nodiscard]] double normalise_variance(double variance) const {
    return variance / (range() * range());
  }
  bool operator==(const OutputScale&) const = default;
};

/// The constants belong to a design and are stored with it: new data never change them.
struct Normalisation {
  std::vector<OutputScale> scales;  ///< (outputs) {0, 1} for an output that is not measured.
  double
      pooled_variance;  ///< v_y: variance of all normalised values over outputs, months and runs.
};

/// One output of a monthly model and its measurements.
struct OutputMeasurements {
  std::string name;            ///< "steam_daily_kWh"
  std::string unit;            ///< "kWh/day"
  std::vector<double> values;  ///< (months) NaN: no usable measurement.
  std::vector<double>
      extra_variances;  ///< (months) unit squared, known (gap filling); empty: none.
  double weight = 1.0;  ///< Relative trust in (0, 1]; 1 for the best output.

  [[nodiscard]] int measured_months() const;
};

/// @param design_outputs  (runs x outputs * months), rows output-major.
/// @param outputs         Outputs without any measured month are skipped: their scale is {0, 1}.
/// @return the constants, or invalid_value when a measured output is the same in
///         every run and month.
[[nodiscard]] Result<Normalisation> normalise_design(const Eigen::MatrixXd& design_outputs,
                                                     std::span<const OutputMeasurements> outputs,
                                                     int months);

/// A measured value outside the design runs.
struct OutOfRange {
  int output;
  int month;
  double value;  ///< In the output's unit, as are the two below.
  double low;
  double high;
};

struct RangeCheck {
  std::vector<OutOfRange> extrapolation;  ///< Outside all runs of all months.
  std::vector<OutOfRange> by_month;  ///< Outside the runs of its own month: the stronger check,
                                     ///< since July's spread would hide a failure in January.
};

[[nodiscard]] RangeCheck check_range(const Eigen::MatrixXd& design_outputs,
                                     std::span<const OutputMeasurements> outputs,
                                     const Normalisation& normalisation);

/// The check in words, one finding per output and kind.
[[nodiscard]] Findings range_findings(const RangeCheck& check,
                                      std::span<const OutputMeasurements> outputs,
                                      std::span<const std::string> month_names);

}  // namespace recald::calibration
