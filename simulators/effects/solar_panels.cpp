#include <algorithm>
#include <cmath>

#include "simulators/climate/sun.hpp"
#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

constexpr double kTestSun_W_m2 = 1000.0;      ///< Panels are rated at this irradiance and 25 degC.
constexpr double kPanelHeating_Km2_W = 0.03;  ///< Panel above air temperature, per irradiance.
constexpr double kLossPerKelvin = 0.004;
constexpr double kSystemShare = 0.86;    ///< Cables, dirt, mismatch, inverter.
constexpr double kInverterShare = 0.85;  ///< Of the rated power: the limit of the inverter.
constexpr double kSnowCovers_mm = 3.0;

/// Photovoltaic panels behind the building's meter. Surplus power is exported and not counted.
class SolarPanels final : public EffectWithSettings {
 public:
  SolarPanels(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        rated_kW_(settings.strength * drawings.floor_area_m2() / 1000.0) {
    const double towards_equator_deg = drawings.place.latitude_deg < 0.0 ? 0.0 : 180.0;
    panel_.azimuth_deg = towards_equator_deg + settings_.rng.uniform(-40.0, 40.0);
    panel_.tilt_deg = settings_.rng.uniform(8.0, 30.0);
  }

  void supply(const Moment& now, UtilityPower& power) override {
    if (!settings_.covers(now.local.date)) return;
    const double made_kW = rated_kW_ * share_of_rated(now.outdoors);
    power.electricity_kW -= std::min(std::max(0.0, power.electricity_kW), made_kW);
  }

 private:
  [[nodiscard]] double share_of_rated(const Outdoors& outdoors) const {
    const double sun_W_m2 =
        irradiance_on(panel_, outdoors.sun, outdoors.sky, outdoors.ground_reflectance).total_W_m2();
    const double panel_C = outdoors.air.temperature_C + kPanelHeating_Km2_W * sun_W_m2;
    const double uncovered = std::exp(-outdoors.snow_cover_mm / kSnowCovers_mm);
    return std::clamp(kSystemShare * uncovered * sun_W_m2 / kTestSun_W_m2 *
                          (1.0 - kLossPerKelvin * (panel_C - 25.0)),
                      0.0, kInverterShare);
  }

  double rated_kW_;
  Orientation panel_{};
};

}  // namespace

EffectKind solar_panels() {
  return {.id = "solar_panels",
          .title = "Panels on the roof",
          .group = EffectClass::outside_catalogue,
          .sentence =
              "Photovoltaic panels that nobody mentioned feed the building: the electricity meter "
              "dips with the sun at noon, most in summer.",
          .strength = {0.0, 12.0, 45.0, "W of rated panel power for each m² of floor"},
          .turns = "solar panels",
          .make = make_effect<SolarPanels>};
}

}  // namespace recald::simulators
