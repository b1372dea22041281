#include "core/diagnosis/null_scale.hpp"

#include <array>

#include "core/diagnosis/learnt.hpp"

namespace recald::diagnosis {
namespace {

// Training population of seed 601, 25 buildings with nothing hidden: one plus the mean of the
// positive support, of the first look alone where an effect was not worth a fit; drawn towards the
// mean of all effects by the weight of four buildings. What is not listed was visible at none.
constexpr double kAnyEffect = 3.9;
constexpr auto kNullScales = std::to_array<Learnt>({
    {"after_hours", 1.7},
    {"chiller_part_load", 6.8},
    {"clock_offset", 10.5},
    {"constant_flow_pumps", 2.0},
    {"constant_speed_fans", 4.0},
    {"damper_stuck_open", 6.4},
    {"deep_drying", 1.5},
    {"demand_limit", 1.4},
    {"demand_ventilation", 5.4},
    {"dst_misapplied", 1.8},
    {"early_start", 2.8},
    {"economiser_changeover", 3.1},
    {"economiser_failed", 3.1},
    {"equipment_step", 2.3},
    {"exterior_lighting", 3.4},
    {"fouling", 1.6},
    {"ground_coupling", 6.9},
    {"humidifier", 1.6},
    {"hybrid_work", 2.5},
    {"missing_holidays", 1.6},
    {"night_setback_missing", 3.4},
    {"outdoor_air_amount", 2.8},
    {"phase_lost", 1.9},
    {"plug_growth", 1.5},
    {"round_the_clock_zone", 3.6},
    {"scale_fault", 8.5},
    {"seasonal_hot_water", 1.7},
    {"semester_calendar", 1.4},
    {"server_room", 9.6},
    {"simultaneous_heating_cooling", 7.7},
    {"solar_gain_change", 7.1},
    {"stack_infiltration", 2.0},
    {"steam_trap_leak", 1.8},
    {"stuck_meter", 6.4},
    {"supply_reset_missing", 7.5},
    {"thermal_mass", 2.5},
    {"vacancy", 4.9},
    {"weekend_operation", 1.8},
    {"wind_infiltration", 4.4},
});

}  // namespace

double null_scale(std::string_view effect) { return learnt_of(kNullScales, effect, kAnyEffect); }

}  // namespace recald::diagnosis
