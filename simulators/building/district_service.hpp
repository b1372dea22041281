/// From coil loads to what the three revenue meters see: pumps, converter, pipes, hot water.
#pragma once

#include "simulators/building/truth.hpp"
#include "simulators/chance/chance.hpp"

namespace recald::simulators {

/// Mean powers over one step as they pass the meters.
struct UtilityPower {
  double electricity_kW = 0.0;
  double chilled_water_kW = 0.0;
  double steam_kW = 0.0;
};

/// What the building asks of its services in one step.
struct ServiceLoad {
  double cooling_W = 0.0;
  double heating_W = 0.0;  ///< Preheat and reheat coils.
  double lights_and_plugs_W = 0.0;
  double fans_W = 0.0;
  double people_share = 0.0;  ///< Present / assigned, drives hot-water use.
  bool dark = false;          ///< Exterior lights on.
};

class DistrictService {
 public:
  DistrictService(const Truth& truth, Rng rng);

  [[nodiscard]] UtilityPower advance(const ServiceLoad& load);

 private:
  [[nodiscard]] double hot_water_W(double people_share);
  [[nodiscard]] double pumps_W(const ServiceLoad& load) const;

  Truth truth_;
  Rng rng_;
  Persistence taps_;
};

}  // namespace recald::simulators
