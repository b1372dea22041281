/// Monthly heating and cooling need of one zone from gains and heat transfer.
#pragma once

namespace recald::model::epc {

struct MonthlyNeed {
  double heating_kWh;  ///< Q_H >= 0
  double cooling_kWh;  ///< Q_C >= 0
};

/// The share of the losses that must be heated: N(u) = Q_H / Q_ht with u = ln(gains / losses). The
/// share of the gains that must be cooled is N(−u) = Q_C / Q_gn.
///
/// Equal to 1 − η γ with η = (1 − γ^a)/(1 − γ^(a+1)), written with expm1 so that no digits are lost
/// for γ near 1 and large a does not overflow.
/// @see ISO 13790:2008, 12.2.1.1, eqs. (52) to (57).
[[nodiscard]] double need_share(double log_gain_ratio, double a);

/// Heating need for heat transfer Q_ht (positive: heat leaves the zone) at the heating set-point.
/// Covers all four combinations of signs: without losses there is no need; gains below zero (sky)
/// add to the need.
[[nodiscard]] double heating_need_kWh(double transfer_kWh, double gains_kWh, double a);

/// Cooling need; the transfer is at the *cooling* set-point.
[[nodiscard]] double cooling_need_kWh(double transfer_kWh, double gains_kWh, double a);

/// a = a_0 + τ/τ_0 with the monthly constants a_0 = 1, τ_0 = 15 h, capped where N has converged.
/// @see ISO 13790:2008, 12.2.1.2, table 9.
[[nodiscard]] double utilisation_exponent(double time_constant_h);

}  // namespace recald::model::epc
