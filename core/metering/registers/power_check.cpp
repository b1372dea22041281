#include "core/metering/registers/power_check.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace recald::metering {
namespace {

Reading as_frozen(Reading reading) {
  reading.validity = Validity::suspect;
  reading.reasons |= Reason::stuck;
  return reading;
}

void watch_standing(PowerCheck& check, const Reading& counted, double powered_kWh,
                    const PowerCheckRules& rules, PowerVerdict& verdict) {
  check.standing.push_back(counted);
  check.standing_kWh += powered_kWh;
  const bool is_long_enough =
      check.standing.size() >= static_cast<std::size_t>(rules.standing_intervals);
  if (!is_long_enough || check.standing_kWh <= 2.0 * rules.resolution_kWh) return;
  for (const Reading& reading : check.standing) {
    if (reading.validity == Validity::ok) verdict.frozen.push_back(as_frozen(reading));
  }
  verdict.has_frozen_now = verdict.frozen.size() > 1;
  // These are reported together; those that follow are reported one by one.
  for (Reading& reading : check.standing) reading.validity = Validity::suspect;
}

void compare(PowerCheck& check, const PowerCheckRules& rules, PowerVerdict& verdict) {
  if (check.compared < rules.compared_intervals) return;
  const double difference_kWh = std::abs(check.powered_kWh - check.counted_kWh);
  const double larger_kWh = std::max(check.powered_kWh, check.counted_kWh);
  const bool differs = difference_kWh > rules.difference_share * larger_kWh &&
                       difference_kWh > 2.0 * rules.resolution_kWh;
  if (differs && check.counted_kWh > 0.0 && check.powered_kWh > 0.0) {
    verdict.power_to_counter = check.powered_kWh / check.counted_kWh;
  }
  check.compared = 0;
  check.counted_kWh = 0.0;
  check.powered_kWh = 0.0;
}

}  // namespace

PowerVerdict check_power(PowerCheck& check, const Reading& counted, const Reading& powered,
                         std::chrono::seconds interval, const PowerCheckRules& rules) {
  assert(counted.start == powered.start);
  PowerVerdict verdict;
  const double hours = static_cast<double>(interval.count()) / 3600.0;
  const bool both = counted.validity == Validity::ok && powered.validity == Validity::ok &&
                    powered.mean_kW >= 0.0;
  const bool is_standing =
      both && counted.mean_kW == 0.0 && powered.mean_kW > rules.load_share * rules.rated_kW;
  if (is_standing) {
    watch_standing(check, counted, powered.mean_kW * hours, rules, verdict);
  } else {
    check.standing.clear();
    check.standing_kWh = 0.0;
  }
  if (!both) return verdict;
  ++check.compared;
  check.counted_kWh += std::abs(counted.mean_kW) * hours;
  check.powered_kWh += powered.mean_kW * hours;
  compare(check, rules, verdict);
  return verdict;
}

}  // namespace recald::metering
