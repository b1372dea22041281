#include "adapters/record/job_rows.hpp"

#include <fmt/format.h>

#include "adapters/record/jobs.hpp"
#include "adapters/record/values.hpp"

namespace recald::record {

using postgres::Array;

std::string JobInput::sha256() const {
  return sha256_of(fmt::format("{}\n{}\n{}\n{}\n{}\n{}", site, version_sha256,
                               recald::name_of(kind), metering::to_string(month), until_seq,
                               now.time_since_epoch().count()));
}

Result<int> put_jobs(postgres::Connection& connection, const std::vector<NewJob>& jobs,
                     IfThere if_there) {
  if (jobs.empty()) return 0;
  Array sites, versions, kinds, months, seqs, times, sums, asked;
  for (const NewJob& job : jobs) {
    sites.add(job.site);
    versions.add(std::int64_t{job.version});
    kinds.add(recald::name_of(job.input.kind));
    months.add(metering::to_string(job.input.month));
    seqs.add(job.input.until_seq);
    times.add(metering::to_string(job.input.now));
    sums.add(job.input.sha256());
    asked.add(job.asked_by);
  }
  const std::string rows =
      "INSERT INTO job (site, version, kind, month, until_seq, now, input_sha256, asked_by) "
      "SELECT * FROM unnest($1::int[], $2::int[], $3::text[], $4::text[], $5::bigint[], "
      "$6::timestamptz[], $7::text[], $8::text[]) ON CONFLICT (input_sha256) DO ";
  const std::string again =
      "UPDATE SET state = 'waiting', version = excluded.version, tries = 0, not_before = now(), "
      "asked = now(), ended = NULL, worker = '', reason = '', asked_by = excluded.asked_by "
      "WHERE job.state NOT IN ('waiting', 'running') ";
  const auto put = TRY(connection.run(
      fmt::format("WITH put AS ({}{} RETURNING 1) SELECT count(*), "
                  "CASE WHEN count(*) > 0 THEN pg_notify('{}', '') END FROM put",
                  rows, if_there == IfThere::leave ? "NOTHING" : again, kJobChannel),
      {sites.parameter(), versions.parameter(), kinds.parameter(), months.parameter(),
       seqs.parameter(), times.parameter(), sums.parameter(), asked.parameter()}));
  return static_cast<int>(put.integer(0, 0));
}

}  // namespace recald::record
