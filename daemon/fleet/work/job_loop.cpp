#include "daemon/fleet/work/job_loop.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <exception>
#include <thread>
#include <utility>

#include "adapters/record/schema.hpp"
#include "adapters/system/child_process.hpp"
#include "adapters/system/files/read_file.hpp"
#include "adapters/system/files/scratch_folder.hpp"
#include "daemon/fleet/config/open_record.hpp"
#include "daemon/fleet/work/work_folder.hpp"

namespace recald::daemon {
namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;

constexpr std::chrono::seconds kRenewLeaseEvery{60};
constexpr std::string_view kFolderName = "recald-job-";
constexpr auto kOutput = "output.txt";
constexpr std::size_t kLine_max = 400;
constexpr std::chrono::seconds kKeepAgain{5};

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

/// The last line that the process wrote; empty: it wrote nothing.
std::string last_line_of(const fs::path& file) {
  const auto text = system::read_file(file);
  if (!text) return {};
  const std::size_t end = text->find_last_not_of('\n');
  if (end == std::string::npos) return {};
  const std::size_t before = text->rfind('\n', end);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return text->substr(begin, std::min<std::size_t>(end + 1 - begin, kLine_max));
}

std::string why_it_ended(const system::ChildEnd& end, const fs::path& folder) {
  switch (end.ending) {
    case system::Ending::killed:
      return fmt::format("its process was killed by signal {}", end.signal);
    case system::Ending::over_limit:
      return fmt::format("it took longer than {:.0f} s", end.wall_s);
    case system::Ending::exited:
    case system::Ending::stopped:
      break;
  }
  const std::string words = last_line_of(folder / kOutput);
  return fmt::format("its process ended with code {}{}{}", end.exit_code, words.empty() ? "" : ": ",
                     words);
}

class Jobs {
 public:
  Jobs(const JobLoop& loop, const Report& report, const std::stop_token& stop)
      : loop_(loop), notify_(report), stop_(stop) {}

  /// Until it is told to stop, or nothing is left. @return or why the record cannot be used.
  Result<void> work(postgres::Connection& record) {
    if (auto checked = record::check_schema(record); !checked) return checked;
    while (!stop_.stop_requested()) {
      const auto job = TRY(record::lease(record, loop_.name, loop_.rules));
      if (job) {
        if (auto done = do_one(record, *job); !done) return done;
        continue;
      }
      if (loop_.ends_when_idle) return {};
      TRY(record.wait_for(record::kJobChannel, loop_.poll_every, stop_));
    }
    return {};
  }

  [[nodiscard]] int count() const { return count_; }

 private:
  /// An exception is a try that failed.
  Result<void> do_one(postgres::Connection& record, const record::FleetJob& job) {
    try {
      return do_it(record, job);
    } catch (const std::exception& thrown) {
      return give_back(record, job, thrown.what());
    }
  }

  Result<void> do_it(postgres::Connection& record, const record::FleetJob& job) {
    auto folder = system::ScratchFolder::make(loop_.worker.folder,
                                              fmt::format("{}{}-", kFolderName, ::getpid()));
    if (!folder) return after_failure(record, job, folder.error());
    if (auto filled = fill_work_folder(record, job, folder->path()); !filled) {
      if (filled.error().code == ErrorCode::io_failed) {
        return after_failure(record, job, filled.error());
      }
      return keep(record::fail(record, job, filled.error().message), job, "cannot be done");
    }
    bool is_ours = true;
    const auto end = run(record, job, folder->path(), is_ours);
    if (!end) return after_failure(record, job, end.error());
    if (!is_ours) return {};
    if (end->ending == system::Ending::stopped)
      return keep(record::hand_back(record, job), job, "");
    const auto outcome = read_outcome(folder->path());
    if (end->ending != system::Ending::exited || end->exit_code != 0 || !outcome) {
      return give_back(record, job, why_it_ended(*end, folder->path()));
    }
    ++count_;
    if (!outcome->failed.empty()) {
      return keep(record::fail(record, job, outcome->failed), job,
                  "cannot be done: " + outcome->failed);
    }
    return keep(finish(record, job, outcome->result), job,
                fmt::format("done in {:.1f} s", end->wall_s));
  }

  /// Tries again while the record is away and the lease may still be ours.
  Result<bool> finish(postgres::Connection& record, const record::FleetJob& job,
                      const record::FleetResult& result) {
    const auto begin = steady_clock::now();
    for (;;) {
      auto kept = record::finish(record, job, result);
      const bool is_over =
          stop_.stop_requested() || steady_clock::now() - begin > loop_.rules.lease;
      if (kept || kept.error().code != ErrorCode::io_failed || is_over) return kept;
      std::this_thread::sleep_for(kKeepAgain);
    }
  }

  /// @param is_ours  Becomes false if the lease was lost meanwhile.
  Result<system::ChildEnd> run(postgres::Connection& record, const record::FleetJob& job,
                               const fs::path& folder, bool& is_ours) {
    auto renewed = steady_clock::now();
    return system::run_child({.program = loop_.program,
                              .arguments = {"worker", "--do", folder.string()},
                              .folder = folder,
                              .output = folder / kOutput,
                              .time_max = loop_.worker.time_max,
                              .memory_max_bytes = loop_.worker.memory_max_bytes},
                             [&] {
                               if (steady_clock::now() - renewed > kRenewLeaseEvery) {
                                 renewed = steady_clock::now();
                                 // Of a record that is away nothing is known; it says so at the
                                 // end.
                                 is_ours = record::renew(record, job, loop_.rules).value_or(true);
                               }
                               return is_ours && !stop_.stop_requested();
                             });
  }

  Result<void> give_back(postgres::Connection& record, const record::FleetJob& job,
                         const std::string& why) {
    return keep(record::give_back(record, job, why, loop_.rules), job, "was not done: " + why);
  }

  /// Where the record answers, this machine or the job is the reason, and it counts as a try:
  /// others go on. @return or the failure: the record is away.
  Result<void> after_failure(postgres::Connection& record, const record::FleetJob& job,
                             const Error& why) {
    if (record.run("SELECT 1")) return give_back(record, job, why.message);
    return tl::unexpected(why);  // its lease runs out
  }

  Result<void> keep(const Result<bool>& kept, const record::FleetJob& job,
                    const std::string& words) {
    if (!kept) return tl::unexpected(kept.error());
    if (!words.empty()) {
      notify_(fmt::format("{} {}{}", words_of(job), words,
                          *kept ? "" : "; somebody else had finished it"));
    }
    return {};
  }

  const JobLoop& loop_;
  const Report& notify_;
  const std::stop_token& stop_;
  int count_ = 0;
};

}  // namespace

int do_jobs(const JobLoop& loop, const Report& report, const std::stop_token& stop) {
  std::error_code ignored;
  remove_leftovers(loop.worker.folder.empty() ? fs::temp_directory_path(ignored)
                                              : loop.worker.folder);
  Jobs jobs{loop, report, stop};
  keep_trying(
      "no jobs are done",
      [&]() -> Result<void> {
        auto connection = TRY(open_record(loop.record, {.stop = stop}));
        return jobs.work(*connection);
      },
      report, stop);
  return jobs.count();
}

}  // namespace recald::daemon
