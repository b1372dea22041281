/// The pages and the API of a fleet. Every answer is read from the record.
#pragma once

#include <functional>
#include <string>

#include "adapters/http/message.hpp"
#include "adapters/postgres/connection.hpp"
#include "core/metering/civil_time.hpp"

namespace recald::daemon {

struct FleetServed {
  postgres::Connection& record;
  std::function<metering::Instant()> now;
  std::string who;  ///< For the audit of what is asked for here.
};

/// /                 sites, the most urgent first; comparison by use and climate; map
/// /sites/ID         one site: its results, its jobs, links to its pages
/// /results/ID/MONTH/KIND/FILE  a page or file of a result
/// /rerun            which jobs would run again, of the sites that fit the same filter, and a
/// button /audit            what operators and the record itself have done /api/v1/portfolio,
/// /api/v1/jobs, POST /api/v1/rerun, /metrics, /healthz, /readyz
[[nodiscard]] http::Response answer_fleet(const FleetServed& served, const http::Request& request);

}  // namespace recald::daemon
