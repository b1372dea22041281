#include <cmath>

#include "simulators/chance/chance.hpp"
#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

constexpr double kDaysPerYear = 365.25;
constexpr double kBatchShare = 0.3;  ///< Of purchases: made all at once instead of one by one.
constexpr double kBatchEvery_days = 15.0;

/// Screens, computers, instruments: each year somewhat more than the year before, or less.
class PlugGrowth final : public EffectWithSettings {
 public:
  using EffectWithSettings::EffectWithSettings;

  void plan(metering::Day day, Timetable& /*timetable*/) override {
    const bool batch = settings_.rng.uniform() < 1.0 / kBatchEvery_days;
    const double batch_days = kBatchEvery_days * draw_waiting_time(settings_.rng, 1.0);
    if (!settings_.covers(day)) return;
    const double days = 1.0 - kBatchShare + (batch ? kBatchShare * batch_days : 0.0);
    grown_years_ += days / kDaysPerYear;
  }

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    operation.rooms.plugs_factor *= std::pow(1.0 + settings_.strength, grown_years_);
  }

 private:
  double grown_years_ = 0.0;
};

}  // namespace

EffectKind plug_growth() {
  return {.id = "plug_growth",
          .title = "Plug loads grow or shrink",
          .group = EffectClass::electrical,
          .sentence =
              "Plugged-in equipment becomes more from year to year, or less: electricity drifts, "
              "nights and weekends included, and rooms get a little warmer or cooler with it.",
          .strength = {-0.25, 0.12, 0.4, "share a year, negative for shrinking"},
          .turns = "plugs",
          .make = make_effect<PlugGrowth>};
}

}  // namespace recald::simulators
