/// A campus laboratory as an EnergyPlus model: the building of the seed, as far as its paper
/// describes it.
///
/// Two storeys of 80 m × 40 m. On each, offices along the south and the north facade and a
/// laboratory between them. The offices have one air handler; each storey's laboratory has its own,
/// which takes most of its air from outdoors, day and night. Chilled and hot water come from the
/// district.
/// @see Li, Gu, Augenbroe, Wu, Brown (2015), Building Simulation.
#pragma once

#include <array>

#include "simulators/energyplus/parts/habits.hpp"

namespace recald::simulators::energyplus {

inline constexpr std::size_t kLaboratoryStoreys = 2;

/// What may be true of the building; by default what its drawings say.
struct LaboratoryParameters {
  double office_person_m2 = 0.06;
  double laboratory_person_m2 = 0.04;
  double office_lighting_W_m2 = 9.5;
  double laboratory_lighting_W_m2 = 11.0;
  double office_equipment_W_m2 = 10.0;
  double laboratory_equipment_W_m2 = 28.0;
  double infiltration_m3_s_m2 = 0.0003;  ///< Per exterior surface, at 4 m/s.
  double office_outdoor_m3_s = 3.0;
  std::array<double, kLaboratoryStoreys> laboratory_outdoor_m3_s{8.0, 8.0};
  double cooling_setpoint_C = 24.0;
  double heating_setpoint_C = 21.0;
  double supply_air_C = 13.0;
  double chilled_water_C = 6.7;
  double fan_pressure_Pa = 1100.0;
  double ground_C = 18.0;
  Envelope envelope{.wall_insulation_m2K_W = 1.7,
                    .roof_insulation_m2K_W = 2.8,
                    .ground_insulation_m2K_W = 1.5,
                    .window_u_W_m2K = 2.7,
                    .window_shgc = 0.4};
};

/// Meters: "Electricity:Facility", "DistrictCooling:Facility", "DistrictHeatingWater:Facility".
/// Objects that a parameter would change are called after what they serve: "Offices people",
/// "Laboratories lights", "Laboratory handler 1 outdoor air controller", "Cooling set-point".
[[nodiscard]] Json laboratory_model(const LaboratoryParameters& parameters);

/// Those of its schedules that follow people.
[[nodiscard]] std::vector<PeopleSchedule> laboratory_schedules();

}  // namespace recald::simulators::energyplus
