/// A logger that changes its clock when the building does not, or the reverse.
#include <algorithm>
#include <chrono>
#include <cstddef>

#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/shifted_record.hpp"

namespace recald::diagnosis::effects {
namespace {

using metering::Day;

/// The usual summer time on that side of the Atlantic, for a site whose own clock never changes:
/// the second Sunday of March to the first of November on the western side, the last ones of March
/// and October elsewhere.
bool is_summer_elsewhere(Day date, bool western) {
  using namespace std::chrono;  // NOLINT: calendar literals
  const year y = date.year();
  const Day begin =
      western ? Day{sys_days{y / March / Sunday[2]}} : Day{sys_days{y / March / Sunday[last]}};
  const Day end =
      western ? Day{sys_days{y / November / Sunday[1]}} : Day{sys_days{y / October / Sunday[last]}};
  return date >= begin && date < end;
}

/// In the west, local noon is late in the UTC day.
bool is_western(const DriverHour& hour) {
  const auto utc_hour =
      std::chrono::hh_mm_ss{hour.start.time_since_epoch() -
                            std::chrono::floor<std::chrono::days>(hour.start).time_since_epoch()}
          .hours()
          .count();
  const auto ahead = (hour.local_hour - utc_hour + 36) % 24 - 12;  // -12 ... 11
  return ahead <= -3;
}

/// All meters of a logger share its clock, so `record` does not depend on the meter.
class DstMisapplied final : public Alteration {
 public:
  DstMisapplied(const model::Drivers& drivers, double offset_hours)
      : offset_hours_(offset_hours),
        site_changes_(std::ranges::any_of(drivers.hours, &DriverHour::daylight_saving)),
        western_(!drivers.hours.empty() && is_western(drivers.hours.front())) {}

  void record(std::span<const DriverHour> hours, int /*meter*/,
              std::span<double> power_kW) const override {
    if (hours.empty()) return;
    const std::size_t steps_per_hour = power_kW.size() / hours.size();
    const std::vector<double> shifted = shifted_record(hours, power_kW, offset_hours_);
    for (std::size_t i = 0; i < power_kW.size(); ++i) {
      if (is_summer(hours[i / steps_per_hour])) power_kW[i] = shifted[i];
    }
  }

 private:
  [[nodiscard]] bool is_summer(const DriverHour& hour) const {
    return site_changes_ ? hour.daylight_saving : is_summer_elsewhere(hour.date, western_);
  }

  double offset_hours_;
  bool site_changes_;
  bool western_;
};

}  // namespace

Effect dst_misapplied() {
  return {
      .id = "dst_misapplied",
      .title = "Daylight saving handled wrongly",
      .meaning =
          "From March to November all readings are one hour off: the clocks of the logger and "
          "the building do not agree about daylight saving.",
      .physics =
          "y(t + D) while daylight saving is on, here or, where it never is, in most places "
          "of the continent, all meters; y recorded power in kW, D in h",
      .on_meters =
          "All profiles are one hour off from spring to autumn and right in winter; no energy "
          "is missing.",
      .check =
          "Whether the logger, the meters and the building controls change their clocks on the "
          "same dates.",
      .effect_class = EffectClass::meter,
      .dating = Dating::may_begin,
      .confusable = {{"after_hours",
                      "The start and the end of the day in the week of the clock change: a "
                      "clock moves both."},
                     {"early_start", "The end of the day: an early start does not change it."},
                     {"clock_offset", "Winter weeks, and the other meters of the logger."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {{.name = "summer_offset",
                 .unit = "h",
                 // Only Lord Howe Island has half an hour of summer time.
                 .prior = UniformPrior{.min = -1.5, .max = 1.5},
                 .neutral = 0.0,
                 .scan = {-1.0, 1.0},
                 .choice = true}};
      },
      .bind = [](const SiteFacts& facts, Values values, int) -> Altered {
        return std::make_unique<DstMisapplied>(facts.drivers, values[0]);
      },
  };
}

}  // namespace recald::diagnosis::effects
