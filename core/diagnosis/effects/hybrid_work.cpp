/// Occupancy differs between the weekdays.
#include <array>

#include "core/diagnosis/effect.hpp"
#include "core/diagnosis/effects/support/presence.hpp"

namespace recald::diagnosis::effects {
namespace {

/// The meter's profile is the mean of all workdays, so the changes of a week sum to zero.
class HybridWork final : public model::hourly::Alteration {
 public:
  HybridWork(const model::Drivers& drivers, double midweek, double monday_over_friday)
      : standby_(drivers), change_{0.0,     -1.5 * midweek + monday_over_friday, midweek, midweek,
                                   midweek, -1.5 * midweek - monday_over_friday, 0.0} {}

  void operate(const model::DriverHour& hour, model::hourly::StepOperation& op) const override {
    if (hour.day != model::DayType::workday) return;
    change_presence(change_[hour.weekday], standby_, hour, op);
  }

 private:
  StandbyLoads standby_;
  std::array<double, 7> change_;  // Sunday first.
};

/// The widths give each single weekday a standard deviation of 0.10…0.18, around the catalogue's
/// 0.15; the bounds keep the number of people from becoming negative.
std::vector<EffectParameter> parameters(const SiteFacts&) {
  const TruncatedNormalPrior prior{.location = 0.0, .sd = 0.10, .min = -0.4, .max = 0.4};
  return {{.name = "midweek", .unit = "share of mean presence", .prior = prior, .neutral = 0.0},
          {.name = "monday_over_friday",
           .unit = "share of mean presence",
           .prior = prior,
           .neutral = 0.0}};
}

std::unique_ptr<model::hourly::Alteration> bind(const SiteFacts& facts,
                                                std::span<const double> values, int) {
  return std::make_unique<HybridWork>(facts.drivers, values[0], values[1]);
}

}  // namespace

Effect hybrid_work();

Effect hybrid_work() {
  return {
      .id = "hybrid_work",
      .title = "Presence depends on the weekday",
      .meaning =
          "More people come on some weekdays than on others, mostly Tuesday to Thursday; in the "
          "model all workdays are the same.",
      .physics =
          "people [–] ×(1+c_d), lights and plugs above their least of the month [W] "
          "×(1+0.8c_d); c_Tue…Thu = c, c_Mon = −1.5c+m, c_Fri = −1.5c−m; c, m [–]",
      .effect_class = EffectClass::schedule,
      .dating = Dating::may_begin,
      .confusable =
          {{"weekend_operation",
            "Saturdays and Sundays: presence on weekdays does not change them."},
           {"demand_ventilation",
            "Compare counts of badges, Wi-Fi clients or lift rides by weekday with the air flow."},
           {"missing_holidays",
            "Whether single dates or every Monday and Friday stand out in the daily values."}},
      .parameters = parameters,
      .bind = bind,
  };
}

}  // namespace recald::diagnosis::effects
