/// A meter whose clock is wrong, or whose time zone was misinterpreted.
#include <algorithm>

#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/shifted_record.hpp"

namespace recald::diagnosis::effects {

Effect clock_offset() {
  return {
      .id = "clock_offset",
      .title = "Meter's clock is wrong",
      .meaning =
          "Everything this meter shows happened earlier or later than its time stamps say: the "
          "clock or time zone is wrong, or the stamps mark the end of the interval.",
      .physics = "y(t + D); y recorded power in kW, D in h, between intervals linear",
      .on_meters =
          "The profile of one meter is moved by the same time on all days; its energy stays the "
          "same.",
      .check =
          "The clock and the time zone of this meter and its logger, and whether its stamps mark "
          "starts or ends.",
      .effect_class = EffectClass::meter,
      .dating = Dating::may_begin,
      .of_one_meter = true,
      .confusable = {{"early_start",
                      "The other meters: a schedule moves them all, a wrong clock only this one."},
                     {"after_hours", "The other meters, and the meter's own display of time."},
                     {"dst_misapplied", "Winter weeks: a wrong clock is also wrong then."}},
      .parameters = [](const SiteFacts&) -> Parameters {
        return {
            {.name = "offset",
             .unit = "h",
             .prior = TruncatedNormalPrior{.location = 0.0, .sd = 3.0, .min = -12.0, .max = 12.0},
             .neutral = 0.0,
             // Interval labels, daylight saving, and the time zones of both sides of the Atlantic.
             .scan = {-12.0, -8.0, -7.0, -6.0, -5.0, -4.0, -3.0, -2.0, -1.0, -0.5, -0.25,
                      0.25,  0.5,  1.0,  2.0,  3.0,  4.0,  5.0,  6.0,  7.0,  8.0,  12.0}}};
      },
      .bind =
          [](const SiteFacts&, Values values, int meter) {
            return recording(meter, [offset_hours = values[0]](std::span<const DriverHour> hours,
                                                               std::span<double> power_kW) {
              std::ranges::copy(shifted_record(hours, power_kW, offset_hours), power_kW.begin());
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
