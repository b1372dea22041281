#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {

// Each stands in the file of its name.
EffectKind night_setback_missing();
EffectKind weekend_operation();
EffectKind missing_holidays();
EffectKind after_hours();
EffectKind early_start();
EffectKind round_the_clock_zone();
EffectKind semester_calendar();
EffectKind vacancy();
EffectKind hybrid_work();
EffectKind damper_stuck_open();
EffectKind demand_ventilation();
EffectKind economiser_changeover();
EffectKind economiser_failed();
EffectKind outdoor_air_amount();
EffectKind constant_flow_pumps();
EffectKind constant_speed_fans();
EffectKind deep_drying();
EffectKind humidifier();
EffectKind setpoint_raised();
EffectKind simultaneous_heating_cooling();
EffectKind supply_reset_missing();
EffectKind ground_coupling();
EffectKind solar_gain_change();
EffectKind stack_infiltration();
EffectKind thermal_mass();
EffectKind wind_infiltration();
EffectKind chiller_part_load();
EffectKind fouling();
EffectKind heat_pump_defrost();
EffectKind seasonal_hot_water();
EffectKind steam_trap_leak();
EffectKind demand_limit();
EffectKind equipment_step();
EffectKind exterior_lighting();
EffectKind plug_growth();
EffectKind server_room();
EffectKind clock_offset();
EffectKind dst_misapplied();
EffectKind phase_lost();
EffectKind scale_fault();
EffectKind stuck_meter();
EffectKind backup_generator_test();
EffectKind cooking();
EffectKind data_backup_nights();
EffectKind ev_charging();
EffectKind event_evenings();
EffectKind ice_storage();
EffectKind irrigation_pumps();
EffectKind night_purge();
EffectKind open_windows();
EffectKind snow_melting();
EffectKind snow_on_skylight();
EffectKind solar_panels();
EffectKind swimming_pool();
EffectKind tariff_load_shift();

std::string_view to_string(EffectClass group) {
  switch (group) {
    case EffectClass::schedules:
      return "schedules";
    case EffectClass::outdoor_air:
      return "outdoor_air";
    case EffectClass::air_system:
      return "air_system";
    case EffectClass::envelope:
      return "envelope";
    case EffectClass::plant:
      return "plant";
    case EffectClass::electrical:
      return "electrical";
    case EffectClass::meters:
      return "meters";
    case EffectClass::operators:
      return "operators";
    case EffectClass::outside_catalogue:
      return "outside_catalogue";
  }
  return "";
}

namespace {

std::string needs_in_words(const EffectKind& kind) {
  const EffectNeeds& needs = kind.needs;
  std::string words;
  const auto add = [&](bool needed, std::string_view what) {
    if (needed) words += (words.empty() ? "" : ", ") + std::string(what);
  };
  add(needs.cooling_meter, "chilled-water meter");
  add(needs.heat_meter, "heat meter");
  add(needs.own_chiller, "own chiller");
  add(needs.heat_pump, "heat pump");
  add(needs.fuel, "gas boiler");
  add(needs.economiser, "economiser");
  add(needs.timetable, "rooms that stop at night");
  add(needs.skylight, "skylight");
  add(kind.dated, "from = \"YYYY-MM-DD\"");
  add(kind.of_one_meter, "meter = \"electricity\" or another");
  return words;
}

}  // namespace

std::string explain(const EffectKind& kind) {
  std::string text =
      fmt::format("{} ({}): {}\n  {}\n  strength {:g} to {:g}, typically {:g} ({})\n", kind.id,
                  to_string(kind.group), kind.title, kind.sentence, kind.strength.min,
                  kind.strength.max, kind.strength.typical, kind.strength.unit);
  const std::string needs = needs_in_words(kind);
  return needs.empty() ? text : text + "  needs: " + needs + "\n";
}

std::span<const EffectKind> effect_kinds() {
  static const std::array kinds{
      // schedules
      night_setback_missing(),
      weekend_operation(),
      missing_holidays(),
      after_hours(),
      early_start(),
      round_the_clock_zone(),
      semester_calendar(),
      vacancy(),
      hybrid_work(),
      // outdoor air
      damper_stuck_open(),
      demand_ventilation(),
      economiser_changeover(),
      economiser_failed(),
      outdoor_air_amount(),
      // air system
      constant_flow_pumps(),
      constant_speed_fans(),
      deep_drying(),
      humidifier(),
      simultaneous_heating_cooling(),
      supply_reset_missing(),
      // envelope
      ground_coupling(),
      solar_gain_change(),
      stack_infiltration(),
      thermal_mass(),
      wind_infiltration(),
      // plant
      chiller_part_load(),
      fouling(),
      heat_pump_defrost(),
      seasonal_hot_water(),
      steam_trap_leak(),
      // electrical
      demand_limit(),
      equipment_step(),
      exterior_lighting(),
      plug_growth(),
      server_room(),
      // meters
      clock_offset(),
      dst_misapplied(),
      phase_lost(),
      scale_fault(),
      stuck_meter(),
      // operators
      setpoint_raised(),
      // outside catalogue
      backup_generator_test(),
      cooking(),
      data_backup_nights(),
      ev_charging(),
      event_evenings(),
      ice_storage(),
      irrigation_pumps(),
      night_purge(),
      open_windows(),
      snow_melting(),
      snow_on_skylight(),
      solar_panels(),
      swimming_pool(),
      tariff_load_shift(),
  };
  return kinds;
}

const EffectKind* find_effect_kind(std::string_view id) {
  const auto kinds = effect_kinds();
  const auto found = std::ranges::find(kinds, id, &EffectKind::id);
  return found == kinds.end() ? nullptr : &*found;
}

}  // namespace recald::simulators
