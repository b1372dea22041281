/// A gateway with its jobs and upkeep on a store on disk, process after process, on a virtual
/// clock.
#pragma once

#include <gtest/gtest.h>

#include <csignal>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "adapters/system/files/write_file.hpp"
#include "daemon/gateway/run/job_runner.hpp"
#include "daemon/gateway/upkeep/job_folder.hpp"
#include "daemon/gateway/upkeep/open_store.hpp"
#include "daemon/gateway/upkeep/upkeep.hpp"
#include "tests/daemon/gateway/gateway_rig.hpp"
#include "tests/support/virtual_worker.hpp"

namespace recald::daemon::testing {

/// Who is told of what a life has acknowledged; any may be empty.
struct LifeWitness {
  std::function<void(const StoreBatch&)> on_commit = {};
  std::function<void(std::int64_t)> on_job = {};   ///< With its number.
  std::function<void(std::int64_t)> on_work = {};  ///< In the midst of a job's work.
};

/// What becomes of a job: each does as its number says.
enum class JobFate { accepted, fails, throws };
[[nodiscard]] inline JobFate fate_of(std::int64_t job) {
  return static_cast<JobFate>((job + 2) % 3);
}

class Life {
 public:
  static constexpr int kResultsKept = 4;
  static constexpr std::chrono::minutes kJobLength{3};
  static constexpr std::chrono::minutes kCheckLength{1};  ///< Of a backup.
  static constexpr const char* kResultFile = "calibration.json";

  Life(const std::filesystem::path& folder, recald::testing::VirtualLoop& loop,
       LifeWitness witness = {})
      : witness_(std::move(witness)),
        site_(load_rig_site(folder, two_meter_site())),
        other_site_(load_rig_site(folder, two_meter_site() + "timeout = \"2s\"\n")),
        loop_(loop) {
    for (SiteConfig* site : {&site_, &other_site_}) {
      site->store.backup_at = std::chrono::minutes{0};
      site->store.results_kept = kResultsKept;
    }
  }
  ~Life() { end(); }
  Life(const Life&) = delete;
  Life& operator=(const Life&) = delete;

  /// Begins a process as the daemon does; where it cannot, nothing runs.
  void begin() {
    end();
    alive_ = std::make_shared<int>();
    auto opened = open_store(site_.store, loop_.now().instant());
    if (!opened) return;
    recovery_ = std::move(opened->recovery);
    behind_ = std::move(opened->store);
    store_ = std::make_unique<recald::testing::FailingStore>(*behind_);
    store_->after_commit = witness_.on_commit;
    worker_ = std::make_unique<recald::testing::VirtualWorker>(loop_, kJobLength);
    jobs_ = std::make_unique<JobRunner>(
        JobRunner::Ports{loop_, *store_, *worker_},
        [store = site_.store, on_work = witness_.on_work](const StoredJob& job, metering::Instant,
                                                          JobWatch& watch) {
          return work(job_folder(store, job.kind, job.number), job.number, on_work, watch);
        },
        OnJob{});
    rig_ = std::make_unique<Rig>(*store_, loop_);
    if (!rig_->open(site_)) return end();
    checker_ = std::make_unique<recald::testing::VirtualWorker>(loop_, kCheckLength);
    upkeep_ = std::make_unique<Upkeep>(
        *store_, *checker_, site_.store, metering::LocalCalendar::open(site_.timezone).value(),
        [this](StoreEvent event) { rig_->note(std::move(event)); },
        UpkeepRules{.reserve_bytes = 64 * 1024, .backup_pages = 8});
    jobs_->resume();
    keep_up();
  }

  /// As a kill does, as far as a process can do it to itself.
  void end() {
    alive_.reset();
    jobs_.reset();
    upkeep_.reset();
    checker_.reset();
    rig_.reset();
    worker_.reset();
    store_.reset();
    behind_.reset();
  }
  [[nodiscard]] bool runs() const { return upkeep_ != nullptr; }

