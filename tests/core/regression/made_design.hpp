/// A design of our own whose outputs are a known regression.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>

#include "core/random/rng.hpp"
#include "core/regression/design_data.hpp"

namespace recald::regression {

/// Three parameters, two meters of which one has consumption and peak, `months` months of dry bulb
/// and wind. Chilled water follows warmth, steam coldness; `noise` is relative to the outputs.
inline DesignData made_design(int runs, int months, double noise, std::uint64_t seed = 1) {
  Rng rng(seed);
  DesignData design;
  design.parameters = {"set_point", "outdoor_air", "occupancy"};
  design.theta.resize(runs, 3);
  for (int r = 0; r < runs; ++r) {
    design.theta.row(r) << rng.uniform(20.0, 28.0), rng.uniform(0.3, 1.2), rng.uniform(0.0, 0.1);
  }
  design.outputs = {"chw_daily_kwh", "chw_peak_kw", "steam_daily_kwh"};
  design.inputs = {"drybulb", "winddir"};
  design.month_inputs.resize(months, 2);
  design.values.resize(runs, 3 * months);
  for (int i = 0; i < months; ++i) {
    design.months.push_back("2016-" + std::to_string(i + 1));
    const double warm = 0.5 - 0.5 * std::cos(0.5 * i);
    design.month_inputs.row(i) << 30.0 * warm, std::fmod(137.0 * i, 360.0);
    for (int r = 0; r < runs; ++r) {
      const double set_point = (design.theta(r, 0) - 20.0) / 8.0;
      const double air = (design.theta(r, 1) - 0.3) / 0.9;
      const double people = design.theta(r, 2) / 0.1;
      const double cooling =
          0.5 + warm + 0.8 * warm * air + 0.3 * people - 0.4 * set_point + 0.2 * set_point * people;
      const double heating = 1.5 - warm + 0.7 * air - 0.6 * warm * air - 0.1 * people;
      design.values(r, i) = 4000.0 * (cooling + noise * rng.normal());
      design.values(r, months + i) = 300.0 * (1.2 * cooling + 0.2 + noise * rng.normal());
      design.values(r, 2 * months + i) = 2000.0 * (heating + noise * rng.normal());
    }
  }
  return design;
}

}  // namespace recald::regression
