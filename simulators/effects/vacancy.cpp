#include <algorithm>
#include <cmath>
#include <optional>

#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

/// Everyone is sent home within a week, and returns team by team, Monday by Monday.
class Vacancy final : public EffectWithSettings {
 public:
  Vacancy(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings) {
    length_d_ = 7.0 * settings_.rng.uniform(18.0, 40.0);
    empty_share_ = settings_.rng.uniform(0.4, 0.65);
  }

  void plan(metering::Day day, Timetable& timetable) override {
    away_share_ = 0.0;
    if (!settings_.covers(day)) return;
    const std::chrono::sys_days today{day};
    if (!begin_) begin_ = settings_.from ? std::chrono::sys_days{*settings_.from} : today;
    const double length_d =
        settings_.to ? static_cast<double>((std::chrono::sys_days{*settings_.to} - *begin_).count())
                     : length_d_;
    away_share_ = settings_.strength * depth(today, length_d);
    timetable.attendance *= 1.0 - away_share_;
  }

  void operate(const Moment& /*now*/, Operation& operation) override {
    operation.rooms.plugs_factor *= 1.0 - kUnplugged * away_share_;
  }

 private:
  /// Of standing loads as well: people who leave for months pull plugs.
  static constexpr double kUnplugged = 0.12;

  /// 1 while all who can be away are away.
  [[nodiscard]] double depth(std::chrono::sys_days today, double length_d) const {
    const auto since_d = static_cast<double>((today - *begin_).count());
    const auto since_monday =
        std::chrono::weekday{today} - std::chrono::Monday;  // a week's teams return on its Monday
    const double monday_d = since_d - static_cast<double>(since_monday.count());
    const double empty_d = empty_share_ * length_d;
    const double leaving = std::min(1.0, (since_d + 1.0) / 5.0);
    const double returned =
        std::clamp((monday_d - empty_d) / std::max(7.0, length_d - empty_d), 0.0, 1.0);
    return std::min(leaving, 1.0 - returned);
  }

  double length_d_;     ///< From the first day to the last return, unless set in the scenario.
  double empty_share_;  ///< Of the length, before the first team returns.
  std::optional<std::chrono::sys_days> begin_;
  double away_share_ = 0.0;  ///< Today.
};

}  // namespace

EffectKind vacancy() {
  return {.id = "vacancy",
          .title = "Long absence",
          .group = EffectClass::schedules,
          .sentence =
              "From one date most people stay away for months and return little by little: lights "
              "and plugs drop within a week and creep back while the plant runs as usual.",
          .strength = {0.0, 0.85, 1.0, "share of the people who stay away"},
          .turns = "attendance",
          .dated = true,
          .make = make_effect<Vacancy>};
}

}  // namespace recald::simulators
