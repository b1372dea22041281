/// The other meta-model: what the parameters make of the design's months, and of no others.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/regression/design_data.hpp"
#include "core/regression/fit_quality.hpp"
#include "core/regression/gaussian_process.hpp"
#include "core/result.hpp"

namespace recald::regression {

inline constexpr Eigen::Index kRunsUsedMax = 1000;

/// A pattern of an output's months that the runs have more or less of.
struct MonthPattern {
  Eigen::VectorXd loadings;  ///< (months) on the output's normalised scale, of one sd of the runs.
  GaussianProcess amount;    ///< How much of it, in sd.
};

struct MonthlyFormOutput {
  Eigen::VectorXd means;               ///< (months) of the runs, on the normalised scale.
  std::vector<MonthPattern> patterns;  ///< The one with the largest spread first.
};

struct MonthlyForm {
  std::vector<std::string> parameters;
  std::vector<ParameterCap> caps;             ///< As the design's.
  std::vector<ColumnScale> parameter_scales;  ///< Of the design's runs, capped.
  Eigen::MatrixXd points;                     ///< (runs used x q) by those scales.
  std::vector<std::string> months;            ///< The only ones it can speak of.
  std::vector<std::string> outputs;
  std::vector<ColumnScale> output_scales;
  std::vector<MonthlyFormOutput> fits;  ///< (outputs)
  DesignQuality quality;
};

/// The months of an output are sums of few patterns, the principal components of the runs' months
/// about their means; how much there is of each is a Gaussian process of the parameters.
///
/// Heating and cooling stop where nothing is needed, which no polynomial does. Patterns that
/// left-out runs are predicted no better with are left out.
///
/// Left-out figures are of runs left out one at a time, patterns and kernels being those of all
/// runs, so with few runs of many parameters they are a little better than unseen runs are
/// predicted.
///
/// @return the processes, or what `check_design` finds.
/// @note   Of more than `kRunsUsedMax` runs so many are used, taken at random; it costs a cube of
///         their number a pattern.
[[nodiscard]] Result<MonthlyForm> fit_monthly_form(const DesignData& design);

}  // namespace recald::regression
