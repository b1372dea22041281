#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "daemon/serve/api.hpp"
#include "daemon/serve/parameters.hpp"

namespace recald::daemon {

http::Response post_readings(const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {}); !checked) return checked.error();
  const auto json = nlohmann::json::parse(request.body, nullptr, false);
  const bool names_meter = json.is_object() && json.contains("meter") && json["meter"].is_string();
  if (!names_meter) {
    return http::error_response(
        400, "malformed", R"(the body is no JSON object such as {"meter":"main","readings":[]})",
        "meter");
  }
  const auto meter = meter_of(served.site, json["meter"].get<std::string>());
  if (!meter) return meter.error();
  return http::error_response(
      409, "not_possible",
      fmt::format("meter '{}' has source = \"{}\": its readings come from there and are not taken "
                  "from others",
                  (*meter)->meter.id, (*meter)->live ? "modbus" : "csv"),
      "meter");
}

}  // namespace recald::daemon
