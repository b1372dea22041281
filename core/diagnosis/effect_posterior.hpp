/// The posterior of an effect's parameters, in their own units.
#pragma once

#include <string>
#include <vector>

#include "core/diagnosis/diagnose.hpp"

namespace recald::diagnosis {

/// One parameter; days count from the first day of the record.
struct ParameterPosterior {
  std::string name;
  std::string unit;
  double mode;
  double sd;
  double q05;
  double q50;
  double q95;

  [[nodiscard]] bool is_day() const { return unit == "day"; }
};

/// For an added effect, from its draws.
[[nodiscard]] std::vector<ParameterPosterior> posterior_of(const Addition& addition);

/// For a rival explanation: its scores are normal around the mode and its values their images, so
/// the quantiles are exact for that normal and no value leaves its prior.
[[nodiscard]] std::vector<ParameterPosterior> posterior_of(const Candidate& candidate,
                                                           const JointFit& fit);

/// The local day a number of days after the record's first.
[[nodiscard]] metering::Day day_after(const SiteProblem& site, double days);

}  // namespace recald::diagnosis
