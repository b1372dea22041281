/// A small office as an EnergyPlus model: two rooms with ideal air conditioning, for tests that
/// need many runs.
#pragma once

#include "simulators/energyplus/parts/habits.hpp"

namespace recald::simulators::energyplus {

/// What may be true of the building; by default what its drawings say.
struct SmallOfficeParameters {
  double person_m2 = 0.08;
  double lighting_W_m2 = 10.0;
  double equipment_W_m2 = 9.0;
  double infiltration_m3_s_m2 = 0.0004;  ///< Per exterior surface, at 4 m/s.
  double outdoor_m3_s_person = 0.010;
  double cooling_setpoint_C = 24.0;
  double heating_setpoint_C = 21.0;
  double supply_air_C = 13.0;  ///< The coldest air that is supplied.
  double ground_C = 16.0;
  Envelope envelope{.wall_insulation_m2K_W = 1.8,
                    .roof_insulation_m2K_W = 3.0,
                    .ground_insulation_m2K_W = 1.5,
                    .window_u_W_m2K = 2.4,
                    .window_shgc = 0.4};
};

/// Meters: "Electricity:Facility", "DistrictCooling:Facility", "DistrictHeatingWater:Facility".
[[nodiscard]] Json small_office_model(const SmallOfficeParameters& parameters);

/// Those of its schedules that follow people.
[[nodiscard]] std::vector<PeopleSchedule> small_office_schedules();

}  // namespace recald::simulators::energyplus
