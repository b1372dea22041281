/// People work at home, on some weekdays more than on others.
#include <algorithm>
#include <array>

#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/presence.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {
namespace {

/// People at home on average, and how that differs between the days of a week.
class HybridWork final : public Alteration {
 public:
  HybridWork(const model::Drivers& drivers, double at_home, double midweek,
             double monday_over_friday)
      : standby_(drivers) {
    change_.fill(-at_home);  // Sunday first.
    for (const std::size_t day : {2, 3, 4}) change_[day] += midweek;
    change_[1] += -1.5 * midweek + monday_over_friday;
    change_[5] += -1.5 * midweek - monday_over_friday;
    for (double& change : change_) change = std::max(change, -1.0);
  }

  void operate(const DriverHour& hour, StepOperation& op) const override {
    if (hour.day != model::DayType::workday) return;
    change_presence(change_[hour.weekday], standby_, hour, op);
  }

 private:
  StandbyLoads standby_;
  std::array<double, 7> change_;
};

}  // namespace

Effect hybrid_work() {
  return {
      .id = "hybrid_work",
      .title = "People work at home on some days",
      .meaning =
          "Some people work at home, on some weekdays more than on others, mostly on Mondays and "
          "Fridays; in the model all workdays are the same.",
      .physics =
          "people [–] ×(1+c_d), lights and plugs above their least of the month [W] "
          "×(1+0.8c_d); c_Tue…Thu = c−h, c_Mon = −1.5c+m−h, c_Fri = −1.5c−m−h; c, h, m [–]",
      .on_meters =
          "Electricity is lower on some weekdays, mostly Mondays and Fridays; cooling is a little "
          "lower too.",
      .check = "Counts of badges, Wi-Fi clients or lift rides by weekday.",
      .effect_class = EffectClass::schedule,
      .dating = Dating::may_begin,
      .confusable =
          {{"vacancy", "Badge or lift counts by weekday: an absence empties all days alike."},
           {"weekend_operation",
            "Saturdays and Sundays: presence on weekdays does not change them."},
           {"demand_ventilation",
            "Compare counts of badges, Wi-Fi clients or lift rides by weekday with the air flow."},
           {"missing_holidays",
            "Whether single dates or every Monday and Friday stand out in the daily values."}},
      // Where it has always been so, the mean is in the profile of the electricity meter, and the
      // days alone tell.
      .parameters = [](const SiteFacts&) -> Parameters {
        const auto difference = [](double sd) {
          return TruncatedNormalPrior{.location = 0.0, .sd = sd, .min = -0.4, .max = 0.4};
        };
        constexpr const char* kUnit = "share of mean presence";
        return {{.name = "at_home",
                 .unit = kUnit,
                 .prior = half_normal_below(0.25, 0.8),
                 .neutral = 0.0},
                {.name = "midweek", .unit = kUnit, .prior = difference(0.10), .neutral = 0.0},
                {.name = "monday_over_friday",
                 .unit = kUnit,
                 .prior = difference(0.07),
                 .neutral = 0.0}};
      },
      .bind = [](const SiteFacts& facts, Values values, int) -> Altered {
        return std::make_unique<HybridWork>(facts.drivers, values[0], values[1], values[2]);
      },
  };
}

}  // namespace recald::diagnosis::effects
