#include <algorithm>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// Part of the floor (a call centre, a control room, a laboratory) works in three shifts. By day it
/// is like the rest; hidden is that it continues when the others have left.
class RoundTheClockZone final : public EffectWithSettings {
 public:
  RoundTheClockZone(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings), drawings_(drawings) {}

  void plan(metering::Day /*day*/, Timetable& timetable) override {
    const double roster = settings_.rng.uniform(0.9, 1.1);
    crew_share_ = roster * (timetable.kind == DayKind::workday ? 0.7 : 0.55);
  }

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    const double zone_m2 = settings_.strength * drawings_.floor_area_m2();
    const double others_gone = 1.0 - std::min(1.0, now.people_share / kUsualPresence);
    const RoomUse& desks = drawings_.perimeter_rooms;
    RoomOperation& rooms = operation.rooms;
    rooms.extra_lights_W += zone_m2 * desks.lighting_W_m2 * kLit * others_gone;
    rooms.extra_plugs_W +=
        zone_m2 * desks.plugs_W_m2 * desks.plugs_people_share * crew_share_ * others_gone;
    rooms.extra_people += zone_m2 * drawings_.occupancy_person_m2 * crew_share_ * others_gone;
    // The zone keeps its ventilation and daytime temperature; its neighbours float as before.
    rooms.night_heating_C += settings_.strength * (rooms.heating_C - rooms.night_heating_C);
    rooms.night_cooling_C += settings_.strength * (rooms.cooling_C - rooms.night_cooling_C);
    AirOperation& air = operation.air;
    air.night_run_share = std::min(1.0, air.night_run_share + settings_.strength);
  }

 private:
  static constexpr double kUsualPresence = 0.6;  ///< Present / assigned in the middle of a day.
  static constexpr double kLit = 0.85;           ///< Of the lights in rooms with a crew.

  Drawings drawings_;
  double crew_share_ = 0.0;  ///< Occupied desks in the additional shifts.
};

}  // namespace

EffectKind round_the_clock_zone() {
  return {.id = "round_the_clock_zone",
          .title = "Part of the floor works day and night",
          .group = EffectClass::schedules,
          .sentence =
              "A call centre or control room works in shifts on part of the floor: its lights, "
              "computers, air, cooling and heating go on through nights and weekends.",
          .strength = {0.0, 0.1, 0.5, "share of the floor that never closes"},
          .needs = {.timetable = true},
          .turns = "night shifts",
          .make = make_effect<RoundTheClockZone>};
}

}  // namespace recald::simulators
