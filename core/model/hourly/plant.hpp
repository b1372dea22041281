/// From loads to metered energy: losses, efficiencies, chiller, hot water.
#pragma once

#include <Eigen/Core>

#include "core/model/building.hpp"
#include "core/model/end_use.hpp"
#include "core/model/hourly/alteration.hpp"

namespace recald::model::hourly {

/// Metered power by EndUse, W.
using EndUsePower_W = Eigen::Array<double, static_cast<int>(kEndUses), 1>;

/// Factors of one building, W metered per W of load.
class Plant {
 public:
  Plant() = default;
  explicit Plant(const Building& building);

  /// The cost factors of `loads` apply to what the plant buys: district chilled water, or
  /// electricity of its own chiller; and all metered heat except the base heat.
  [[nodiscard]] EndUsePower_W metered_W(const StepLoads& loads) const;

 private:
  double heating_ = 1.0;
  double cooling_ = 1.0;
  double hot_water_ = 1.0;
  double chiller_ = 0.0;
  double idle_W_ = 0.0;
};

/// Mean heat of the hot water drawn on this day, W, without losses.
[[nodiscard]] double hot_water_W(const HotWater& water, int day_of_year);

}  // namespace recald::model::hourly
