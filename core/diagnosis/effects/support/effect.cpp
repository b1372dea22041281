#include "core/diagnosis/effects/support/effect.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace recald::diagnosis {
namespace {

using metering::Utility;
using model::hourly::Alteration;
using model::hourly::StepLoads;
using model::hourly::StepOperation;

bool is_heat(Utility utility) {
  return utility == Utility::heating || utility == Utility::steam || utility == Utility::gas;
}

class WithinDates final : public Alteration {
 public:
  WithinDates(std::unique_ptr<Alteration> inner, double from_day, double to_day)
      : inner_(std::move(inner)), from_day_(from_day), to_day_(to_day) {}

  void rebuild(model::Building& building) const override { inner_->rebuild(building); }
  [[nodiscard]] model::hourly::DayRange rebuilt() const override { return {from_day_, to_day_}; }

  void operate(const model::DriverHour& hour, StepOperation& operation) const override {
    if (contains(hour)) inner_->operate(hour, operation);
  }

  void supply(const model::Building& building, const model::DriverHour& hour,
              const StepOperation& operation, StepLoads& loads) const override {
    if (contains(hour)) inner_->supply(building, hour, operation, loads);
  }

  /// The inner effect sees only the hours between the dates.
  void record(std::span<const model::DriverHour> hours, int meter,
              std::span<double> power_kW) const override {
    if (hours.empty()) return;
    assert(power_kW.size() % hours.size() == 0);
    const std::size_t steps_per_hour = power_kW.size() / hours.size();
    const std::size_t from = first_at(hours, from_day_);
    const std::size_t to = first_at(hours, to_day_);
    if (from >= to) return;
    inner_->record(hours.subspan(from, to - from), meter,
                   power_kW.subspan(from * steps_per_hour, (to - from) * steps_per_hour));
  }

 private:
  bool contains(const model::DriverHour& hour) const {
    const double day = model::elapsed_days(hour);
    return from_day_ <= day && day < to_day_;
  }

  static std::size_t first_at(std::span<const model::DriverHour> hours, double day) {
    const auto found = std::ranges::lower_bound(hours, day, {}, model::elapsed_days);
    return static_cast<std::size_t>(found - hours.begin());
  }

  std::unique_ptr<Alteration> inner_;
  double from_day_;
  double to_day_;
};

}  // namespace

std::string_view to_string(EffectClass effect_class) {
  switch (effect_class) {
    case EffectClass::schedule:
      return "schedule";
    case EffectClass::outdoor_air:
      return "outdoor_air";
    case EffectClass::air_system:
      return "air_system";
    case EffectClass::envelope:
      return "envelope";
    case EffectClass::plant:
      return "plant";
    case EffectClass::electrical:
      return "electrical";
    case EffectClass::meter:
      return "meter";
  }
  return "unknown";
}

double SiteFacts::mean_of_kW(Utility utility) const {
  assert(utilities.size() == mean_kW.size());
  for (std::size_t i = 0; i < utilities.size(); ++i) {
    if (utilities[i] == utility || (is_heat(utilities[i]) && is_heat(utility))) return mean_kW[i];
  }
  return 0.0;
}

const Effect* find_effect(std::string_view id) {
  const std::span<const Effect> all = catalogue();
  const auto found = std::ranges::lower_bound(all, id, {}, &Effect::id);
  return found != all.end() && found->id == id ? &*found : nullptr;
}

std::unique_ptr<Alteration> within_dates(std::unique_ptr<Alteration> inner, double from_day,
                                         double to_day) {
  return std::make_unique<WithinDates>(std::move(inner), from_day, to_day);
}

}  // namespace recald::diagnosis
