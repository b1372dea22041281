#include "core/model/epc/set_back.hpp"

#include <cmath>

namespace recald::model::epc {

double mean_drift_temperature_C(double start_C, double limit_C, double free_C,
                                double time_constant_h, double length_h) {
  const double tau = time_constant_h;
  const double to_free = start_C - free_C;
  const double left_at_limit = limit_C - free_C;
  // The limit can be reached exactly if it lies between the start and the free temperature.
  const bool on_the_way =
      to_free * left_at_limit > 0.0 && std::abs(left_at_limit) <= std::abs(to_free);
  const double contact_h = on_the_way ? tau * std::log(to_free / left_at_limit) : length_h;
  if (contact_h >= length_h) {
    return free_C - to_free * (tau / length_h) * std::expm1(-length_h / tau);
  }
  return (free_C * contact_h + tau * (start_C - limit_C) + limit_C * (length_h - contact_h)) /
         length_h;
}

}  // namespace recald::model::epc
