/// The regression's parameters as one vector, and a day's derivatives by them.
#pragma once

#include <Eigen/Core>

#include "core/change_point/regression.hpp"
#include "core/model/schedule.hpp"

namespace recald::change_point {

/// p: base loads and the parameters of all curves, in the order that `Regression` states.
[[nodiscard]] int parameters_of(const Regression& regression);

/// Derivatives of a day's expectation by each parameter.
/// @param gradient  (p) zero on entry.
void set_gradient(const Regression& regression, model::DayType type, double dry_bulb_C,
                  Eigen::Ref<Eigen::VectorXd> gradient);

/// (p) 1 for balance temperatures, 0 for the others.
[[nodiscard]] Eigen::VectorXd balance_flags(const Regression& regression);

}  // namespace recald::change_point
