/// Runs of a design that stand far from all others: a simulation that failed and did not say so.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/regression/design_data.hpp"

namespace recald::regression {

struct OutlierOptions {
  /// Beyond the quartile, in quartile ranges of the month's runs; normal values are within 5.
  double fence = 5.0;
  /// From the nearest run within the fence: the end of a long tail has neighbours.
  double gap = 2.0;
  /// A month's quartile range counts no less than this share of the output's widest: in a summer
  /// month without heating any heating at all would stand out.
  double widest_share = 0.25;
  Eigen::Index runs_min = 12;  ///< Fewer have no quartiles worth the name.
};

/// A run that stands out, and where it does most.
struct OutlyingRun {
  Eigen::Index run;  ///< Row of the design.
  Eigen::Index output;
  Eigen::Index month;
  double value;   ///< In the output's unit.
  double median;  ///< Of all runs, there.
  double reach;   ///< Beyond the quartile, in quartile ranges.
};

/// The runs with an output that lies beyond the fence and away from all runs within it, in order of
/// rows. Values that are not finite are left to `check_design`.
/// @note  O(values log runs).
[[nodiscard]] std::vector<OutlyingRun> outlying_runs(const DesignData& design,
                                                     const OutlierOptions& options = {});

}  // namespace recald::regression
