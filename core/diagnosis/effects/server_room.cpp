/// Computers that run and are cooled day and night.
#include <algorithm>

#include "core/absent.hpp"
#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {
namespace {

/// Its cooled heat bypasses the rooms and the air handlers. The plug profile comes from the
/// electricity meter, so it may already contain part of the load, as heat in the rooms: that part
/// is subtracted from them here and added again as electricity behind the zones.
class ServerRoom final : public Alteration {
 public:
  ServerRoom(double power_kW, double cooled_share, double share_in_plugs)
      : power_W_(1e3 * power_kW), cooled_share_(cooled_share), share_in_plugs_(share_in_plugs) {}

  void operate(const DriverHour&, StepOperation& operation) const override {
    operation.plugs_W = std::max(operation.plugs_W - share_in_plugs_ * power_W_, 0.0);
    operation.zone_gain_W += (1.0 - cooled_share_) * power_W_;
  }

  void supply(const model::Building&, const DriverHour&, const StepOperation&,
              StepLoads& loads) const override {
    loads.plugs_W += power_W_;
    loads.sensible_cooling_W += cooled_share_ * power_W_;
  }

 private:
  double power_W_;
  double cooled_share_;
  double share_in_plugs_;
};

}  // namespace

Effect server_room() {
  return {
      .id = "server_room",
      .title = "Unlisted server room",
      .meaning =
          "Computers run day and night somewhere in the building. They use electricity and chilled "
          "water even on winter nights, when nothing else needs cooling.",
      .physics =
          "electricity + P, chilled water + c P, heat into rooms + (1 - c) P, plug "
          "profile - m P; P in kW at all hours, c and m in -",
      .on_meters =
          "Electricity and chilled water are higher by the same amount at all hours, on winter "
          "nights too; heat is lower.",
      .check = "Rooms with computers and their own cooling: a clamp meter on the feeder.",
      .effect_class = EffectClass::electrical,
      .dating = Dating::may_begin,
      .confusable = {{"round_the_clock_zone",
                      "Steam on cold nights: a ventilated zone needs it, a server room saves it."},
                     {"constant_flow_pumps",
                      "Chilled water on winter nights: servers need it, pumps do not. A sub-meter "
                      "settles it."},
                     {"equipment_step",
                      "A clamp meter on the room's feeder, and cooling on winter nights."}},
      .parameters = [](const SiteFacts& facts) -> Parameters {
        const double sd_kW = share_of_mean_kW(facts, metering::Utility::electricity, 0.20);
        return {{.name = "power", .unit = "kW", .prior = half_normal(sd_kW), .neutral = 0.0},
                {.name = "cooled_share",
                 .unit = "-",
                 .prior = UniformPrior{0.0, 1.0},
                 .neutral = kAbsent,
                 .scan = {0.0, 0.5, 1.0}},
                either_share("share_in_plugs")};
      },
      .bind = [](const SiteFacts&, Values values, int) -> Altered {
        return std::make_unique<ServerRoom>(values[0], values[1], values[2]);
      },
  };
}

}  // namespace recald::diagnosis::effects
