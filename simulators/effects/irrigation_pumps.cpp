#include <algorithm>
#include <array>

#include "simulators/climate/air.hpp"
#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

constexpr double kStart_h = 22.0;
constexpr double kEnd_h = 5.0;
constexpr double kThirst_mm = 8.0;   ///< Water missing in the soil before pumps are wanted.
constexpr double kDriest_mm = 50.0;  ///< Dry soil gives plants no more water than this.
constexpr double kWatering_mm_h = 2.0;
constexpr double kGrowing_C = 12.0;      ///< Mean air temperature below which nothing grows.
constexpr std::size_t kValveSlots = 14;  ///< Half hours per night.

/// Pumps water the grounds at night after warm weeks without rain.
class IrrigationPumps final : public EffectWithSettings {
 public:
  IrrigationPumps(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        pumps_W_(settings.strength * drawings.floor_area_m2()),
        air_C_(3.0 * 86'400.0) {}

  void plan(metering::Day /*day*/, Timetable& /*timetable*/) override {
    // Valves open lawns of different size in turn.
    for (double& lawn : lawns_) lawn = settings_.rng.uniform(0.8, 1.2);
  }

  void load(const Moment& now, ServiceLoad& load) override {
    const double mean_C = air_C_.follow(now.outdoors.air.temperature_C, now.step_s);
    dry_out(now.outdoors, now.step_s / 3600.0);
    const bool night = now.hour() >= kStart_h || now.hour() < kEnd_h;
    watering_ = night && mean_C > kGrowing_C && missing_mm_ > (watering_ ? 0.0 : kThirst_mm);
    if (!watering_) return;
    missing_mm_ = std::max(0.0, missing_mm_ - kWatering_mm_h * now.step_s / 3600.0);
    if (!settings_.covers(now.local.date)) return;
    const double into_night_h =
        now.hour() < kEnd_h ? now.hour() + 24.0 - kStart_h : now.hour() - kStart_h;
    const auto slot = static_cast<std::size_t>(2.0 * into_night_h);
    load.other_electricity_W += pumps_W_ * lawns_[std::min(slot, kValveSlots - 1)];
  }

 private:
  /// Lawns evaporate two thirds of the potential for the sunshine, and less in the cold.
  /// @see Makkink (1957), J. Inst. Water Eng. 11, 277-288, with the factor 0.65.
  void dry_out(const Outdoors& outdoors, double hours) {
    const double air_C = outdoors.air.temperature_C;
    const double slope_Pa_K =
        saturation_pressure_Pa(air_C + 0.5) - saturation_pressure_Pa(air_C - 0.5);
    constexpr double psychrometer_Pa_K = 66.0;
    const double by_sun_mm_h = 3600.0 * outdoors.global_horizontal_W_m2 / kEvaporation_J_kg;
    const double lost_mm_h = 0.65 * slope_Pa_K / (slope_Pa_K + psychrometer_Pa_K) * by_sun_mm_h;
    missing_mm_ = std::clamp(missing_mm_ + (lost_mm_h - outdoors.precipitation_mm_h) * hours, 0.0,
                             kDriest_mm);
  }

  double pumps_W_;
  SlowValue air_C_;
  double missing_mm_ = 0.0;
  bool watering_ = false;
  std::array<double, kValveSlots> lawns_{};
};

}  // namespace

EffectKind irrigation_pumps() {
  return {
      .id = "irrigation_pumps",
      .title = "Pumps water the grounds",
      .group = EffectClass::outside_catalogue,
      .sentence =
          "In warm weeks without rain pumps water the grounds at night: electricity goes up for "
          "some hours of some nights, and nothing else does.",
      .strength = {0.0, 5.0, 15.0, "W/m² of the building's floor"},
      .turns = "irrigation",
      .make = make_effect<IrrigationPumps>};
}

}  // namespace recald::simulators
