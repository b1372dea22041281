#include <nlohmann/json.hpp>

#include "daemon/gateway/serve/api/api.hpp"
#include "daemon/gateway/serve/api/json_answer.hpp"
#include "daemon/gateway/serve/api/parameters.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;

Json forecast_json(const StoredForecast& one) {
  return {{"output", one.output},
          {"month", metering::to_string(one.month)},
          {"revision", one.revision},
          {"model_version", one.model_version},
          {"data_revision", one.data_revision},
          {"made", metering::to_string(one.made)},
          {"mean", one.mean},
          {"sd", one.sd},
          {"q05", one.q05},
          {"q50", one.q50},
          {"q95", one.q95},
          {"measured", one.measured},
          {"pit", one.pit},
          {"standardised", one.standardised},
          {"log_score", one.log_score},
          {"crps", one.crps}};
}

}  // namespace

http::Response get_forecasts(const Served& served, const http::Request& request) {
  if (const auto checked = has_only(request, {"output", "from", "to", "limit", "cursor"});
      !checked) {
    return checked.error();
  }
  const auto output = text_of(request, "output");
  const auto from = month_of(request, "from");
  if (!from) return from.error();
  const auto to = month_of(request, "to");
  if (!to) return to.error();
  const auto limit = limit_of(request);
  if (!limit) return limit.error();
  const auto sent = whole_number_of(request, "cursor", "the number from a 'next' of this list");
  if (!sent) return sent.error();
  const auto stored = served.store.forecasts();
  if (!stored) return refusal(stored.error()).value();

  Json forecasts = Json::array();
  std::int64_t place = 0;  // rows are never removed, and revisions of a month are adjacent
  for (const StoredForecast& one : *stored) {
    if (output && one.output != *output) continue;
    if ((*from && one.month < **from) || (*to && one.month >= **to)) continue;
    if (place++ < sent->value_or(0)) continue;
    if (std::ssize(forecasts) == *limit) {
      return json_answer({{"forecasts", forecasts}, {"next", std::to_string(place - 1)}});
    }
    forecasts.push_back(forecast_json(one));
  }
  return json_answer({{"forecasts", forecasts}, {"next", nullptr}});
}

}  // namespace recald::daemon
