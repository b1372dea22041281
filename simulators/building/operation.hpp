/// What a day's timetable and a step's controls ask for. Hidden effects turn these.
///
/// Every member's default is "as built": nothing added, nothing lost. Physics reads them where they
/// act (air handler, envelope, rooms, plant); effects only say when and how far they are turned.
#pragma once

#include <array>
#include <optional>

#include "core/metering/civil_time.hpp"
#include "simulators/building/calendar.hpp"
#include "simulators/climate/weather.hpp"

namespace recald::simulators {

/// Two instants of a local day in hours; `to` before `from` means never.
struct RunningHours {
  double from_h;
  double to_h;
};

/// One local day as controls and people live it; decided at midnight.
struct Timetable {
  DayKind kind;             ///< Holidays are Sundays.
  RunningHours air;         ///< When air handlers with a timetable ventilate.
  double warm_up_h = 1.0;   ///< They recirculate so long before.
  double attendance = 1.0;  ///< Of the people who would have come, the share that does.
};

/// When, and in what weather.
struct Moment {
  metering::Instant instant;
  metering::LocalTime local;
  DayKind day_kind;
  const Outdoors& outdoors;
  double step_s;        ///< Length of the step that begins.
  double people_share;  ///< Present / assigned, in the step before.
  bool air_runs;        ///< The timetable lets air handlers ventilate now.

  [[nodiscard]] double hour() const { return local.minute_of_day / 60.0; }
};

struct RoomOperation {
  double cooling_C;  ///< Occupied set-points.
  double heating_C;
  double night_cooling_C;  ///< Where rooms float at night.
  double night_heating_C;
  double lights_factor = 1.0;
  double plugs_factor = 1.0;
  double extra_lights_W = 0.0;  ///< All rooms together, spread by floor area.
  double extra_plugs_W = 0.0;   ///< Likewise; warms the rooms.
  double server_W = 0.0;        ///< In the special rooms.
  double extra_people = 0.0;    ///< Beyond those who plan their day; spread by floor area.
};

struct AirOperation {
  double outdoor_factor = 1.0;  ///< On the outdoor air that is asked for while ventilating.
  double damper_leak_share =
      0.0;                        ///< Of the supply air that is outdoor air whenever the fan turns.
  double economiser_share = 1.0;  ///< Of the free cooling that the dampers could give.
  double economiser_shift_K = 0.0;  ///< Added to the change-over temperature.
  double supply_shift_K = 0.0;      ///< Added to the supply-air set-point.
  double supply_reset_share = 1.0;  ///< Of the reset in cold weather.
  double night_run_share = 0.0;     ///< Of outdoor air and least flow, outside the timetable.
  double reheat_leak_share = 0.0;  ///< Of the reheat coils' capacity, past valves that do not shut.
  double fan_follows_flow = 1.0;  ///< 1: fans slow down with the flow; 0: they run at design speed.
  std::optional<double> dry_to_C;  ///< Coils go as cold as it takes for this supply dew point.
  double humidify_to_kg_kg = 0.0;  ///< Steam is added to the supply air up to this humidity.
  double purge_share = 0.0;        ///< Of the full flow: outdoor air alone, no coils, outside the
                                   ///< timetable, where rooms are warmer than outdoors.
};

struct EnvelopeOperation {
  std::array<double, 4> opening_m2{};  ///< In each facade, at ground level; the wind drives it.
  double shaft_m2 = 0.0;               ///< From the lowest to the highest storey; buoyancy.
  double window_opening_m2 = 0.0;      ///< Spread over the perimeter's windows.
  double extraction_m3_s = 0.0;  ///< By separate fans; outdoor air leaks into the perimeter for it.
  std::array<double, 4> sun_factor{1.0, 1.0, 1.0, 1.0};  ///< On what passes the facades' windows.
  double skylight_factor = 1.0;
  double ground_shift_K = 0.0;  ///< Added to the temperature of the ground.
};

struct PlantOperation {
  double chiller_cop_factor = 1.0;
  double heat_pump_cop_factor = 1.0;
  double pumps_always_W = 0.0;     ///< Electricity of pumps, whatever the load.
  double pumps_follow_load = 1.0;  ///< 1: variable speed; 0: design speed all year.
  double chilled_water_standing_W = 0.0;
  double heating_standing_W = 0.0;  ///< Traps, pipes, circulation: heat that reaches no room.
  double hot_water_factor = 1.0;
  double mains_shift_K = 0.0;    ///< Added to the cold water's temperature.
  double cooling_shift_W = 0.0;  ///< A store: positive charges, negative discharges it.
};

struct Operation {
  RoomOperation rooms;
  AirOperation air;
  EnvelopeOperation envelope;
  PlantOperation plant;
};

}  // namespace recald::simulators
