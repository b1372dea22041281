#include "core/metering/civil_time.hpp"
#include "simulators/effects/effect_kind.hpp"

namespace recald::simulators {
namespace {

constexpr unsigned kNightsBefore = 3;  ///< The last nights of a month.
constexpr unsigned kNightsAfter = 2;   ///< The first ones of the next.

/// At the turn of the month the servers compute all night: month-end accounts, full backups.
class DataBackupNights final : public EffectWithSettings {
 public:
  DataBackupNights(const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings),
        jobs_W_(settings.strength * drawings.floor_area_m2()) {}

  void plan(metering::Day day, Timetable& /*timetable*/) override {
    last_night_ = tonight_;
    tonight_.from_h = settings_.rng.uniform(19.5, 22.0);
    tonight_.to_h = tonight_.from_h + settings_.rng.uniform(5.0, 11.0);
    tonight_.intensity = settings_.rng.uniform(0.75, 1.1);
    if (!at_turn_of_month(day)) tonight_.intensity = 0.0;
  }

  void operate(const Moment& now, Operation& operation) override {
    if (!settings_.covers(now.local.date)) return;
    const double share = tonight_.at(now.hour()) + last_night_.at(now.hour() + 24.0);
    operation.rooms.server_W += jobs_W_ * share;
  }

 private:
  /// Hours count from the previous midnight and may exceed 24.
  struct Night {
    double from_h = 24.0;
    double to_h = 24.0;
    double intensity = 0.0;  ///< 0: no jobs.

    [[nodiscard]] double at(double hour) const {
      return hour >= from_h && hour < to_h ? intensity : 0.0;
    }
  };

  [[nodiscard]] static bool at_turn_of_month(metering::Day day) {
    const auto month_days = static_cast<unsigned>(metering::days_in(day.year() / day.month()));
    const auto date = static_cast<unsigned>(day.day());
    return date <= kNightsAfter || date > month_days - kNightsBefore;
  }

  double jobs_W_;
  Night tonight_;
  Night last_night_;
};

}  // namespace

EffectKind data_backup_nights() {
  return {.id = "data_backup_nights",
          .title = "Servers compute at the turn of the month",
          .group = EffectClass::outside_catalogue,
          .sentence =
              "In the last and first nights of a month servers compute until the morning: "
              "electricity, and cooling with it, is high in nights when nobody is there.",
          .strength = {0.0, 8.0, 20.0, "W/m² of the building's floor"},
          .turns = "night jobs of servers",
          .make = make_effect<DataBackupNights>};
}

}  // namespace recald::simulators
