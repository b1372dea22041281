#include <algorithm>
#include <nlohmann/json.hpp>

#include "daemon/serve/api.hpp"
#include "daemon/serve/json_answer.hpp"
#include "daemon/serve/parameters.hpp"
#include "daemon/serve/shapes.hpp"
#include "daemon/version.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;

Json with_status(const MeterConfig& config, const GatewayStatus& status) {
  const auto found = std::ranges::find(status.meters, config.meter.id, &MeterStatus::id);
  return meter_json(config, found == status.meters.end() ? nullptr : &*found);
}

}  // namespace

http::Response get_sites(const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {}); !checked) return checked.error();
  const Json site = {{"id", served.site.id},
                     {"name", served.site.name},
                     {"timezone", served.site.timezone},
                     {"interval_s", served.site.interval.count()},
                     {"meters", served.site.meters.size()},
                     {"version", kVersion},
                     {"started_at", metering::to_string(served.started)},
                     {"now", metering::to_string(served.now())}};
  return json_answer({{"sites", Json::array({site})}, {"next", nullptr}});
}

http::Response get_meters(const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {}); !checked) return checked.error();
  const GatewayStatus status = served.status();
  Json meters = Json::array();
  for (const MeterConfig& config : served.site.meters) {
    meters.push_back(with_status(config, status));
  }
  return json_answer({{"meters", meters}, {"next", nullptr}});
}

http::Response get_meter(const Served& served, const std::string& id) {
  const auto meter = meter_of(served.site, id);
  if (!meter) return meter.error();
  return json_answer(with_status(**meter, served.status()));
}

}  // namespace recald::daemon
