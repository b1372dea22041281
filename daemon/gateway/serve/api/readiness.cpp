#include "daemon/gateway/serve/api/readiness.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace recald::daemon {

using Json = nlohmann::ordered_json;

std::vector<std::string> reasons_not_ready(const GatewayStatus& status) {
  std::vector<std::string> reasons;
  if (!status.clock_ok) {
    reasons.push_back(
        fmt::format("the system clock is not set: {}; readings are held until it is, because they "
                    "cannot be stamped",
                    status.clock_doubt));
  }
  if (!status.no_store.empty()) {
    reasons.push_back(
        fmt::format("the store cannot be opened: {}; readings are kept in memory, and are lost if "
                    "recald ends before the store opens",
                    status.no_store));
  }
  if (status.store.is_degraded) {
    reasons.push_back(
        fmt::format("the store refuses writes: {}; {} intervals are waiting and {} were dropped",
                    status.store.why, status.waiting_intervals, status.store.lost_intervals));
  }
  return reasons;
}

std::vector<std::string> reasons_to_look(const GatewayStatus& status) {
  std::vector<std::string> reasons;
  for (const MeterStatus& meter : status.meters) {
    for (const QuantityStatus& one : meter.weather) {
      const std::string_view name = one.quantity->name;
      if (one.state.silent_since) {
        reasons.push_back(silence_words(meter.id, name, *one.state.silent_since));
      }
      if (one.state.frozen_since) {
        reasons.push_back(frozen_words(meter.id, name, *one.state.frozen_since));
      }
    }
    if (!meter.poll) continue;
    for (const RefusedRegisters& refused : meter.poll->refused) {
      reasons.push_back(sentence_of(meter.id, refused));
    }
  }
  return reasons;
}

http::Response health() { return http::json_response("{\"status\":\"alive\"}\n"); }

http::Response readiness(const Served& served) {
  const GatewayStatus status = served.status();
  const auto reasons = reasons_not_ready(status);
  const Json json = {{"status", reasons.empty() ? "ready" : "not ready"},
                     {"site", served.site.id},  // no answer without a loaded configuration
                     {"reasons", reasons},
                     {"look_at", reasons_to_look(status)}};
  return http::json_response(json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n",
                             reasons.empty() ? 200 : 503);
}

}  // namespace recald::daemon
