/// From coil loads to what the meters measure: pumps, chillers, converters, boilers,
/// pipes, hot water.
#pragma once

#include <cstddef>
#include <string_view>

#include "simulators/building/operation.hpp"
#include "simulators/building/truth.hpp"
#include "simulators/chance/chance.hpp"

namespace recald::simulators {

/// What can be metered, in the order of files. Heat is steam, hot water or fuel,
/// depending on the plant.
enum class Utility : std::size_t { cooling, electricity, heat };
inline constexpr std::size_t kUtilities = 3;

/// Mean powers over one step as they pass the meters.
struct UtilityPower {
  double electricity_kW = 0.0;
  double cooling_kW = 0.0;
  double heat_kW = 0.0;

  [[nodiscard]] double& operator[](Utility utility) {
    return utility == Utility::cooling       ? cooling_kW
           : utility == Utility::electricity ? electricity_kW
                                             : heat_kW;
  }
  [[nodiscard]] double operator[](Utility utility) const {
    return const_cast<UtilityPower&>(*this)[utility];
  }
};

/// The demand of the building on its services in one step.
struct ServiceLoad {
  double cooling_W = 0.0;
  double heating_W = 0.0;  ///< Preheat, reheat and humidifiers.
  double lights_and_plugs_W = 0.0;
  double fans_W = 0.0;
  double other_electricity_W = 0.0;  ///< Outside the rooms.
  double other_fuel_W = 0.0;         ///< Burnt or condensed outside the heating system.
  double people_share = 0.0;         ///< Present / assigned.
  double awake_share = 0.0;          ///< Of the people present, those awake: drives hot-water use.
  bool dark = false;                 ///< Exterior lights on.
};

/// A building's services. A chiller, packaged units or a heat pump of its own add to the
/// electricity meter; chilled water is metered wherever there is any.
class Plant {
 public:
  Plant(const Truth& truth, double step_s, Rng rng);

  [[nodiscard]] UtilityPower advance(const ServiceLoad& load, const PlantOperation& operation,
                                     const Outdoors& outdoors);

 private:
  /// Temperatures between which a compressor works: rated and current.
  struct Lift {
    double evaporator_K;
    double rated_condenser_K;
    double condenser_K;
    double least_share;  ///< Of the rated load; below it, the compressor cycles at this share.
  };
  [[nodiscard]] Lift lift_of(const Outdoors& outdoors) const;
  [[nodiscard]] double hot_water_W(double awake_share, const PlantOperation& operation);
  [[nodiscard]] double pumps_W(const ServiceLoad& load, const PlantOperation& operation) const;
  [[nodiscard]] double heating_efficiency(double heating_W) const;
  [[nodiscard]] double cooling_kW(const ServiceLoad& load, double pumps_W,
                                  const PlantOperation& operation) const;
  [[nodiscard]] double compressor_W(double cooling_W, double cop_factor, const Lift& lift) const;
  [[nodiscard]] double heat_pump_W(double heating_W, double cop_factor, double outdoor_C) const;

  Truth truth_;
  Rng rng_;
  Persistence taps_;
};

}  // namespace recald::simulators
