/// A design of experiments with what the simulator made of it: what screening and meta-models read.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace recald::regression {

/// A parameter whose value counts only as far as another leaves it: a simulation does not heat to
/// above where it cools.
struct ParameterCap {
  int parameter;
  int under;   ///< The other, which no cap is on.
  double gap;  ///< It counts up to the other's value less this.
};

/// The values that count. @param theta  (rows x q)
[[nodiscard]] Eigen::MatrixXd capped(Eigen::MatrixXd theta, std::span<const ParameterCap> caps);

/// Runs of one building model at different parameter values, all for the same months.
struct DesignData {
  std::vector<std::string> parameters;  ///< (q) names.
  Eigen::MatrixXd theta;                ///< (runs x q) in the parameters' own units.
  std::vector<std::string> outputs;     ///< (k) names, e.g. chw_daily_kwh.
  std::vector<std::string> months;      ///< (m) names, e.g. 2016-03.
  Eigen::MatrixXd values;               ///< (runs x k * m), output-major, in the outputs' units.
  std::vector<std::string> inputs;      ///< (p) known month inputs, e.g. drybulb; may be empty.
  Eigen::MatrixXd month_inputs;         ///< (m x p) in the inputs' own units.
  std::vector<ParameterCap> caps = {};

  [[nodiscard]] Eigen::Index runs() const { return theta.rows(); }
  [[nodiscard]] Eigen::Index month_count() const {
    return static_cast<Eigen::Index>(months.size());
  }
  /// (runs x m) one output.
  [[nodiscard]] auto output(Eigen::Index k) const {
    return values.middleCols(k * month_count(), month_count());
  }
};

/// Smallest and largest value of a column, which the regressions map to 0 and 1.
struct ColumnScale {
  double min;
  double max;

  [[nodiscard]] double range() const { return max - min; }
  [[nodiscard]] double scale(double value) const { return (value - min) / range(); }
  bool operator==(const ColumnScale&) const = default;
};

/// Checks what a file of runs can get wrong, before anything is computed.
///
/// @return not_enough_data  fewer runs than parameters + 2, no parameter, output or month;
///         not_finite       a missing or infinite value: says which run, month and column;
///         invalid_value    a parameter or month input that never changes, an output that never
///                          changes over runs and months, a parameter that others determine, a
///                          name that comes twice.
/// @pre shapes agree
[[nodiscard]] Result<void> check_design(const DesignData& design);

/// Each column's own min and max.
[[nodiscard]] std::vector<ColumnScale> column_scales(const Eigen::MatrixXd& columns);

/// (rows x columns) on [0, 1] where the scales come from the same rows.
[[nodiscard]] Eigen::MatrixXd scale_columns(const Eigen::MatrixXd& columns,
                                            const std::vector<ColumnScale>& scales);

/// (k) min and max of each output over all runs and months.
[[nodiscard]] std::vector<ColumnScale> output_scales(const DesignData& design);

}  // namespace recald::regression
