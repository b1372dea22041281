/// What a day's timetable and the controls of a step request. Hidden effects change these.
///
/// Every member's default is "as built": nothing added, nothing lost. The physics reads them where
/// they apply (air handler, envelope, rooms, plant); effects only say when and how far they change.
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

/// One local day for controls and people; decided at midnight.
struct Timetable {
  DayKind kind;             ///< Holidays count as Sundays.
  RunningHours air;         ///< When air handlers with a timetable ventilate.
  double warm_up_h = 1.0;   ///< They recirculate for this long before.
  double attendance = 1.0;  ///< Share of the people who would have come that does.
};

/// A time and its weather.
struct Moment {
  metering::Instant instant;
  metering::LocalTime local;
  DayKind day_kind;
  const Outdoors& outdoors;
  double step_s;        ///< Length of the step that starts.
  double people_share;  ///< Present / assigned, in the previous step.
  bool air_runs;        ///< Whether the timetable lets air handlers ventilate now.

  [[nodiscard]] double hour() const { return local.minute_of_day / 60.0; }
};

struct RoomOperation {
  double cooling_C;  ///< Occupied set-points.
  double heating_C;
  double night_cooling_C;  ///< Limits between which rooms float at night.
  double night_heating_C;
  double lights_factor = 1.0;
  double plugs_factor = 1.0;
  double extra_lights_W = 0.0;  ///< In all rooms together, spread by floor area.
  double extra_plugs_W = 0.0;   ///< Likewise; warms the rooms.
  double server_W = 0.0;        ///< In the special rooms.
  double extra_people = 0.0;    ///< In addition to those who plan their day; spread by floor area.
};

struct AirOperation {
  double outdoor_factor = 1.0;  ///< Applied to the outdoor air requested while ventilating.
  double damper_leak_share =
      0.0;  ///< Of the supply air: the part that is outdoor air whenever the fan runs.
  double economiser_share = 1.0;    ///< Of the free cooling that the dampers could provide.
  double economiser_shift_K = 0.0;  ///< Added to the change-over temperature.
  double supply_shift_K = 0.0;      ///< Added to the supply-air set-point.
  double supply_reset_share = 1.0;  ///< Of the reset in cold weather.
  double night_run_share = 0.0;     ///< Of outdoor air and least flow, outside the timetable.
  double reheat_leak_share = 0.0;   ///< Of the reheat coils' capacity, through leaking valves.
  double fan_follows_flow = 1.0;  ///< 1: fans slow down with the flow; 0: they run at design speed.
  std::optional<double> dry_to_C;  ///< Coils cool as far as needed for this supply dew point.
  double humidify_to_kg_kg = 0.0;  ///< Steam humidifies the supply air up to this humidity.
  double purge_share = 0.0;        ///< Of the full flow: outdoor air alone, no coils, outside the
                                   ///< timetable, where rooms are warmer than outdoors.
};

struct EnvelopeOperation {
  std::array<double, 4> opening_m2{};  ///< In each facade, at ground level; the wind drives it.
  double shaft_m2 = 0.0;               ///< From the lowest to the highest storey; buoyancy.
  double window_opening_m2 = 0.0;      ///< Spread over the windows of the perimeter.
  double extraction_m3_s = 0.0;        ///< By separate fans; as much air leaks into the perimeter.
  std::array<double, 4> sun_factor{1.0, 1.0, 1.0, 1.0};  ///< On the sun through the windows.
  double skylight_factor = 1.0;
  double ground_shift_K = 0.0;  ///< Added to the temperature of the ground.
};

struct PlantOperation {
  double chiller_cop_factor = 1.0;
  double heat_pump_cop_factor = 1.0;
  double pumps_always_W = 0.0;     ///< Electricity of pumps, independent of the load.
  double pumps_follow_load = 1.0;  ///< 1: variable speed; 0: design speed all year.
  double chilled_water_standing_W = 0.0;
  double heating_standing_W = 0.0;  ///< Traps, pipes, circulation: heat that reaches no room.
  double hot_water_factor = 1.0;
  double mains_shift_K = 0.0;    ///< Added to the cold water's temperature.
  double cooling_shift_W = 0.0;  ///< A store: positive charges it, negative discharges it.
};

struct Operation {
  RoomOperation rooms;
  AirOperation air;
  EnvelopeOperation envelope;
  PlantOperation plant;
};

}  // namespace recald::simulators
