#include <fmt/format.h>
#include <signal.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <thread>
#include <vector>

#include "core/text/printable.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/interrupt.hpp"
#include "daemon/fleet/config/fleet_config.hpp"
#include "daemon/fleet/ingest/ingester.hpp"
#include "daemon/fleet/work/job_loop.hpp"
#include "daemon/fleet/work/work_folder.hpp"

namespace recald::daemon {
namespace {

constexpr std::chrono::milliseconds kWorkerLook{100};

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "worker";
}

/// One job, in the process that a worker started for it: it ends with the worker.
int do_one(const std::filesystem::path& folder, const Console& console) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (auto left = do_work(folder); !left) return console.fail(left.error());
  return kSuccess;
}

JobLoop job_loop(const FleetConfig& config, int number, bool ends_when_idle) {
  return {.record = config.record,
          .worker = config.worker,
          .name = fmt::format("{}/{}/{}", host_name(), ::getpid(), number),
          .program = "/proc/self/exe",  // the same program, even after an upgrade
          .ends_when_idle = ends_when_idle};
}

}  // namespace

int run_worker(const WorkerArguments& arguments, const Console& console) {
  if (!arguments.job_folder.empty()) return do_one(arguments.job_folder, console);
  auto config = load_fleet(arguments.fleet);
  if (!config) return console.fail(config.error());
  if (arguments.jobs) config->worker.jobs = *arguments.jobs;
  if (config->worker.jobs == 0 && !config->broker) {
    return console.fail(
        fmt::format("{} has neither [mqtt] nor jobs, so this worker would do nothing",
                    arguments.fleet.filename().string()));
  }
  if (console.detail == Console::Detail::little) spdlog::set_level(spdlog::level::warn);
  const InterruptGuard guard;
  const Report report = [](const std::string& words) { spdlog::info("{}", printable(words)); };
  std::jthread ingester;
  if (config->broker) {
    ingester = std::jthread{[&](const std::stop_token& stop) {
      const IngestCounts counts = ingest(config->record, *config->broker, report, stop);
      report(fmt::format("{} batches with {} intervals and months were taken, {} refused",
                         counts.batches, counts.entries, counts.refused));
    }};
  }
  std::atomic<int> running = config->worker.jobs;
  std::vector<std::jthread> workers;
  for (int i = 1; i <= config->worker.jobs; ++i) {
    workers.emplace_back([&, i](const std::stop_token& stop) {
      const int count = do_jobs(job_loop(*config, i, arguments.until_idle), report, stop);
      report(fmt::format("{} jobs were done", count));
      --running;
    });
  }
  const auto is_idle = [&] { return arguments.until_idle && running == 0; };
  while (!guard.interrupted() && !is_idle()) std::this_thread::sleep_for(kWorkerLook);
  return kSuccess;
}

}  // namespace recald::daemon
