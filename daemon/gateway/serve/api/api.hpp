/// The routes below /api/v1/. Lists have `limit` and `next`: the cursor of the following entries,
/// to be sent as `cursor`, or null.
#pragma once

#include <string>

#include "daemon/gateway/serve/api/served.hpp"

namespace recald::daemon {

[[nodiscard]] http::Response get_sites(const Served& served, const http::Request& request);

/// All meters of the site; polled ones with their state and values.
[[nodiscard]] http::Response get_meters(const Served& served, const http::Request& request);
[[nodiscard]] http::Response get_meter(const Served& served, const std::string& id);

/// ?meter (required) &from &to &limit &cursor, in order of time.
[[nodiscard]] http::Response get_intervals(const Served& served, const http::Request& request);

/// ?meter (required) &from &to &points, summed up to at most so many points.
[[nodiscard]] http::Response get_history(const Served& served, const http::Request& request);

/// ?meter &from &to (months, half open) &limit &cursor, by meter and month.
[[nodiscard]] http::Response get_months(const Served& served, const http::Request& request);

/// ?from &to &limit &cursor, newest first, among the newest 10 000.
[[nodiscard]] http::Response get_events(const Served& served, const http::Request& request);

/// What the calibration in use shows about new months; null until there is something.
[[nodiscard]] http::Response get_forecasts(const Served& served, const http::Request& request);
[[nodiscard]] http::Response get_drift(const Served& served, const http::Request& request);

/// ?limit &cursor, newest first, without results.
[[nodiscard]] http::Response get_jobs_of(JobKind kind, const Served& served,
                                         const http::Request& request);
/// One job, with its result.
[[nodiscard]] http::Response get_job_of(JobKind kind, const Served& served, const std::string& id);
/// 202, and where to find the job.
[[nodiscard]] http::Response post_job_of(JobKind kind, const Served& served,
                                         const http::Request& request);

/// 202 with the job; a running one ends in a moment. 409 when it neither waits nor runs.
[[nodiscard]] http::Response cancel_job_of(JobKind kind, const Served& served,
                                           const std::string& id);

template <JobKind kind>
http::Response get_jobs(const Served& served, const http::Request& request) {
  return get_jobs_of(kind, served, request);
}
template <JobKind kind>
http::Response get_job(const Served& served, const std::string& id) {
  return get_job_of(kind, served, id);
}
template <JobKind kind>
http::Response cancel_job(const Served& served, const std::string& id) {
  return cancel_job_of(kind, served, id);
}
template <JobKind kind>
http::Response post_job(const Served& served, const http::Request& request) {
  return post_job_of(kind, served, request);
}

/// The versions of the model.
[[nodiscard]] http::Response get_model(const Served& served, const http::Request& request);
/// {"activate": VERSION} or {"revert": VERSION or null}; then a calibration is requested, which
/// uses what is in force now. @return the versions
[[nodiscard]] http::Response post_model(const Served& served, const http::Request& request);

/// Pushed readings of a meter with source = "http"; see daemon/gateway/serve/README.md. Sent twice,
/// they are stored once.
[[nodiscard]] http::Response post_readings(const Served& served, const http::Request& request);

}  // namespace recald::daemon
