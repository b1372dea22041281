/// Loads are shed on the hottest afternoons.
#include <algorithm>
#include <utility>
#include <vector>

#include "core/absent.hpp"
#include "core/diagnosis/effects/support/alterations.hpp"

namespace recald::diagnosis::effects {
namespace {

constexpr int kFromHour = 13;
constexpr int kToHour = 18;
constexpr int kReboundToHour = 20;

bool is_afternoon(const DriverHour& hour) {
  return kFromHour <= hour.local_hour && hour.local_hour < kToHour;
}

/// Warmest afternoon hour of each local day, by `DriverHour::day_index`; days without a working
/// afternoon get a very low value, so that no event is called.
std::vector<double> warmest_afternoons_C(const model::Drivers& drivers) {
  constexpr double never_C = -273.15;
  const int days = drivers.hours.empty() ? 0 : drivers.hours.back().day_index + 1;
  std::vector<double> warmest_C(static_cast<std::size_t>(days), never_C);
  for (const DriverHour& hour : drivers.hours) {
    if (hour.day != model::DayType::workday || !is_afternoon(hour)) continue;
    double& day_C = warmest_C[static_cast<std::size_t>(hour.day_index)];
    day_C = std::max(day_C, hour.dry_bulb_C);
  }
  return warmest_C;
}

class DemandLimit final : public Alteration {
 public:
  DemandLimit(double shed, double rebound, double above_C, std::vector<double> warmest_C)
      : shed_(shed), rebound_(rebound), above_C_(above_C), warmest_C_(std::move(warmest_C)) {}

  void operate(const DriverHour& hour, StepOperation& operation) const override {
    const double factor = 1.0 + change(hour);
    operation.lights_W *= factor;
    operation.plugs_W *= factor;
  }

  void supply(const model::Building&, const DriverHour& hour, const StepOperation&,
              StepLoads& loads) const override {
    loads.fans_W *= 1.0 + change(hour);
  }

 private:
  /// Of the load; negative while it is shed.
  double change(const DriverHour& hour) const {
    const bool rebounds = kToHour <= hour.local_hour && hour.local_hour < kReboundToHour;
    if (!rebounds && !is_afternoon(hour)) return 0.0;
    return (rebounds ? rebound_ : -1.0) * shed_ * calling(hour.day_index);
  }

  /// 1 on an event day, 0 on others, in between within half a kelvin of the threshold.
  double calling(int day_index) const {
    const double excess_K = warmest_C_[static_cast<std::size_t>(day_index)] - above_C_;
    return std::clamp(0.5 + excess_K, 0.0, 1.0);
  }

  double shed_;
  double rebound_;
  double above_C_;
  std::vector<double> warmest_C_;
};

/// Temperature below which this share of the days with a working afternoon stays.
double quantile_C(const std::vector<double>& sorted_C, double share) {
  return sorted_C[static_cast<std::size_t>(share * static_cast<double>(sorted_C.size() - 1))];
}

}  // namespace

Effect demand_limit() {
  return {
      .id = "demand_limit",
      .title = "Loads shed on hot afternoons",
      .meaning =
          "On the hottest working days lights, devices and fans are turned down in the "
          "afternoon, and part of the energy is used in the evening instead.",
      .physics =
          "lights, plugs and fans x (1 - a) from 13 to 18 h, x (1 + rho a) from 18 to "
          "20 h, on working days warmer than T_a in the afternoon; a, rho in -, T_a in "
          "degC",
      .on_meters =
          "Electricity falls on the hottest working afternoons and partly comes back in the "
          "evening.",
      .check = "The demand limit in the building controls, and the utility's list of events.",
      .effect_class = EffectClass::electrical,
      .dating = Dating::may_begin,
      .confusable = {{"constant_speed_fans",
                      "The evening after hot days: only shed load rebounds."},
                     {"phase_lost", "A mild afternoon: a lost phase is also missing then."},
                     {"chiller_part_load",
                      "Whether the utility's list of events matches these days."}},
      .parameters = [](const SiteFacts& facts) -> Parameters {
        const double none = kAbsent;
        std::vector<double> days_C = warmest_afternoons_C(facts.drivers);
        std::erase_if(days_C, [](double day_C) { return day_C < -200.0; });
        if (days_C.empty()) days_C = {25.0};
        std::ranges::sort(days_C);
        const double lowest_C = quantile_C(days_C, 0.5);
        return {{.name = "shed_share",
                 .unit = "-",
                 .prior = UniformPrior{.min = 0.0, .max = 0.4},
                 .neutral = 0.0},
                {.name = "rebound",
                 .unit = "-",
                 .prior = UniformPrior{.min = 0.0, .max = 1.0},
                 .neutral = none,
                 .scan = {0.3}},
                {.name = "event_threshold",
                 .unit = "degC",
                 .prior = UniformPrior{.min = lowest_C, .max = days_C.back() + 1.0},
                 .neutral = none,
                 .scan = {quantile_C(days_C, 0.75), quantile_C(days_C, 0.85),
                          quantile_C(days_C, 0.95)}}};
      },
      .bind = [](const SiteFacts& facts, Values values, int) -> Altered {
        return std::make_unique<DemandLimit>(values[0], values[1], values[2],
                                             warmest_afternoons_C(facts.drivers));
      },
  };
}

}  // namespace recald::diagnosis::effects
