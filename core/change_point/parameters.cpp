#include "core/change_point/parameters.hpp"

#include <algorithm>

namespace recald::change_point {
namespace {

bool has_heating(const Curve& curve) {
  return curve.form == Form::heating_3p || curve.form == Form::two_slopes_4p ||
         curve.form == Form::two_slopes_5p;
}

bool has_cooling(const Curve& curve) {
  return curve.form == Form::cooling_3p || curve.form == Form::two_slopes_4p ||
         curve.form == Form::two_slopes_5p;
}

int parameters_of(const Curve& curve) {
  return curve.form == Form::two_slopes_4p
             ? 3
             : 2 * (has_heating(curve) ? 1 : 0) + 2 * (has_cooling(curve) ? 1 : 0);
}

int bases_of(const Regression& regression) {
  return 1 + *std::ranges::max_element(regression.base_number);
}

}  // namespace

int parameters_of(const Regression& regression) {
  int count = bases_of(regression);
  for (const Curve& curve : regression.curves) count += parameters_of(curve);
  return count;
}

void set_gradient(const Regression& regression, model::DayType type, double dry_bulb_C,
                  Eigen::Ref<Eigen::VectorXd> gradient) {
  const auto kind = static_cast<std::size_t>(type);
  gradient(regression.base_number[kind]) = 1.0;
  int at = bases_of(regression);
  for (std::size_t k = 0; k < regression.curve_of[kind]; ++k) {
    at += parameters_of(regression.curves[k]);
  }
  const Curve& curve = regression.curves[regression.curve_of[kind]];
  const double below = has_heating(curve) ? std::max(0.0, curve.heating_balance_C - dry_bulb_C) : 0;
  const double above = has_cooling(curve) ? std::max(0.0, dry_bulb_C - curve.cooling_balance_C) : 0;
  const double by_heating_balance = below > 0.0 ? curve.heating_slope_kWh_K : 0.0;
  const double by_cooling_balance = above > 0.0 ? -curve.cooling_slope_kWh_K : 0.0;
  if (curve.form == Form::two_slopes_4p) {
    gradient(at) = below;
    gradient(at + 1) = above;
    gradient(at + 2) = by_heating_balance + by_cooling_balance;
    return;
  }
  if (has_heating(curve)) {
    gradient(at++) = below;
    gradient(at++) = by_heating_balance;
  }
  if (has_cooling(curve)) {
    gradient(at++) = above;
    gradient(at++) = by_cooling_balance;
  }
}

Eigen::VectorXd balance_flags(const Regression& regression) {
  Eigen::VectorXd flags = Eigen::VectorXd::Zero(parameters_of(regression));
  int at = bases_of(regression);
  for (const Curve& curve : regression.curves) {
    const int count = parameters_of(curve);
    if (curve.form == Form::two_slopes_4p) {
      flags(at + 2) = 1.0;
    } else {
      for (int k = 1; k < count; k += 2) flags(at + k) = 1.0;
    }
    at += count;
  }
  return flags;
}

}  // namespace recald::change_point
