/// The work queue of a fleet, and its results, in the record.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/ports/store.hpp"
#include "adapters/postgres/connection.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::record {

inline constexpr auto kJobChannel = "recald_job";

enum class FleetJobState : std::uint8_t { waiting, running, done, failed, set_aside };
[[nodiscard]] std::string_view name_of(FleetJobState state);

struct FleetJob {
  std::int64_t number = 0;
  std::string site;
  int site_version = 0;
  JobKind kind = JobKind::calibration;
  metering::Month month;       ///< The last one that it uses.
  std::int64_t until_seq = 0;  ///< Of the rows that it uses.
  metering::Instant now;       ///< What the job takes for the time: when the month was closed.
  std::string input_sha256;    ///< Of all the above: the same input has one job.
  std::string asked_by;        ///< "month", "rerun", "drift", "diagnosis"
  FleetJobState state = FleetJobState::waiting;
  int tries = 0;       ///< This one included.
  std::string worker;  ///< Who has or had it.
  std::string reason;  ///< Why it failed or was set aside.
};

struct LeaseRules {
  std::chrono::seconds lease{300};
  int tries_max = 3;
  std::chrono::seconds wait_after_try{
      60};  ///< Doubles: a job that kills its worker does not keep all of them busy.
};

/// Takes the next job: one running job a site, in order of (month, until_seq, number) within a
/// site, the oldest first among sites. A job that waits for another try holds up its site's others.
/// A job whose lease ran out counts as a try that failed; after `tries_max` it is set aside here,
/// with the reason.
/// @return nothing: no job waits.
[[nodiscard]] Result<std::optional<FleetJob>> lease(postgres::Connection& connection,
                                                    const std::string& worker,
                                                    const LeaseRules& rules);

/// @return false: the lease ran out and somebody else has the job; stop working on it.
[[nodiscard]] Result<bool> renew(postgres::Connection& connection, const FleetJob& job,
                                 const LeaseRules& rules);

/// What a job leaves.
struct FleetResult {
  bool accepted = false;
  bool named = false;
  std::string message;
  std::string summary;                       ///< JSON, for lists and comparisons; see fleet/work.
  std::map<std::string, std::string> files;  ///< Name to bytes: calibration.json, report.html …
  /// The state that the next job of the site begins with (versions of the model, calibrations in
  /// force): name to bytes.
  std::map<std::string, std::string> state;
  std::optional<JobKind> next;  ///< A job that this one calls for, of the same month.
  std::string next_asked_by;
};

/// Stores the result, the site's state, the job it calls for, and that the job is done, at once.
/// @return false: somebody else has finished it; nothing was stored.
[[nodiscard]] Result<bool> finish(postgres::Connection& connection, const FleetJob& job,
                                  const FleetResult& result);

/// The job cannot succeed with these inputs. @return as finish.
[[nodiscard]] Result<bool> fail(postgres::Connection& connection, const FleetJob& job,
                                const std::string& reason);

/// The try ended without a result (killed, out of memory or time): again later, or set aside.
[[nodiscard]] Result<bool> give_back(postgres::Connection& connection, const FleetJob& job,
                                     const std::string& reason, const LeaseRules& rules);

/// The worker stops, or its machine cannot do it: somebody else may at once, and the try does not
/// count. @return as finish.
[[nodiscard]] Result<bool> hand_back(postgres::Connection& connection, const FleetJob& job);

/// The state that the job begins with: as the last finished job before it, in the order of the
/// site's jobs, left it. So it is the same whenever the job runs.
[[nodiscard]] Result<std::map<std::string, std::string>> state_before(
    postgres::Connection& connection, const FleetJob& job);

/// Which jobs to run again: of those of one kind and month the newest, unless it waits or runs.
struct RerunWhat {
  std::vector<std::string> sites;      ///< Empty: all.
  std::optional<FleetJobState> state;  ///< Only those; usually set_aside or failed.
  std::optional<JobKind> kind;
  std::optional<metering::Month> month;  ///< Absent: the last month of each site.
};
/// The jobs that would run, in order. Nothing is changed.
[[nodiscard]] Result<std::vector<FleetJob>> would_rerun(postgres::Connection& connection,
                                                        const RerunWhat& what);
/// Lets them run again with the present version of their site; audited. @return how many.
[[nodiscard]] Result<int> rerun(postgres::Connection& connection, const std::vector<FleetJob>& jobs,
                                const std::string& who);

/// For lists: newest first. @param site  Empty: of all.
[[nodiscard]] Result<std::vector<FleetJob>> jobs(postgres::Connection& connection,
                                                 const std::string& site, int limit);
/// What nobody has mended: the newest job of its site and kind, and it failed or was set aside. By
/// site and kind.
[[nodiscard]] Result<std::vector<FleetJob>> troubled_jobs(postgres::Connection& connection);
/// How many there are in each state.
[[nodiscard]] Result<std::map<FleetJobState, std::int64_t>> job_counts(
    postgres::Connection& connection);

/// A result as stored: of a job, or as a gateway sent it.
struct FleetResultRow {
  std::string site;
  JobKind kind = JobKind::calibration;
  metering::Month month;  ///< Of a gateway's: the last that the record had then.
  std::string from;       ///< "worker" or "gateway"
  metering::Instant at;
  bool accepted = false;
  bool named = false;  ///< Of a worker's.
  std::string message;
  std::string summary;       ///< Of a worker's.
  std::string input_sha256;  ///< Of a worker's job.
  std::string sha256;        ///< Of the files.
  std::vector<std::string> files;
};
/// The newest of a kind of each site, by site; one that a gateway sent where no job has made one.
/// @param site  Empty: of all.
[[nodiscard]] Result<std::vector<FleetResultRow>> newest_results(postgres::Connection& connection,
                                                                 JobKind kind,
                                                                 const std::string& site = {});
/// @return not_found.
[[nodiscard]] Result<std::string> result_file(postgres::Connection& connection,
                                              const std::string& site, JobKind kind,
                                              metering::Month month, const std::string& name);

}  // namespace recald::record
