/// One room-sized thermal zone: well-mixed air, a radiant node, and the constructions around it.
#pragma once

#include <vector>

#include "simulators/building/wall.hpp"
#include "simulators/climate/air.hpp"

namespace recald::simulators {

/// A construction as the zone sees it.
struct ZoneSurface {
  Wall wall;
  double area_m2;
  double solar_share;  ///< Of the zone's transmitted sun and radiant gains; shares sum to 1.
};

/// What acts on a zone during one step. Heat into the zone is positive.
struct ZoneLoads {
  double convective_W = 0.0;
  double radiant_W = 0.0;  ///< Absorbed by the surfaces by their solar share.
  double moisture_kg_s = 0.0;
  double supply_kg_s = 0.0;
  AirState supply{20.0, 0.008};
  double infiltration_kg_s = 0.0;
  AirState outdoor{20.0, 0.008};
  double exchange_W = 0.0;  ///< Through doors, from the neighbours' air of the last step.
  double exchange_moisture_kg_s = 0.0;
};

/// Heat that crossed the zone's boundary in the last step, J; the sum is the change of storage.
struct ZoneHeat {
  double gains_J;
  double supply_J;
  double infiltration_J;
  double exchange_J;
  double constructions_J;  ///< Into the outer faces of all constructions.

  [[nodiscard]] double total_J() const {
    return gains_J + supply_J + infiltration_J + exchange_J + constructions_J;
  }
};

class Zone {
 public:
  /// @param air_volume_m3  Also sets the heat stored by air and furniture (six times the air's).
  Zone(std::vector<ZoneSurface> surfaces, double air_volume_m3, AirState initial);

  /// Sets the boundary of surface i for the following steps.
  void set_outer_side(std::size_t surface, const OuterSide& outer) { outer_[surface] = outer; }

  /// Advances by `step_s`: all surfaces, the radiant node and the air in one implicit system.
  ZoneHeat advance(const ZoneLoads& loads, double step_s);

  [[nodiscard]] const AirState& air() const { return air_; }
  [[nodiscard]] double radiant_C() const { return radiant_C_; }
  /// The temperature that a wall thermostat senses.
  [[nodiscard]] double operative_C() const { return 0.65 * air_.temperature_C + 0.35 * radiant_C_; }
  [[nodiscard]] const ZoneSurface& surface(std::size_t i) const { return surfaces_[i]; }
  [[nodiscard]] std::size_t surface_count() const { return surfaces_.size(); }
  [[nodiscard]] double stored_J() const;

 private:
  struct Solution {
    double air_C;
    double radiant_C;
  };
  [[nodiscard]] Solution solve(const ZoneLoads& loads, double step_s);
  void advance_moisture(const ZoneLoads& loads, double step_s);

  std::vector<ZoneSurface> surfaces_;
  std::vector<OuterSide> outer_;
  std::vector<RoomSide> room_side_;
  double air_capacity_J_K_;
  double moisture_capacity_kg_;
  AirState air_;
  double radiant_C_;
};

}  // namespace recald::simulators
