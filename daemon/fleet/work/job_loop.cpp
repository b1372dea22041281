#include "daemon/fleet/work/job_loop.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <chrono>
#include <utility>

#include "adapters/record/schema.hpp"
#include "adapters/system/child_process.hpp"
#include "adapters/system/scratch_folder.hpp"
#include "daemon/fleet/config/open_record.hpp"
#include "daemon/fleet/work/work_folder.hpp"

namespace recald::daemon {
namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

constexpr std::chrono::seconds kRenewEvery{60};
constexpr std::string_view kFolderName = "recald-job-";

std::string words_of(const record::FleetJob& job) {
  return fmt::format("{} of {} for {}", name_of(job.kind), job.site,
                     metering::to_string(job.month));
}

/// Of workers that were killed: "recald-job-PID-XXXXXX".
void remove_leftovers(const fs::path& place) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator{place, ignored}) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(kFolderName)) continue;
    long process = 0;
    std::from_chars(name.data() + kFolderName.size(), name.data() + name.size(), process);
    const bool is_alive = fs::exists(fmt::format("/proc/{}", process), ignored);
    if (process > 0 && !is_alive) fs::remove_all(entry.path(), ignored);
  }
}

/// The last line that the process wrote, for what it does not say by its end.
std::string why_it_ended(const system::ChildEnd& end) {
  switch (end.ending) {
    case system::Ending::killed:
      return fmt::format("its process was killed by signal {}", end.signal);
    case system::Ending::over_limit:
      return fmt::format("it took longer than {:.0f} s", end.wall_s);
    case system::Ending::exited:
    case system::Ending::stopped:
      break;
  }
  return fmt::format("its process ended with code {}", end.exit_code);
}

class Jobs {
 public:
  Jobs(const JobLoop& loop, const TellWords& tell, const std::stop_token& stop)
      : loop_(loop), tell_(tell), stop_(stop) {}

  /// Until it is told to stop, or nothing is left. @return or why the record cannot be used.
  Result<void> work(postgres::Connection& record) {
    if (auto checked = record::check_schema(record); !checked) return checked;
    while (!stop_.stop_requested()) {
      const auto job = record::lease(record, loop_.name, loop_.rules);
      if (!job) return tl::unexpected(job.error());
      if (*job) {
        if (auto done = do_one(record, **job); !done) return done;
        continue;
      }
      if (loop_.ends_when_idle) return {};
      const auto called = record.wait_for(record::kJobChannel, loop_.look_every, stop_);
      if (!called) return tl::unexpected(called.error());
    }
    return {};
  }

  [[nodiscard]] int count() const { return count_; }

 private:
  Result<void> do_one(postgres::Connection& record, const record::FleetJob& job) {
    auto folder = system::ScratchFolder::make(loop_.worker.folder,
                                              fmt::format("{}{}-", kFolderName, ::getpid()));
    if (!folder) return hand_back(record, job, folder.error());
    if (auto filled = fill_work_folder(record, job, folder->path()); !filled) {
      // The disk or the record: not the job's fault.
      if (filled.error().code == ErrorCode::io_failed)
        return hand_back(record, job, filled.error());
      return keep(record::fail(record, job, filled.error().message), job, "cannot be done");
    }
    bool is_ours = true;
    const auto end = run(record, job, folder->path(), is_ours);
    if (!end) return hand_back(record, job, end.error());
    if (!is_ours) return {};
    if (end->ending == system::Ending::stopped)
      return keep(record::hand_back(record, job), job, "");
    const auto outcome = read_outcome(folder->path());
    if (end->ending != system::Ending::exited || end->exit_code != 0 || !outcome) {
      const std::string why = why_it_ended(*end);
      return keep(record::give_back(record, job, why, loop_.rules), job, "was not done: " + why);
    }
    ++count_;
    if (!outcome->failed.empty()) {
      return keep(record::fail(record, job, outcome->failed), job,
                  "cannot be done: " + outcome->failed);
    }
    return keep(record::finish(record, job, outcome->result), job,
                fmt::format("done in {:.1f} s", end->wall_s));
  }

  /// @param is_ours  Becomes false if the lease was lost meanwhile.
  Result<system::ChildEnd> run(postgres::Connection& record, const record::FleetJob& job,
                               const fs::path& folder, bool& is_ours) {
    auto renewed = steady_clock::now();
    return system::run_child({.program = loop_.program,
                              .arguments = {"worker", "--do", folder.string()},
                              .folder = folder,
                              .output = folder / "output.txt",
                              .time_max = loop_.worker.time_max,
                              .memory_max_bytes = loop_.worker.memory_max_bytes},
                             [&] {
                               if (steady_clock::now() - renewed > kRenewEvery) {
                                 renewed = steady_clock::now();
                                 // Of a record that is away nothing is known; it says so at the
                                 // end.
                                 is_ours = record::renew(record, job, loop_.rules).value_or(true);
                               }
                               return is_ours && !stop_.stop_requested();
                             });
  }

  /// After a failure that is not the job's. @return the failure
  Result<void> hand_back(postgres::Connection& record, const record::FleetJob& job,
                         const Error& why) {
    (void)record::hand_back(record, job);  // or its lease runs out
    return tl::unexpected(why);
  }

  Result<void> keep(const Result<bool>& kept, const record::FleetJob& job,
                    const std::string& words) {
    if (!kept) return tl::unexpected(kept.error());
    if (!words.empty()) {
      tell_(fmt::format("{} {}{}", words_of(job), words,
                        *kept ? "" : "; somebody else had finished it"));
    }
    return {};
  }

  const JobLoop& loop_;
  const TellWords& tell_;
  const std::stop_token& stop_;
  int count_ = 0;
};

}  // namespace

int do_jobs(const JobLoop& loop, const TellWords& tell, const std::stop_token& stop) {
  std::error_code ignored;
  remove_leftovers(loop.worker.folder.empty() ? fs::temp_directory_path(ignored)
                                              : loop.worker.folder);
  Jobs jobs{loop, tell, stop};
  keep_trying(
      "no jobs are done",
      [&]() -> Result<void> {
        auto connection = open_record(loop.record);
        if (!connection) return tl::unexpected(connection.error());
        return jobs.work(**connection);
      },
      tell, stop);
  return jobs.count();
}

}  // namespace recald::daemon
