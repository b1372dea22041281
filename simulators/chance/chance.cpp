#include "simulators/chance/chance.hpp"

#include <cassert>
#include <cmath>

namespace recald::simulators {

double Triangular::quantile(double u) const {
  assert(min <= mode && mode <= max && min < max);
  const double share_left_of_mode = (mode - min) / (max - min);
  if (u < share_left_of_mode) return min + std::sqrt(u * (max - min) * (mode - min));
  return max - std::sqrt((1.0 - u) * (max - min) * (max - mode));
}

double draw_around(Rng& rng, double nominal, double spread) {
  return nominal * Triangular{1.0 - spread, 1.0, 1.0 + spread}.draw(rng);
}

Persistence::Persistence(double time_constant_s, double step_s, Rng& rng)
    : keep_(std::exp(-step_s / time_constant_s)),
      renew_(std::sqrt(1.0 - keep_ * keep_)),
      value_(rng.normal()) {}

double draw_waiting_time(Rng& rng, double mean) { return -mean * std::log(rng.uniform()); }

}  // namespace recald::simulators
