/// A measure: named changes to a building, and what they cost.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/model/change_kind.hpp"

namespace recald::savings {

using model::ChangeKind;

/// How far a change will go. What will come of a measure is often not known before: then it is
/// drawn from a triangular distribution. @pre min <= mode <= max, finite
struct Achieved {
  double min;
  double mode;
  double max;

  [[nodiscard]] bool is_certain() const { return min == max; }
  /// @pre 0 < probability < 1
  [[nodiscard]] double quantile(double probability) const;
};

/// Of one quantity: by a parameter's name, or by where a dynamic simulation's file has it.
struct Change {
  std::string parameter;             ///< Of `model::parameter_library`; empty: targets are given.
  std::vector<std::string> targets;  ///< "Lights/*/watts_per_floor_area"
  ChangeKind kind;
  Achieved by;  ///< In the parameter's unit; of `scale`, a factor.
};

struct Measure {
  std::string name;
  std::optional<double> cost;  ///< Money of the site's tariff, once.
  std::vector<Change> changes;
};

}  // namespace recald::savings
