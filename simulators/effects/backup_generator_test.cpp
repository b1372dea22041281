#include <algorithm>
#include <chrono>
#include <optional>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// Once a month the building runs on its own generator for some hours. The load on it disappears
/// from the meter; the generator burns oil that is not metered.
class BackupGeneratorTest final : public EffectWithSettings {
 public:
  BackupGeneratorTest(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings), carried_share_(settings_.rng.uniform(0.8, 0.97)) {}

  void plan(metering::Day day, Timetable& timetable) override {
    const std::chrono::year_month month = day.year() / day.month();
    if (month != month_) plan_month(month);
    runs_today_ = due_ && day >= *due_ && timetable.kind == DayKind::workday;
    if (runs_today_) due_.reset();
  }

  void supply(const Moment& now, UtilityPower& power) override {
    if (!runs_today_ || !settings_.covers(now.local.date)) return;
    const double step_h = now.step_s / 3600.0;
    const double end_h = std::min(now.hour() + step_h, start_h_ + settings_.strength);
    const double overlap_h = std::max(0.0, end_h - std::max(now.hour(), start_h_));
    power.electricity_kW *= 1.0 - carried_share_ * overlap_h / step_h;
  }

 private:
  void plan_month(std::chrono::year_month month) {
    month_ = month;
    due_ = month / std::chrono::day{2 + static_cast<unsigned>(settings_.rng.below(22))};
    start_h_ = settings_.rng.uniform(6.0, 10.0);
  }

  double carried_share_;  ///< Of the building's electricity.
  std::chrono::year_month month_{};
  std::optional<metering::Day> due_;  ///< The test of `month_`, on the first working day from then.
  double start_h_ = 0.0;
  bool runs_today_ = false;
};

}  // namespace

EffectKind backup_generator_test() {
  return {.id = "backup_generator_test",
          .title = "Monthly run of the backup generator",
          .group = EffectClass::outside_catalogue,
          .sentence =
              "Once a month the backup generator carries the building for some hours: the "
              "electricity meter falls nearly to zero although everybody works.",
          .strength = {0.0, 4.0, 12.0, "hours"},
          .turns = "generator",
          .make = make_effect<BackupGeneratorTest>};
}

}  // namespace recald::simulators
