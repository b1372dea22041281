#include <algorithm>

#include "simulators/chance/chance.hpp"
#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// Servers that are not in the drawings. Their load hardly depends on day, night or holidays.
class ServerRoom final : public EffectWithSettings {
 public:
  ServerRoom(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        servers_W_(settings.strength * drawings.floor_area_m2()),
        work_(10.0 * kDay_s, kDay_s, settings_.rng) {}

  void plan(metering::Day /*day*/, Timetable& /*timetable*/) override {
    today_ = std::clamp(1.0 + 0.04 * work_.advance(settings_.rng), 0.85, 1.15);
  }

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    operation.rooms.server_W += servers_W_ * today_;
  }

 private:
  double servers_W_;
  Persistence work_;
  double today_ = 1.0;
};

}  // namespace

EffectKind server_room() {
  return {
      .id = "server_room",
      .title = "Unknown server room",
      .group = EffectClass::electrical,
      .sentence =
          "A server room that nobody mentioned runs day and night: electricity is higher at all "
          "hours by the same amount, and so is cooling.",
      .strength = {0.0, 2.0, 8.0, "W/m² of the building's floor"},
      .turns = "servers",
      .make = make_effect<ServerRoom>};
}

}  // namespace recald::simulators
