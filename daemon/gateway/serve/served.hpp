/// What is served, and out of what: every answer is a plain function of these and a request.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "adapters/http/message.hpp"
#include "adapters/ports/store.hpp"
#include "daemon/gateway/ingest/correction.hpp"
#include "daemon/gateway/ingest/gateway_status.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// Outlives whoever serves it. All of it is used on the loop's thread alone.
struct Served {
  const SiteConfig& site;
  const metering::LocalCalendar& calendar;
  Store& store;
  std::function<GatewayStatus()> status;
  /// Gateway::meter_status.
  std::function<std::optional<MeterStatus>(const std::string& id)> meter_status;
  std::function<metering::Instant()> now;
  metering::Instant started{};
  /// Why `store` lives in memory alone: what comes in is not taken, since it would not last. Empty:
  /// it does not.
  std::string no_store = {};
  /// Asks for a job: its number, or why there is none (unsupported: the site has no model).
  /// Absent: nobody works here.
  std::function<Result<std::int64_t>(JobKind kind)> ask_job = {};
  /// JobRunner::cancel. Absent: nobody works here.
  std::function<Result<void>(std::int64_t number)> cancel_job = {};
  /// Gateway::take_pushed. Absent: nothing is taken here.
  std::function<Result<CommitCounts>(const std::string& meter,
                                     std::vector<metering::Reading> readings,
                                     const std::optional<Correction>& correction)>
      take_readings = {};
};

/// The answer to any request: an API route, /healthz, /readyz, /metrics, the status page.
[[nodiscard]] http::Response answer(const Served& served, const http::Request& request);

}  // namespace recald::daemon
