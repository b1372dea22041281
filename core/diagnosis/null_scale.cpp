#include "core/diagnosis/null_scale.hpp"

#include <algorithm>
#include <array>

namespace recald::diagnosis {
namespace {

struct NullScale {
  std::string_view effect;
  double scale;
};

// Training population of seed 601, 57 buildings with nothing hidden: mean square of the score of
// the effect's best shape, drawn towards the mean of all by the weight of four buildings.
// heat_pump_defrost was a candidate at none of them.
constexpr double kAnyEffect = 54.0;
constexpr auto kNullScales = std::to_array<NullScale>({
    {"after_hours", 16.0},
    {"chiller_part_load", 91.0},
    {"clock_offset", 96.0},
    {"constant_flow_pumps", 25.0},
    {"constant_speed_fans", 45.0},
    {"damper_stuck_open", 226.0},
    {"deep_drying", 19.0},
    {"demand_limit", 16.0},
    {"demand_ventilation", 31.0},
    {"dst_misapplied", 22.0},
    {"early_start", 40.0},
    {"economiser_changeover", 27.0},
    {"economiser_failed", 31.0},
    {"equipment_step", 35.0},
    {"exterior_lighting", 15.0},
    {"fouling", 23.0},
    {"ground_coupling", 147.0},
    {"humidifier", 14.0},
    {"hybrid_work", 47.0},
    {"missing_holidays", 7.0},
    {"night_setback_missing", 80.0},
    {"outdoor_air_amount", 76.0},
    {"phase_lost", 14.0},
    {"plug_growth", 11.0},
    {"round_the_clock_zone", 100.0},
    {"scale_fault", 121.0},
    {"seasonal_hot_water", 9.0},
    {"semester_calendar", 29.0},
    {"server_room", 179.0},
    {"simultaneous_heating_cooling", 32.0},
    {"solar_gain_change", 101.0},
    {"stack_infiltration", 47.0},
    {"steam_trap_leak", 6.0},
    {"stuck_meter", 72.0},
    {"supply_reset_missing", 75.0},
    {"thermal_mass", 54.0},
    {"vacancy", 59.0},
    {"weekend_operation", 36.0},
    {"wind_infiltration", 38.0},
});

}  // namespace

double null_scale(std::string_view effect) {
  const auto found = std::ranges::find(kNullScales, effect, &NullScale::effect);
  return found == kNullScales.end() ? kAnyEffect : found->scale;
}

}  // namespace recald::diagnosis
