/// Mean indoor temperature over hours without normal control.
#pragma once

namespace recald::model::epc {

/// A zone released at `start_C` drifts towards `free_C` with the time constant and is kept at
/// `limit_C` if it gets there. Mean over the stretch.
///
/// Works for heating (limit below start) and cooling (limit above): the limit is reached only if it
/// lies between start and free temperature. For θ_0 = 21, θ_sb = 16, θ∞ = 3, τ = 30 h, L = 12 h, it
/// is reached after 9.763 h and the mean is 17.924 °C.
/// @pre time_constant_h > 0, length_h > 0
[[nodiscard]] double mean_drift_temperature_C(double start_C, double limit_C, double free_C,
                                              double time_constant_h, double length_h);

}  // namespace recald::model::epc
