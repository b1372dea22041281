#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "daemon/gateway/ingest/plausible_time.hpp"
#include "daemon/gateway/serve/api.hpp"
#include "daemon/gateway/serve/json_answer.hpp"
#include "daemon/gateway/serve/parameters.hpp"
#include "daemon/gateway/serve/pushed_readings.hpp"

namespace recald::daemon {

http::Response post_readings(const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {}); !checked) return checked.error();
  if (!is_plausible_time(served.now())) {
    return http::error_response(503, "clock_not_set",
                                "the clock here has not been set yet, send it again later");
  }
  auto pushed = parse_pushed(request.body, served.site, served.now());
  if (!pushed) return pushed.error();
  const std::string& id = pushed->meter->meter.id;
  if (!served.take_readings) {
    return http::error_response(
        409, "not_possible", fmt::format("no readings of meter '{}' are taken here", id), "meter");
  }
  const auto counts = served.take_readings(id, std::move(pushed->readings));
  if (!counts) {
    return http::error_response(503, "store_unavailable",
                                "nothing was stored, send it again: " + counts.error().message);
  }
  auto conflicts = nlohmann::ordered_json::array();
  for (const metering::Reading& reading : counts->conflicts) {
    conflicts.push_back(metering::to_string(reading.start));
  }
  return json_answer({{"meter", id},
                      {"stored", counts->taken},
                      {"known", counts->duplicates},
                      {"weaker", counts->weaker},
                      {"conflicts", conflicts}});
}

}  // namespace recald::daemon
