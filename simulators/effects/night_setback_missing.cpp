#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {

EffectKind night_setback_missing() {
  return {
      .id = "night_setback_missing",
      .title = "Night set-back missing",
      .group = EffectClass::schedules,
      .sentence =
          "Rooms are kept at daytime temperature all night and all weekend: heating and cooling "
          "run when nobody is there.",
      .strength = {0.0, 1.0, 1.0, "share of the set-back that is missing"},
      .needs = {.heat_meter = true, .timetable = true},
      .turns = "night set-points",
      // The clock that should let rooms float at night has no effect on the thermostats.
      .operate = [](const EffectSettings& settings, const Moment&, Operation& operation) {
        RoomOperation& rooms = operation.rooms;
        rooms.night_heating_C += settings.strength * (rooms.heating_C - rooms.night_heating_C);
        rooms.night_cooling_C += settings.strength * (rooms.cooling_C - rooms.night_cooling_C);
      }};
}

}  // namespace recald::simulators
