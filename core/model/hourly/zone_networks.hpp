/// A building's zones as networks of five resistances and one capacity, solved two at a time.
///
/// With the mean of the mass temperature over the step as unknown, Crank-Nicolson turns the
/// capacity into a conductance 2 C / Δt to the mass temperature before the step. The mass and
/// surface nodes are then eliminated with coefficients that are the same in every step. Only the
/// air node, where ventilation, boxes and controls act, remains to be solved:
///
///     (Y + H_ve) θ_air = J + H_ve θ_e + Φ_HC,   θ_m⁺ = linear in θ_m⁻, θ_e, θ_g, gains, θ_air
///
/// This equals annex C of the standard up to rounding, without its probe for the demand. A heat
/// capacity of air and furniture, which the standard lacks, is a conductance C / Δt to the air
/// before the step.
/// @see ISO 13790:2008, annex C, eqs. (C.1) to (C.11), and 12.2.2
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/model/building.hpp"
#include "core/model/zones.hpp"

namespace recald::model::hourly {

using ZonePair = Eigen::Array2d;  ///< One value of two zones side by side.

/// The five conductances of one zone, and its shares of gains.
struct ZoneConductances {
  double air_to_surface_W_K;      ///< H_tr,is
  double surface_to_mass_W_K;     ///< H_tr,ms
  double surface_to_outdoor_W_K;  ///< H_tr,w, windows
  double mass_to_outdoor_W_K;     ///< H_tr,em without the ground
  double mass_to_ground_W_K;
  double mass_share;     ///< A_m / A_t, of gains that do not go to the air
  double surface_share;  ///< 1 - A_m / A_t - H_tr,w / (9.1 W/m²K A_t)
  double capacity_J_K;   ///< C_m
};

/// @param zone         All its surfaces.
/// @param window_W_K   Part of its transmission through windows.
/// A zone with more envelope than its floor's inner surfaces can carry gets the surfaces it needs,
/// so that all conductances are positive.
[[nodiscard]] ZoneConductances zone_conductances(const Building& building, const Zone& zone,
                                                 double window_W_K);

/// Surroundings of all rooms in a step.
struct ZoneSurroundings {
  double dry_bulb_C;
  double ground_C;
  double internal_W;  ///< Into all zones, by floor area.
  double solar_share;
  std::span<const double> irradiance_W_m2;  ///< By orientation; empty at night.
};

/// How rooms are served in a step; flows as W/K, for the whole building if all its rooms
/// were like these.
struct ZoneService {
  double leakage_W_K_cm2;  ///< Infiltration per effective leakage area.
  double outdoor_W_K;      ///< Outdoor air directly into the zones, by floor area.
  double heating_C;
  double cooling_C;  ///< >= heating_C
  double supply_C;
  double least_W_K;        ///< Boxes at minimum.
  double most_W_K;         ///< At design flow.
  double scheduled_share;  ///< Of the handlers; the others run on call, only to cool.
  double fan_W = 0.0;      ///< Heat of fans in the rooms, to their air; without boxes.
};

/// Sums over all zones.
struct ZoneTotals {
  double zone_heating_W = 0.0;
  double reheat_W = 0.0;
  double cooling_W = 0.0;           ///< Without boxes.
  double scheduled_W_K = 0.0;       ///< Supply flow of handlers that run by schedule.
  double scheduled_return_W = 0.0;  ///< Σ flow θ_air, J/K per second times °C.
  double on_call_W_K = 0.0;         ///< Supply flow of handlers called to cool.
  double on_call_return_W = 0.0;
  double mean_air_C = 0.0;  ///< By floor area.

  /// Adds `share` of another part of the building.
  void add(double share, const ZoneTotals& part);
};

inline void ZoneTotals::add(double share, const ZoneTotals& part) {
  zone_heating_W += share * part.zone_heating_W;
  reheat_W += share * part.reheat_W;
  cooling_W += share * part.cooling_W;
  scheduled_W_K += share * part.scheduled_W_K;
  scheduled_return_W += share * part.scheduled_return_W;
  on_call_W_K += share * part.on_call_W_K;
  on_call_return_W += share * part.on_call_return_W;
  mean_air_C += share * part.mean_air_C;
}

/// Holds the mass temperatures of up to two parts of the building, each with all zones.
class ZoneNetworks {
 public:
  /// Rebuilds all coefficients; memory is reused.
  void describe(const Building& building, std::span<const weather::Orientation> orientations,
                double step_s, int parts);

  /// Sets all masses, and the air, to one temperature.
  void reset(double mass_C);

  /// Sets the heat from the surroundings to all parts in this step; call it before `serve`.
  void expose(const ZoneSurroundings& surroundings);

  /// One step of a part whose rooms have boxes. Cooling follows the flow between its limits. Air at
  /// minimum flow may cool below the cooling set-point. At the heating set-point the part is kept
  /// there: the shortage that the zone would have without boxes is zone heating, the rest reheat.
  ZoneTotals serve_with_boxes(int part, const ZoneService& service);

  /// One step of a part whose set-points are maintained by heating and cooling in the zone.
  ZoneTotals serve(int part, const ZoneService& service);

  /// °C, of a part and zone.
  [[nodiscard]] double mass_C(int part, std::size_t zone) const;
  [[nodiscard]] std::size_t zones() const { return zones_.size(); }

 private:
  /// Coefficients of two zones. Symbols: see the derivation in the source file.
  struct Pair {
    ZonePair counts;  ///< 1, or 0 for the empty place beside an odd last zone.
    ZonePair floor_share;
    ZonePair gain_share;  ///< Of internal gains.
    ZonePair leakage_cm2;
    ZonePair sky_loss_W;
    ZonePair air_W_K;  ///< Y
    ZonePair air_from_mass, air_from_outdoor, air_from_ground, air_from_solar, air_from_internal;
    ZonePair mass_from_mass, mass_from_outdoor, mass_from_ground, mass_from_solar,
        mass_from_internal, mass_from_air;
  };
  /// A zone's share of the building's internal gains. @param first_core  Index; façades come first.
  [[nodiscard]] double gain_share(const Building& building, std::size_t zone,
                                  std::size_t first_core) const;
  static void set_coefficients(const ZoneConductances& c, double step_s, int place, Pair& pair);

  std::vector<Zone> zones_;
  std::vector<Zone> glazing_;  ///< The same zones with only their windows.
  Building windows_only_;
  std::vector<Pair> pairs_;
  std::vector<ZonePair> aperture_m2_;  ///< [pair * orientations + orientation]
  std::vector<ZonePair> mass_C_;       ///< [part * pairs + pair]
  std::vector<ZonePair> to_air_W_;     ///< By pair: J without the mass.
  std::vector<ZonePair> to_mass_K_;    ///< By pair: θ_m⁺ without mass and air.
  std::vector<ZonePair> air_C_;        ///< [part * pairs + pair], in the previous step.
  double air_store_W_K_ = 0.0;         ///< Of air and furniture of the whole building, C / Δt.
  double dry_bulb_C_ = 0.0;
};

}  // namespace recald::model::hourly
