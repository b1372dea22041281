#include "daemon/gateway/registers/alarm_codes.hpp"

#include <algorithm>
#include <array>

namespace recald::daemon {
namespace {

// The next effect gets the next number, whatever it is called.
constexpr std::array kEffectCodes{
    EffectCode{"after_hours", 100},
    EffectCode{"chiller_part_load", 101},
    EffectCode{"clock_offset", 102},
    EffectCode{"constant_flow_pumps", 103},
    EffectCode{"constant_speed_fans", 104},
    EffectCode{"damper_stuck_open", 105},
    EffectCode{"deep_drying", 106},
    EffectCode{"demand_limit", 107},
    EffectCode{"demand_ventilation", 108},
    EffectCode{"dst_misapplied", 109},
    EffectCode{"early_start", 110},
    EffectCode{"economiser_changeover", 111},
    EffectCode{"economiser_failed", 112},
    EffectCode{"equipment_step", 113},
    EffectCode{"exterior_lighting", 114},
    EffectCode{"fouling", 115},
    EffectCode{"ground_coupling", 116},
    EffectCode{"heat_pump_defrost", 117},
    EffectCode{"humidifier", 118},
    EffectCode{"hybrid_work", 119},
    EffectCode{"missing_holidays", 120},
    EffectCode{"night_setback_missing", 121},
    EffectCode{"outdoor_air_amount", 122},
    EffectCode{"phase_lost", 123},
    EffectCode{"plug_growth", 124},
    EffectCode{"round_the_clock_zone", 125},
    EffectCode{"scale_fault", 126},
    EffectCode{"seasonal_hot_water", 127},
    EffectCode{"semester_calendar", 128},
    EffectCode{"server_room", 129},
    EffectCode{"simultaneous_heating_cooling", 130},
    EffectCode{"solar_gain_change", 131},
    EffectCode{"stack_infiltration", 132},
    EffectCode{"steam_trap_leak", 133},
    EffectCode{"stuck_meter", 134},
    EffectCode{"supply_reset_missing", 135},
    EffectCode{"thermal_mass", 136},
    EffectCode{"vacancy", 137},
    EffectCode{"weekend_operation", 138},
    EffectCode{"wind_infiltration", 139},
};

}  // namespace

std::span<const EffectCode> effect_codes() { return kEffectCodes; }

AlarmCode alarm_code(drift::CauseKind kind, std::string_view subject) {
  switch (kind) {
    case drift::CauseKind::nothing:
      return AlarmCode::nothing;
    case drift::CauseKind::parameter:
      return AlarmCode::parameter;
    case drift::CauseKind::direction:
      return AlarmCode::use;
    case drift::CauseKind::meter:
      return AlarmCode::meter;
    case drift::CauseKind::unknown:
      return AlarmCode::unknown;
    case drift::CauseKind::effect:
      break;
  }
  const auto effect = std::ranges::find(kEffectCodes, subject, &EffectCode::effect);
  if (effect == kEffectCodes.end()) return AlarmCode::unknown;
  return static_cast<AlarmCode>(effect->number);
}

}  // namespace recald::daemon