  /// What the daemon makes of a signal: SIGHUP, SIGUSR1 or SIGTERM. One that comes while it opens
  /// waits until it listens; where a SIGTERM does not wait, it is a kill.
  void signal(int number) {
    loop_.post([this, number, alive = std::weak_ptr{alive_}] {
      if (alive.expired() || !runs()) return;
      if (number == SIGHUP) reload();
      if (number == SIGUSR1) ask("signal");
      if (number == SIGTERM) loop_.stop();
    });
  }

  /// Half an hour with all that a daemon does in one; ended by a signal, it is started again.
  void live() {
    for (const int wait_min : {2, 4, 4}) {
      run_for(std::chrono::minutes{wait_min});
      if (runs()) ask("api");
    }
    run_for(std::chrono::minutes{4});
    if (runs()) reload();
    run_for(std::chrono::minutes{16});
  }

  /// Waits until no job is under way. @pre it runs
  void finish_jobs() { run_for(4 * kJobLength); }

  [[nodiscard]] Store& store() { return *store_; }
  [[nodiscard]] const SiteConfig& site() const { return site_; }
  /// What opening has said; empty: the store was sound.
  [[nodiscard]] const std::string& recovery() const { return recovery_; }
  /// The text that a job leaves in its result file.
  [[nodiscard]] static std::string result_of(std::int64_t job) {
    return std::string(6'000, static_cast<char>('a' + job % 26));  // more than a page
  }

 private:
  class Rig : public GatewayRig {
   public:
    Rig(Store& store, recald::testing::VirtualLoop& loop) : GatewayRig{store, loop, kRigStart} {}
    void note(StoreEvent event) { gateway_->note(std::move(event)); }
    void flush() { (void)gateway_->flush(); }
    [[nodiscard]] bool is_clock_right() const { return gateway_->clock_doubt().empty(); }
  };

  /// After its process has ended it does nothing more.
  static Result<JobOutcome> work(const std::filesystem::path& folder, std::int64_t job,
                                 const std::function<void(std::int64_t)>& on_work,
                                 JobWatch& watch) {
    if (!watch.goes_on()) return failure(ErrorCode::cancelled, "the process ends");
    if (auto made = system::make_folder(folder); !made) return tl::unexpected(made.error());
    for (const char* name : {"posterior.csv", kResultFile}) {
      if (auto written = system::write_file(folder / name, result_of(job)); !written) {
        return tl::unexpected(written.error());
      }
      if (on_work) on_work(job);
      if (fate_of(job) == JobFate::fails) {
        return failure(ErrorCode::not_enough_data, "the chains do not agree");
      }
      if (fate_of(job) == JobFate::throws) throw std::runtime_error("no such parameter");
    }
    return JobOutcome{.accepted = true, .folder = folder.string(), .result = {.document = "{}"}};
  }

  void ask(const std::string& asked_by) {
    const auto number = jobs_->ask(JobKind::calibration, asked_by);
    if (number && witness_.on_job) witness_.on_job(*number);
  }

  /// The bus is kept, or opened anew.
  void reload() {
    if (rig_->reload(other_site_)) std::swap(site_, other_site_);
  }

  void keep_up() {
    loop_.after(upkeep_->maintain(loop_.now().instant(), rig_->is_clock_right()),
                [this, alive = std::weak_ptr{alive_}] {
                  if (!alive.expired()) keep_up();
                });
  }

  void run_for(std::chrono::milliseconds length) {
    const auto until = loop_.now().monotonic + length;
    while (!loop_.run_for(until - loop_.now().monotonic)) {
      jobs_->interrupt();
      rig_->flush();
      end();
      begin();
    }
  }

  LifeWitness witness_;
  SiteConfig site_;
  SiteConfig other_site_;
  recald::testing::VirtualLoop& loop_;
  std::shared_ptr<int> alive_;
  std::string recovery_;
  std::unique_ptr<Store> behind_;
  std::unique_ptr<recald::testing::FailingStore> store_;
  std::unique_ptr<recald::testing::VirtualWorker> worker_;
  std::unique_ptr<recald::testing::VirtualWorker> checker_;
  std::unique_ptr<JobRunner> jobs_;
  std::unique_ptr<Rig> rig_;
  std::unique_ptr<Upkeep> upkeep_;
};

}  // namespace recald::daemon::testing
