#include <algorithm>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// Electricity is expensive on summer afternoons and winter mornings of working days. Set-points
/// are relaxed then, and rooms are cooled or heated in advance.
class TariffLoadShift final : public EffectWithSettings {
 public:
  using EffectWithSettings::EffectWithSettings;

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date) || now.day_kind != DayKind::workday) return;
    RoomOperation& rooms = operation.rooms;
    const auto between = [&](double from_h, double to_h) {
      return now.hour() >= from_h && now.hour() < to_h;
    };
    // Rooms must not be pre-cooled and preheated at once.
    const double ahead_K = std::min(kAhead * settings_.strength,
                                    std::max(0.0, rooms.cooling_C - rooms.heating_C - kApart_K));
    if (summer(now.local.date)) {
      if (between(14.0, 19.0)) rooms.cooling_C += settings_.strength;
      if (between(10.0, 14.0)) rooms.cooling_C -= ahead_K;
    } else {
      if (between(7.0, 10.0)) rooms.heating_C -= settings_.strength;
      if (between(4.0, 7.0)) rooms.heating_C += ahead_K;
    }
  }

 private:
  static constexpr double kAhead = 0.6;    ///< Cooled in advance by this share of the relaxation.
  static constexpr double kApart_K = 1.8;  ///< Least distance between the set-points.

  [[nodiscard]] static bool summer(metering::Day day) {
    return day.month() >= std::chrono::June && day.month() <= std::chrono::September;
  }
};

}  // namespace

EffectKind tariff_load_shift() {
  return {
      .id = "tariff_load_shift",
      .title = "Load moved out of expensive hours",
      .group = EffectClass::outside_catalogue,
      .sentence =
          "On summer afternoons and winter mornings, when energy is expensive, room temperatures "
          "are relaxed, and rooms are cooled or heated ahead: use moves a few hours forward.",
      .strength = {0.0, 2.0, 4.0, "K by which set-points are relaxed"},
      .needs = {.cooling_meter = true},
      .turns = "set-points by the hour",
      .make = make_effect<TariffLoadShift>};
}

}  // namespace recald::simulators
