#include <algorithm>
#include <array>

#include "simulators/chance/chance.hpp"
#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

constexpr std::size_t kPoints = 12;   ///< Charging points, each for at most two cars a day.
constexpr double kMorningUse = 0.75;  ///< Share of working days on which a point is used.
constexpr double kAfternoonUse = 0.5;
constexpr double kWeekendUse = 0.06;
constexpr double kMeanCharge_h = 2.2;

/// Cars charge where people park: some from arrival until full, others after lunch.
class EvCharging final : public EffectWithSettings {
 public:
  EvCharging(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        point_W_(settings.strength * drawings.floor_area_m2() / static_cast<double>(kPoints)) {}

  void plan(metering::Day /*day*/, Timetable& timetable) override {
    const bool workday = timetable.kind == DayKind::workday;
    for (Point& point : points_) {
      point.morning = draw_session(workday ? kMorningUse : kWeekendUse, 8.4, 0.6);
      point.afternoon = draw_session(workday ? kAfternoonUse : kWeekendUse, 13.4, 0.5);
      // The second car waits for the first.
      point.morning.to_h = std::min(point.morning.to_h, 12.5);
      point.afternoon.to_h = std::min(point.afternoon.to_h, 19.0);
    }
  }

  void load(const Moment& now, ServiceLoad& load) override {
    if (!settings_.covers(now.local.date)) return;
    const double step_h = now.step_s / 3600.0;
    double points = 0.0;
    for (const Point& point : points_) {
      points += share_of_step(point.morning, now.hour(), step_h) +
                share_of_step(point.afternoon, now.hour(), step_h);
    }
    load.other_electricity_W += points * point_W_;
  }

 private:
  struct Point {
    RunningHours morning{24.0, 0.0};
    RunningHours afternoon{24.0, 0.0};
  };

  RunningHours draw_session(double use, double arrival_h, double spread_h) {
    const bool taken = settings_.rng.uniform() < use;
    const double from_h = arrival_h + spread_h * settings_.rng.normal();
    const double lasts_h = 0.4 + draw_waiting_time(settings_.rng, kMeanCharge_h - 0.4);
    return taken ? RunningHours{from_h, from_h + lasts_h} : RunningHours{24.0, 0.0};
  }

  [[nodiscard]] static double share_of_step(const RunningHours& session, double hour,
                                            double step_h) {
    const double overlap_h = std::min(session.to_h, hour + step_h) - std::max(session.from_h, hour);
    return std::max(0.0, overlap_h) / step_h;
  }

  double point_W_;
  std::array<Point, kPoints> points_{};
};

}  // namespace

EffectKind ev_charging() {
  return {.id = "ev_charging",
          .title = "Cars charge in the car park",
          .group = EffectClass::outside_catalogue,
          .sentence =
              "Cars charge on working days from the morning on and again after lunch: electricity "
              "has two humps that follow neither the weather nor the rooms.",
          .strength = {0.0, 6.0, 20.0, "W/m² of the building's floor, all points in use"},
          .turns = "car chargers",
          .make = make_effect<EvCharging>};
}

}  // namespace recald::simulators
