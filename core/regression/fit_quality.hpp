/// How good a meta-model is, on the runs it was fitted to and on runs it has not seen.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/regression/design_data.hpp"

namespace recald::regression {

/// Of one output, or of all outputs of one meter taken together on the normalised scale.
struct FitQuality {
  double r2_in_sample = 0.0;  ///< 1 - residual / total squares about the mean of all runs, months.
  double r2_left_out = 0.0;   ///< The same, each run predicted without it.
  /// Left out, about each month's own mean: most of an output's spread is the weather's, which the
  /// meta-model knows; this is what it knows of the parameters.
  double r2_left_out_within_months = 0.0;
};

struct OutputQuality {
  std::string name;
  FitQuality fit;
  double
      sigma_r;  ///< Meta-model error of eq. (1): root mean square left-out residual, output unit.
  Eigen::VectorXd sigma_by_month;  ///< (m) The same of each month's runs.
};

struct MeterQuality {
  std::string meter;  ///< Empty where outputs carry no meter's name.
  FitQuality fit;
};

struct DesignQuality {
  std::vector<OutputQuality> outputs;
  std::vector<MeterQuality> meters;
  /// All outputs on their normalised scales: the figure by which forms are compared.
  FitQuality all;
};

/// Outputs of one meter: `<meter>_daily_<unit>` and `<meter>_peak_<unit>`, or one of the two.
struct MeterOutputs {
  std::string meter;
  int consumption = -1;  ///< Index of the output; -1: the meter has none.
  int peak = -1;

  /// The outputs that exist, consumption first: in this order `out` is 0, 1.
  [[nodiscard]] std::vector<int> existing() const;
};

/// Groups outputs by their names, in the order of first appearance. A name with neither `daily` nor
/// `peak` in it is a meter of its own with a consumption only.
[[nodiscard]] std::vector<MeterOutputs> group_by_meter(const std::vector<std::string>& outputs);

/// @param scales  (k) of the outputs.
/// @param fitted, left_out  (runs x k * m) predictions on the normalised scale.
[[nodiscard]] DesignQuality assess_fit(const DesignData& design,
                                       const std::vector<ColumnScale>& scales,
                                       const Eigen::MatrixXd& fitted,
                                       const Eigen::MatrixXd& left_out);

/// How well an output of other runs is predicted.
struct CheckedOutput {
  std::string name;
  double cvrmse;  ///< Root mean square error over runs and months, over their mean.
  double
      r2_median_month;  ///< R2 over the runs of each month by itself: what is known of parameters.
  double r2_worst_month;
  std::string worst_month;
  double error_of_worst;  ///< That month's root mean square error over its mean.
};

/// @param check      Runs that the meta-model has not seen.
/// @param predicted  (runs x k * m) in the outputs' units.
[[nodiscard]] std::vector<CheckedOutput> check_predictions(const DesignData& check,
                                                           const Eigen::MatrixXd& predicted);

/// (runs x k * m) the design's outputs, each by its scale.
[[nodiscard]] Eigen::MatrixXd normalise_outputs(const DesignData& design,
                                                const std::vector<ColumnScale>& scales);

}  // namespace recald::regression
