#include <algorithm>
#include <array>
#include <optional>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/slow_value.hpp"

namespace recald::simulators {
namespace {

/// Receptions, lectures, sports: on some thirty evenings a year, mostly late in the week and never
/// in quiet seasons, many people come when the building is usually empty.
class EventEvenings final : public EffectWithSettings {
 public:
  EventEvenings(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings), drawings_(drawings) {}

  void plan(metering::Day day, Timetable& timetable) override {
    Rng& rng = settings_.rng;
    const bool booked = rng.uniform() < chance_of_event(day);
    const double from_h = rng.uniform(17.5, 19.5);
    const double to_h = std::min(24.0, from_h + rng.uniform(2.5, 4.5));
    crowd_share_ = rng.uniform(0.6, 1.4);
    event_.reset();
    if (!booked || !settings_.covers(day)) return;
    event_ = {from_h, to_h};
    // A big event has ventilation for its whole evening, a small one for part of it.
    const double air_share = std::min(1.0, settings_.strength / kFullAir);
    const double with_air_h = air_share * (to_h - from_h);
    RunningHours& air = timetable.air;
    if (air.from_h >= air.to_h) {
      if (with_air_h <= 0.0) return;
      air = {from_h, from_h + with_air_h};
      timetable.warm_up_h *= air_share;
    } else {
      air.to_h = std::max(air.to_h, air.to_h + air_share * (to_h - air.to_h));
    }
  }

  void operate(const Moment& now, Operation& operation) override {
    if (!event_) return;
    const double guests = settings_.strength * crowd_share_ * here_share(now.hour()) *
                          drawings_.floor_area_m2() * drawings_.occupancy_person_m2;
    RoomOperation& rooms = operation.rooms;
    rooms.extra_people += guests;
    rooms.extra_lights_W += guests * kLights_W_guest;
    rooms.extra_plugs_W += guests * kStage_W_guest;
  }

 private:
  static constexpr double kFullAir = 0.5;  ///< Strength from which the whole evening is ventilated.
  static constexpr double kLights_W_guest = 60.0;  ///< Halls and corridors lit for the event.
  static constexpr double kStage_W_guest = 25.0;   ///< Stage, sound, buffet.

  [[nodiscard]] static double chance_of_event(metering::Day day) {
    constexpr std::array by_weekday{0.03, 0.07, 0.09, 0.17, 0.19, 0.14, 0.03};  // from Monday
    constexpr std::array by_month{0.5, 1.0, 1.1, 1.1, 1.3, 1.0, 0.3, 0.2, 1.0, 1.2, 1.3, 1.0};
    const unsigned weekday = std::chrono::weekday{std::chrono::sys_days{day}}.iso_encoding() - 1;
    return by_weekday[weekday] * by_month[static_cast<unsigned>(day.month()) - 1];
  }
  /// Guests come within three quarters of an hour and leave within half an hour.
  [[nodiscard]] double here_share(double hour) const {
    return ramp(hour, event_->from_h - 0.5, event_->from_h + 0.25) *
           ramp(hour, event_->to_h, event_->to_h - 0.5);
  }

  Drawings drawings_;
  std::optional<RunningHours> event_;  ///< Of this evening.
  double crowd_share_ = 1.0;           ///< Of this evening, relative to the strength.
};

}  // namespace

EffectKind event_evenings() {
  return {.id = "event_evenings",
          .title = "Evening events",
          .group = EffectClass::outside_catalogue,
          .sentence =
              "On some evenings, at irregular dates, events bring many people: lights, fans and "
              "cooling run until late, other evenings show nothing.",
          .strength = {0.0, 0.6, 2.0, "guests for each person who works in the building"},
          .turns = "evening events",
          .make = make_effect<EventEvenings>};
}

}  // namespace recald::simulators
