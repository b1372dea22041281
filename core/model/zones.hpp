/// A building's thermal zones as the few coefficients that monthly balances need.
///
/// Air handlers with boxes heat one part of a building while they cool another: in January the core
/// needs cooling and the perimeter heat, and at night boxes at minimum flow overcool rooms that
/// then reheat. In a single zone, gains and losses that never meet would cancel. So a building with
/// an air system is split, from its description alone, into a perimeter zone behind each façade and
/// a core, without heat flow between them. A building without one is a single zone: its doors are
/// open and its radiators see the same mean.
/// @see ISO 13790:2008, 6.3 and annex B (zones without coupling); ANSI/ASHRAE/IES 90.1-2010,
///      G3.1.1.1, table G3.1 no. 8: perimeter zones 15 ft deep.
#pragma once

#include <span>
#include <vector>

#include "core/model/building.hpp"

namespace recald::model {

inline constexpr double kPerimeterDepth_m = 4.57;

struct Zone {
  double floor_share = 1.0;               ///< Of the building's floor area.
  double transmission_W_K = 0.0;          ///< H_tr to outdoor air, without the ground.
  double ground_W_K = 0.0;                ///< H_g
  double sky_loss_W = 0.0;                ///< Long-wave loss to the sky, constant.
  double leakage_cm2 = 0.0;               ///< Effective leakage area at 4 Pa.
  std::vector<double> solar_aperture_m2;  ///< By orientation of the drivers.
};

/// How leakage turns temperature difference and wind into flow.
/// @see Sherman and Grimsrud (1980); ASHRAE Handbook Fundamentals (2009), chapter 16, eq. (48),
///      coefficients of tables 4 and 6, shelter class 3.
struct LeakageFlow {
  double stack_coefficient;  ///< C_s, (L/s)²/(cm⁴ K)
  double wind_coefficient;   ///< C_w, (L/s)²/(cm⁴ (m/s)²)

  /// m³/s per cm² of effective leakage area.
  [[nodiscard]] double per_area_m3_s(double temperature_difference_K, double wind2_m2_s2) const;
};
[[nodiscard]] LeakageFlow leakage_flow(int storeys);

/// The number of zones that `describe_zones` makes for a building with drivers of
/// these orientations.
[[nodiscard]] std::size_t zone_count(const Building& building,
                                     std::span<const weather::Orientation> orientations);

/// Fills `zones`, reusing their memory: façades in order of the orientations, the core last. Roof
/// and ground are shared by floor area.
/// @pre zones.size() == zone_count and each aperture list has the size of `orientations`.
/// @see ISO 13790:2008, 8.3 (transmission), 11.3.2 to 11.4.6 (sun, sky).
void describe_zones(const Building& building, std::span<const weather::Orientation> orientations,
                    std::span<Zone> zones);

}  // namespace recald::model
