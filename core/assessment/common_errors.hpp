/// How a model's outputs move together with what no calibration parameter stands for.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/assessment/assessed_calibration.hpp"
#include "core/assessment/model_errors.hpp"
#include "core/model/building.hpp"
#include "core/model/drivers.hpp"
#include "core/model/monthly_model.hpp"

namespace recald::assessment {

/// Errors of one standard deviation, each (outputs * months) in units: the share of lights and
/// plugs that heats the zone, then one a meter that has peaks.
/// @param outputs  In the order of the model's.
/// @param make     Makes the model of the months of `model`.
/// @param theta    Where the model is asked.
[[nodiscard]] std::vector<Eigen::VectorXd> common_errors(
    const model::Building& building, const ModelFactory& make,
    const std::vector<OutputCalibration>& outputs, MonthlyModel& model,
    std::span<const double> theta);

/// What `common_errors` of the same outputs are of, in its order.
[[nodiscard]] std::vector<CommonError> kinds_of_common_errors(
    const std::vector<OutputCalibration>& outputs);

/// f(mean + sd) - f(mean) of each parameter that is held, the others at their means: its exact
/// marginalisation where f is linear in it.
/// @param free  Ascending indices of the parameters that are not held.
[[nodiscard]] std::vector<Eigen::VectorXd> held_parameter_errors(
    MonthlyModel& model, const std::vector<Parameter>& parameters, const std::vector<int>& free);

/// Lights and plugs that take a tenth more, for how everything else follows them.
[[nodiscard]] model::ElectricLoads more_use(model::ElectricLoads loads);

/// What all months gain when lights and plugs double, heat in the rooms included: (outputs *
/// months) in units, output-major, straightened out from a tenth more.
/// @param with_more  The same model on `more_use` of its loads.
[[nodiscard]] std::vector<double> gain_by_use(MonthlyModel& model, MonthlyModel& with_more,
                                              std::span<const double> theta);

}  // namespace recald::assessment
