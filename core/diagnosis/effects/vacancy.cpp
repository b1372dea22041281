/// One long absence of the people.
#include "core/diagnosis/effect.hpp"
#include "core/diagnosis/effects/support/presence.hpp"

namespace recald::diagnosis::effects {
namespace {

/// The plant keeps its timetable, as mostly in 2020; the wrapper adds the window.
class Vacancy final : public model::hourly::Alteration {
 public:
  Vacancy(const model::Drivers& drivers, double absent_share)
      : standby_(drivers), absent_share_(absent_share) {}

  void operate(const model::DriverHour& hour, model::hourly::StepOperation& op) const override {
    change_presence(-absent_share_, standby_, hour, op);
  }

 private:
  StandbyLoads standby_;
  double absent_share_;
};

std::vector<EffectParameter> parameters_of_vacancy(const SiteFacts&) {
  return {{.name = "absent_share",
           .unit = "share of the people",
           .prior = UniformPrior{0.0, 1.0},
           .neutral = 0.0}};
}

std::unique_ptr<model::hourly::Alteration> bind_vacancy(const SiteFacts& facts,
                                                        std::span<const double> values, int) {
  return std::make_unique<Vacancy>(facts.drivers, values[0]);
}

}  // namespace

Effect vacancy();

Effect vacancy() {
  return {
      .id = "vacancy",
      .title = "Vacancy",
      .meaning =
          "For some weeks or months much of the building was empty, but the plant kept running.",
      .physics =
          "from t_1 to t_2: people [–] ×(1−a), lights and plugs above their least of the "
          "month [W] ×(1−0.8a); a [–] 0…1",
      .on_meters =
          "Electricity in working hours is lower for some weeks or months, nights stay the same, "
          "heat is higher in winter.",
      .check = "Who moved out and in at those dates, by badges, lift rides or leases.",
      .effect_class = EffectClass::schedule,
      .dating = Dating::window,
      .confusable = {{"equipment_step",
                      "Nights: removed equipment is also missing at night, missing people only "
                      "change working hours. And people come back."},
                     {"semester_calendar",
                      "The second year: term breaks return on the same dates."},
                     {"phase_lost",
                      "Chilled water: a lost phase of the electricity meter does not show there."},
                     {"missing_holidays", "The length: single days or many weeks."}},
      .parameters = parameters_of_vacancy,
      .bind = bind_vacancy,
  };
}

}  // namespace recald::diagnosis::effects
