#include "core/model/epc/utilisation.hpp"

#include <algorithm>
#include <cmath>

namespace recald::model::epc {

double need_share(double u, double a) {
  // At |u| < 1e-8 numerator and denominator are both ~u; the limit is exact to the last digit.
  if (std::abs(u) < 1e-8) return 1.0 / (a + 1.0);
  if (u < 0.0) return std::expm1(u) / std::expm1((a + 1.0) * u);
  return std::exp(-a * u) * std::expm1(-u) / std::expm1(-(a + 1.0) * u);
}

double heating_need_kWh(double transfer_kWh, double gains_kWh, double a) {
  if (transfer_kWh > 0.0 && gains_kWh > 0.0) {
    return transfer_kWh * need_share(std::log(gains_kWh / transfer_kWh), a);
  }
  if (transfer_kWh > 0.0) return transfer_kWh - gains_kWh;
  if (gains_kWh >= 0.0) return 0.0;
  // Roles are swapped: −gains are the losses, −transfer the gains.
  if (transfer_kWh == 0.0) return -gains_kWh;
  return -gains_kWh * need_share(std::log(transfer_kWh / gains_kWh), a);
}

double cooling_need_kWh(double transfer_kWh, double gains_kWh, double a) {
  // Cooling mirrors heating: the losses are its gains.
  return heating_need_kWh(gains_kWh, transfer_kWh, a);
}

double utilisation_exponent(double time_constant_h) {
  return std::min(1.0 + time_constant_h / 15.0, 1e6);
}

}  // namespace recald::model::epc
