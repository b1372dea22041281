/// The data behind all responses: every response is a plain function of these and a request.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "adapters/http/message.hpp"
#include "adapters/ports/store.hpp"
#include "daemon/gateway/ingest/correction.hpp"
#include "daemon/gateway/ingest/gateway_status.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/model/expected_load.hpp"

namespace recald::daemon {

/// How far the running job is.
struct JobProgress {
  std::int64_t job;
  double share;      ///< 0…1
  std::string what;  ///< "calibrating the hourly model"
};

/// Outlives the server. Used only on the loop's thread.
struct Served {
  const SiteConfig& site;
  const metering::LocalCalendar& calendar;
  Store& store;
  std::function<GatewayStatus()> status;
  /// Calls Gateway::meter_status.
  std::function<std::optional<MeterStatus>(const std::string& id)> meter_status;
  std::function<metering::Instant()> now;
  /// Calls Gateway::clock_doubt. Absent: the clock is right.
  std::function<std::string()> clock_doubt = {};
  metering::Instant started{};
  /// Why `store` is only in memory: incoming readings are refused, since they would be lost.
  /// Empty: it is on disk.
  std::string no_store = {};
  /// Requests a job. @return its number, or why there is none (unsupported: the site has no model).
  /// Absent: there are no jobs here.
  std::function<Result<std::int64_t>(JobKind kind)> ask_job = {};
  /// Calls JobRunner::cancel. Absent: there are no jobs here.
  std::function<Result<void>(std::int64_t number)> cancel_job = {};
  /// What the model expects of the last days; empty where it has none. Absent: as empty.
  std::function<const std::vector<ExpectedMeter>&()> expected = {};
  /// Nothing while no job runs or none has said anything. Absent: there are no jobs here.
  std::function<std::optional<JobProgress>()> progress = {};
  /// Calls Gateway::take_pushed. Absent: readings are not accepted here.
  std::function<Result<CommitCounts>(const std::string& meter,
                                     std::vector<metering::Reading> readings,
                                     const std::optional<Correction>& correction)>
      take_readings = {};
  /// Calls Gateway::take_samples. Absent: as above.
  std::function<Result<CommitCounts>(const std::string& meter,
                                     std::vector<metering::RegisterSample> samples)>
      take_samples = {};
};

/// The response to any request: an API route, /healthz, /readyz, /metrics, a page.
[[nodiscard]] http::Response answer(const Served& served, const http::Request& request);

}  // namespace recald::daemon
