#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "daemon/gateway/serve/api/api.hpp"
#include "daemon/gateway/serve/api/json_answer.hpp"
#include "daemon/gateway/serve/api/parameters.hpp"
#include "daemon/gateway/serve/api/shapes.hpp"
#include "daemon/version.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

http::Response get_sites(const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {}); !checked) return checked.error();
  const Json site = {{"id", served.site.id},
                     {"name", served.site.name},
                     {"timezone", served.site.timezone},
                     {"interval_s", served.site.interval.count()},
                     {"meters", served.site.meters.size()},
                     {"weather_sensors", served.site.sensors.size()},
                     {"version", kVersion},
                     {"started_at", metering::to_string(served.started)},
                     {"now", metering::to_string(served.now())}};
  return json_answer({{"sites", Json::array({site})}, {"next", nullptr}});
}

http::Response get_meters(const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {}); !checked) return checked.error();
  std::map<std::string, MeterStatus> known;
  GatewayStatus all = served.status();
  for (MeterStatus& status : all.meters) known.emplace(status.id, std::move(status));
  Json meters = Json::array();
  for (const auto* const list : {&served.site.meters, &served.site.sensors}) {
    for (const MeterConfig& config : *list) {
      const auto status = known.find(config.meter.id);
      meters.push_back(meter_json(config, status == known.end() ? nullptr : &status->second));
    }
  }
  return json_answer({{"meters", meters}, {"next", nullptr}});
}

http::Response get_meter(const Served& served, const std::string& id) {
  const auto meter = meter_of(served.site, id);
  if (!meter) return meter.error();
  const auto status = served.meter_status(id);
  return json_answer(meter_json(**meter, status ? &*status : nullptr));
}

}  // namespace recald::daemon
