/// Pumps run at full speed whether water is needed or not.
#include <algorithm>
#include <array>
#include <functional>
#include <limits>

#include "core/diagnosis/effects/support/alterations.hpp"
#include "core/diagnosis/effects/support/priors.hpp"

namespace recald::diagnosis::effects {
namespace {

/// Which calendar months have their plant enabled.
using Months = std::array<bool, 12>;

std::size_t calendar_month(const DriverHour& hour) {
  return static_cast<unsigned>(hour.date.month()) - 1;
}

/// Months warmer than the midpoint between the warmest and the coldest month of the drivers; only
/// months that the drivers have.
Months warm_months(const model::Drivers& drivers) {
  std::array<double, 12> mean_C{};
  std::array<int, 12> hours{};
  for (const DriverHour& hour : drivers.hours) {
    mean_C[calendar_month(hour)] += hour.dry_bulb_C;
    ++hours[calendar_month(hour)];
  }
  double coldest_C = std::numeric_limits<double>::infinity();
  double warmest_C = -coldest_C;
  for (std::size_t m = 0; m < 12; ++m) {
    if (hours[m] == 0) continue;
    mean_C[m] /= hours[m];
    coldest_C = std::min(coldest_C, mean_C[m]);
    warmest_C = std::max(warmest_C, mean_C[m]);
  }
  Months warm{};
  for (std::size_t m = 0; m < 12; ++m) {
    warm[m] = hours[m] > 0 && mean_C[m] > 0.5 * (coldest_C + warmest_C);
  }
  return warm;
}

/// @param season  1: all year, 2: warm months (chilled water), 3: the others (hot water).
Months enabled_months(const model::Drivers& drivers, double season) {
  Months enabled;
  enabled.fill(true);
  if (season < 1.5) return enabled;
  enabled = warm_months(drivers);
  if (season >= 2.5) std::ranges::transform(enabled, enabled.begin(), std::logical_not{});
  return enabled;
}

/// Mean of the electricity meter; 10 W/m² if there is none.
double pump_reference_kW(const SiteFacts& facts) {
  const double electricity_kW = facts.mean_of_kW(metering::Utility::electricity);
  return electricity_kW > 0.0 ? electricity_kW : 0.01 * facts.building.floor_area_m2;
}

}  // namespace

Effect constant_flow_pumps() {
  return {
      .id = "constant_flow_pumps",
      .title = "Pumps at constant flow",
      .meaning =
          "Chilled-water or hot-water pumps run at full speed day and night, through a season or "
          "all year, even when no heating or cooling is needed.",
      .physics =
          "P_pumps [kW] += P_p·plant(t); plant: 1 in all, the warm or the cold months, else "
          "0; P_p [kW] ≥ 0",
      .on_meters =
          "Electricity is higher by the same amount at all hours of a season; heat and chilled "
          "water stay the same.",
      .check =
          "The pumps' drives and valves: whether pumps run when nothing calls for heat or cooling.",
      .effect_class = EffectClass::air_system,
      .dating = Dating::may_begin,
      .confusable =
          {{"server_room",
            "Chilled water on winter nights: servers need it, pumps leave it unchanged."},
           {"round_the_clock_zone",
            "Whether chilled water and heat rise with the night electricity: with pumps they do "
            "not."},
           {"constant_speed_fans",
            "Hours with the fans off: pumps keep running. A clamp meter on the pump panel settles "
            "it."},
           {"equipment_step",
            "Whether the dates of the steps match the dates when the control system's log shows "
            "the plant enabled."}},
      .parameters = [](const SiteFacts& facts) -> Parameters {
        return {{.name = "extra_power",
                 .unit = "kW",
                 .prior = half_normal(0.05 * pump_reference_kW(facts)),
                 .neutral = 0.0},
                one_of_three("season", "1: all year, 2: warm months, 3: cold months")};
      },
      // Leaves out the heat of the pumps in the water, a few per cent of their power.
      .bind =
          [](const SiteFacts& facts, Values values, int) {
            return supplying([enabled = enabled_months(facts.drivers, values[1]),
                              extra_kW = values[0]](const model::Building&, const DriverHour& hour,
                                                    const StepOperation&, StepLoads& loads) {
              if (enabled[calendar_month(hour)]) loads.pumps_W += 1000.0 * extra_kW;
            });
          },
  };
}

}  // namespace recald::diagnosis::effects
