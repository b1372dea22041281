#include <algorithm>
#include <chrono>
#include <optional>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/effects/yearly_wave.hpp"

namespace recald::simulators {
namespace {

constexpr double kColdestDay = 20.0;
constexpr double kMissedYears = 0.25;  ///< Share of years in which nobody cleans.
constexpr double kDirtMax = 1.6;       ///< Beyond this, water still flows.

/// Scale and slime in the condenser, from one yearly cleaning to the next; some
/// cleanings are forgotten.
class Fouling final : public EffectWithSettings {
 public:
  Fouling(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings), latitude_deg_(drawings.place.latitude_deg) {
    dirt_ = settings_.rng.uniform(0.2, 0.8);
  }

  void plan(metering::Day day, Timetable& /*timetable*/) override {
    if (day.year() != year_) plan_year(day.year());
    // Fouling grows faster in warm water.
    const double growth = 1.0 + 0.6 * yearly_wave(day, kColdestDay, latitude_deg_);
    dirt_ = day == cleaning_ ? 0.0 : std::min(kDirtMax, dirt_ + growth / 365.0);
  }

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    operation.plant.chiller_cop_factor /= 1.0 + settings_.strength * dirt_;
  }

 private:
  /// Before the cooling season, when the contractor has time.
  void plan_year(std::chrono::year year) {
    year_ = year;
    const auto late_days = static_cast<int>(settings_.rng.below(75));
    const bool missed = settings_.rng.uniform() < kMissedYears;
    const std::chrono::month first = latitude_deg_ < 0.0 ? std::chrono::August : std::chrono::March;
    const std::chrono::sys_days date{year / first / 1};
    cleaning_.reset();
    if (!missed) cleaning_ = date + std::chrono::days{late_days};
  }

  double latitude_deg_;
  double dirt_;  ///< 0: just cleaned; 1: a year later.
  std::chrono::year year_ = std::chrono::year::min();
  std::optional<metering::Day> cleaning_;  ///< Of `year_`.
};

}  // namespace

EffectKind fouling() {
  return {
      .id = "fouling",
      .title = "Dirty condenser",
      .group = EffectClass::plant,
      .sentence =
          "The chiller's condenser gets dirtier until someone cleans it: the same cooling takes "
          "more electricity from month to month and suddenly less after cleaning.",
      .strength = {0.0, 0.5, 1.2, "share more electricity of the chiller a year after cleaning"},
      .needs = {.own_chiller = true},
      .turns = "chiller efficiency",
      .make = make_effect<Fouling>};
}

}  // namespace recald::simulators
