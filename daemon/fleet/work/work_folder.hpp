/// The folder of one job of a fleet: all that it reads, made from the record, and all that it
/// leaves.
///
///     job.json     what is to be done
///     site/        the site file, and the files that it names
///     work/        the store; the versions of the model as the job before left them
///     outcome.json what came of it; absent: the process ended before
#pragma once

#include <filesystem>

#include "adapters/postgres/connection.hpp"
#include "adapters/record/jobs.hpp"
#include "core/result.hpp"

namespace recald::daemon {

/// Makes the folder of a job. The same job makes the same folder, wherever it is.
/// @return io_failed: the disk or the record refuses; not_found: the record has no such site.
[[nodiscard]] Result<void> fill_work_folder(postgres::Connection& record,
                                            const record::FleetJob& job,
                                            const std::filesystem::path& folder);

/// Does the job of such a folder, as the daemon of a gateway would, and leaves its outcome there.
/// A job that cannot be done has an outcome too.
/// @return io_failed: nothing could be left.
[[nodiscard]] Result<void> do_work(const std::filesystem::path& folder);

struct WorkOutcome {
  std::string failed;  ///< Why the job cannot be done on these inputs; empty: it was done.
  record::FleetResult result;
};

/// @return what a job left; malformed or io_failed: it left nothing that can be read.
[[nodiscard]] Result<WorkOutcome> read_outcome(const std::filesystem::path& folder);

}  // namespace recald::daemon
