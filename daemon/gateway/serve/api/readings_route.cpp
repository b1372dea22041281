#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/metering/months/validation.hpp"
#include "core/text/number_text.hpp"
#include "daemon/gateway/serve/api/api.hpp"
#include "daemon/gateway/serve/api/json_answer.hpp"
#include "daemon/gateway/serve/api/parameters.hpp"
#include "daemon/gateway/serve/api/pushed_readings.hpp"

namespace recald::daemon {
namespace {

std::string why_doubted(const metering::Reading& reading, const metering::Meter& meter,
                        const metering::ValidationOptions& options) {
  const std::string value_kW = number_text(reading.mean_kW, 6);
  if (metering::has(reading.reasons, metering::Reason::negative)) {
    return fmt::format(
        "{} kW is negative, but the meter does not have negative_is_valid = true; check the sign",
        value_kW);
  }
  return fmt::format("{} kW is more than {} times rated_kW = {}; check the unit, or rated_kW",
                     value_kW, options.range_factor, *meter.rated_kW);
}

nlohmann::ordered_json suspect_json(const PushedReadings& pushed,
                                    const metering::ValidationOptions& options) {
  auto suspect = nlohmann::ordered_json::array();
  for (const metering::Reading& reading : pushed.readings) {
    if (reading.validity != metering::Validity::suspect) continue;
    const std::string why = pushed.quantity != nullptr
                                ? weather::why_not_plausible(*pushed.quantity, reading.mean_kW) +
                                      "; check the unit, and the sensor"
                                : why_doubted(reading, pushed.meter->meter, options);
    suspect.push_back({{"start", metering::to_string(reading.start)}, {"why", why}});
  }
  return suspect;
}

}  // namespace

http::Response post_readings(const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {}); !checked) return checked.error();
  if (!served.no_store.empty()) {
    return not_taken("nothing was stored, send the readings again: the store cannot be opened: " +
                     served.no_store);
  }
  if (const std::string doubt = served.clock_doubt ? served.clock_doubt() : ""; !doubt.empty()) {
    return http::error_response(
        503, "clock_not_set",
        fmt::format("the daemon's clock is not set: {}; send the readings again later", doubt));
  }
  auto pushed = parse_pushed(request.body, served.site, served.now());
  if (!pushed) return pushed.error();
  const std::string& id = pushed->meter->meter.id;
  const bool has_counter = pushed->meter->counter.has_value();
  if (has_counter ? !served.take_samples : !served.take_readings) {
    return http::error_response(
        409, "not_possible", fmt::format("this daemon does not accept readings of meter '{}'", id),
        "meter");
  }
  const auto suspect = suspect_json(*pushed, served.site.closing.closing.validation);
  const auto counts = has_counter
                          ? served.take_samples(id, std::move(pushed->samples))
                          : served.take_readings(pushed->stored_id(), std::move(pushed->readings),
                                                 pushed->correction);
  if (!counts) {
    return not_taken("nothing was stored, send the readings again: " + counts.error().message);
  }
  auto conflicts = nlohmann::ordered_json::array();
  for (const metering::Reading& reading : counts->conflicts) {
    conflicts.push_back(metering::to_string(reading.start));
  }
  nlohmann::ordered_json answer{{"meter", id},
                                {"stored", counts->taken},
                                {"known", counts->duplicates},
                                {"weaker", counts->weaker},
                                {"conflicts", conflicts},
                                {"suspect", suspect}};
  if (!counts->doubt.empty()) answer["doubt"] = counts->doubt;
  return json_answer(std::move(answer));
}

}  // namespace recald::daemon
