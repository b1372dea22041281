/// A gateway's life where it begins, changes and ends, with a fault at each step: whatever call
/// that changes a file fails, ends the process or is the last before a power cut, nothing that was
/// stored is lost.
///
/// RECALD_EDGE_KILLS: how often a daemon is killed that opens, reloads, backs up and works all the
/// time, 100 unless set. RECALD_EDGE_CUTS: of a recovery and of such a life each, how many images
/// of a power cut are looked at, 60 unless set.
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

#include "core/random/rng.hpp"
#include "daemon/gateway/run/job_runner.hpp"
#include "daemon/gateway/upkeep/backups.hpp"
#include "daemon/gateway/upkeep/open_store.hpp"
#include "daemon/gateway/upkeep/upkeep.hpp"
#include "tests/daemon/gateway/gateway_rig.hpp"
#include "tests/daemon/gateway/run/witness.hpp"
#include "tests/support/damage.hpp"
#include "tests/support/file_faults.hpp"
#include "tests/support/power_cut.hpp"
#include "tests/support/virtual_worker.hpp"

namespace recald::daemon::edges_test {
namespace {

using metering::Instant;
using recald::testing::FailingChanges;
using recald::testing::FailingStore;
using recald::testing::FileChange;
using recald::testing::TemporaryFolder;
using recald::testing::VirtualLoop;
using recald::testing::VirtualWorker;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;
using testing::kRigStart;

constexpr seconds kQuarter{900};
constexpr int kKilled = 9;
constexpr int kDone = 0;

/// Does the work in a process of its own that ends before its n-th change of a file.
/// @return whether it came to its end before that.
template <class Work>
bool ends_before(int nth, const Work& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    recald::testing::end_process_before_change(nth, kKilled);
    work();
    ::_exit(kDone);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status);
  return WIFEXITED(status) && WEXITSTATUS(status) == kDone;
}

int given_or(const char* variable, int otherwise) {
  const char* given = std::getenv(variable);
  return given != nullptr ? std::atoi(given) : otherwise;
}

/// What power cuts at random changes of a file leave of a folder, while this lives.
class Images {
 public:
  /// @param keep  Told before an image is made; it has the number `taken()`.
  Images(std::filesystem::path folder, std::filesystem::path to, Rng& rng,
         std::function<void()> keep = {})
      : cut_(std::move(folder)), to_(std::move(to)), rng_(rng), keep_(std::move(keep)) {
    recald::testing::before_file_change = [this](const FileChange& change) {
      if (!busy_) take(change);
      return 0;
    };
  }
  ~Images() { recald::testing::before_file_change = {}; }
  Images(const Images&) = delete;
  Images& operator=(const Images&) = delete;

  bool heeds_syncs = true;

  [[nodiscard]] int taken() const { return taken_; }
  [[nodiscard]] std::filesystem::path image(int number) const {
    return to_ / std::to_string(number);
  }

 private:
  void take(const FileChange& change) {
    busy_ = true;
    if (rng_.below(4) == 0) {
      if (keep_) keep_();
      cut_.write_image(rng_, image(taken_++));
    }
    if (heeds_syncs || !change.call.ends_with("sync")) cut_.watch(change);
    busy_ = false;
  }

  recald::testing::PowerCut cut_;
  std::filesystem::path to_;
  Rng& rng_;
  std::function<void()> keep_;
  int taken_ = 0;
  bool busy_ = false;
};

/// A damaged store with two hundred intervals and their samples, of which one page is gone.
class RecoveryEdges : public ::testing::Test {
 protected:
  static constexpr int kQuarters = 400;

  RecoveryEdges() {
    std::filesystem::create_directory(folder_ / "before");
    auto store = sqlite::SqliteStore::open(folder_ / "before" / "site.db").value();
    const std::uint32_t meter = store.meter_number("main", kQuarter).value();
    StoreBatch batch;
    double register_kWh = 0.0;
    for (int i = 0; i <= kQuarters; ++i) {
      batch.samples.push_back({meter, "energy", kRigStart + i * kQuarter, register_kWh});
      if (i == kQuarters) break;
      batch.intervals.push_back({{meter, kRigStart + i * kQuarter, 4.0 * i}});
      register_kWh += i;
    }
    RegisterState state{.field = "energy", .settings = {.rated_kW = 10'000.0}};
    state.book.next = kRigStart + kQuarters * kQuarter;
    batch.registers.push_back({meter, state});
    EXPECT_TRUE(store.commit(batch).has_value());
    config_.backup_folder = folder_ / "backups";
  }

  void begin_anew() {
    std::filesystem::remove_all(folder_ / "work");
    std::filesystem::copy(folder_ / "before", folder_ / "work");
    recald::testing::damage_leaf(folder_ / "work" / "site.db", "interval", 1);
    config_.file = folder_ / "work" / "site.db";
  }

  /// The same, with a last sample that is only in the log yet.
  void begin_anew_with_log() {
    begin_anew();
    const auto logged = folder_ / "logged";
    std::filesystem::remove_all(logged);
    std::filesystem::create_directory(logged);
    {
      auto store = sqlite::SqliteStore::open(config_.file).value();
      const Instant last = kRigStart + (kQuarters + 1) * kQuarter;
      EXPECT_TRUE(store.commit({.samples = {{0, "energy", last, 1e6}}}).has_value());
      for (const char* name : {"site.db", "site.db-wal"}) {
        std::filesystem::copy(folder_ / "work" / name, logged / name);
      }
    }
    std::filesystem::remove_all(folder_ / "work");
    std::filesystem::rename(logged, folder_ / "work");
  }

  void expect_whole() { expect_whole(folder_ / "work"); }

  /// Opens it undisturbed: nothing may be missing, and it says what happened.
  void expect_whole(const std::filesystem::path& work) {
    config_.file = work / "site.db";
    const bool was_renamed = std::filesystem::exists(config_.file) && has_damaged(work);
    auto opened = open_store(config_, kRigStart + hours{200});
    ASSERT_TRUE(opened.has_value()) << opened.error().message;
    if (was_renamed) {
      EXPECT_EQ(opened->recovery, "");  // what is whole is not made again
    }
    Store& store = *opened->store;
    int count = 0;
    double sum_kWh = 0.0;
    const auto read = store.for_each_interval(0, {Instant::min(), Instant::max()},
                                              [&](const StoredInterval& interval) {
                                                ++count;
                                                sum_kWh += interval.reading.mean_kW / 4.0;
                                              });
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(count, kQuarters);
    EXPECT_NEAR(sum_kWh, kQuarters * (kQuarters - 1) / 2.0, 1e-6);
    EXPECT_EQ(store.registers(0)->size(), 1u);
    const auto events = store.events(10).value();
    ASSERT_THAT(events, ::testing::SizeIs(1));
    EXPECT_EQ(events.front().kind, "store_recovered");
    const auto checked = store.check().value();
    EXPECT_EQ(checked.damage, "");
    EXPECT_THAT(checked.problems, ::testing::IsEmpty());
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator{work}) {
      names.insert(entry.path().filename().string());
    }
    EXPECT_FALSE(names.contains("site.db.recovery"));
    EXPECT_FALSE(names.contains("site.db.recovering"));
    EXPECT_TRUE(has_damaged(work));
  }

  static bool has_damaged(const std::filesystem::path& work) {
    return std::ranges::any_of(std::filesystem::directory_iterator{work}, [](const auto& entry) {
      return entry.path().filename().string().ends_with("Z") &&
             entry.path().filename().string().starts_with("site.db.damaged-");
    });
  }

  TemporaryFolder folder_;
  StoreConfig config_;
};

TEST_F(RecoveryEdges, KilledAtAnyStepItGoesOn) {
  int steps = 0;
  for (bool is_done = false; !is_done;) {
    SCOPED_TRACE(++steps);
    begin_anew();
    is_done = ends_before(steps, [&] { (void)open_store(config_, kRigStart + hours{100}); });
    expect_whole();
    if (HasFailure()) return;
  }
  EXPECT_GE(steps, 30);
}

// The log goes first: an old one beside the new store would be read with it. Somebody else has the
// file open, or SQLite had moved the log into the file before.
TEST_F(RecoveryEdges, KilledWhileItPutsALogAsideItGoesOn) {
  bool is_aside = false;
  for (int nth = 1; !is_aside; ++nth) {
    SCOPED_TRACE(nth);
    begin_anew_with_log();
    ASSERT_FALSE(ends_before(nth, [&] {
      const auto other =
          sqlite::Database::open(config_.file, {.access = sqlite::Database::Access::read_only});
      (void)open_store(config_, kRigStart + hours{100});
    }));
    is_aside = std::filesystem::exists(folder_ / "work" / "site.db.recovering");
    expect_whole();
    int samples = 0;
    const auto read =
        sqlite::SqliteStore::open(config_.file)
            .value()
            .for_each_sample(0, "energy", [&](const metering::RegisterSample&) { ++samples; });
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(samples, kQuarters + 2);
    if (HasFailure()) return;
  }
}

TEST_F(RecoveryEdges, AnyStepMayFailOnceOrForGood) {
  const bool has_time = std::getenv("RECALD_EDGE_KILLS") != nullptr;
  for (const int error : {EIO, ENOSPC}) {
    for (const bool lasting : {false, true}) {
      // A disk's error passes, a full one stays; the other way round only where there is time.
      if (lasting != (error == ENOSPC) && !has_time) continue;
      bool has_failed = true;
      for (int nth = 1; has_failed; ++nth) {
        SCOPED_TRACE(fmt::format("errno {}, change {}, lasting {}", error, nth, lasting));
        begin_anew();
        {
          const FailingChanges faults{nth, error, lasting};
          (void)open_store(config_, kRigStart + hours{100});
          has_failed = faults.has_failed();
        }
        expect_whole();
        if (HasFailure()) return;
      }
    }
  }
}

TEST_F(RecoveryEdges, APowerCutAtAnyStepCostsNothing) {
  const int wanted = given_or("RECALD_EDGE_CUTS", 60);
  Rng rng{1};
  for (int seen = 0; seen < wanted;) {
    begin_anew();
    Images images{folder_ / "work", folder_ / "images", rng};
    ASSERT_TRUE(open_store(config_, kRigStart + hours{100}).has_value());
    recald::testing::before_file_change = {};
    for (int i = 0; i < images.taken(); ++i) {
      SCOPED_TRACE(fmt::format("seed 1, image {}", ++seen));
      expect_whole(images.image(i));
      if (HasFailure()) return;
    }
  }
}

TEST_F(RecoveryEdges, AnInterruptedOneSaysSo) {
  for (int nth = 1; !std::filesystem::exists(folder_ / "work" / "site.db.recovering"); ++nth) {
    begin_anew();
    ASSERT_FALSE(ends_before(nth, [&] { (void)open_store(config_, kRigStart + hours{100}); }));
  }
  const auto opened = open_store(config_, kRigStart + hours{101}).value();
  EXPECT_THAT(opened.recovery, ::testing::HasSubstr("it was interrupted and has been done again"));
}

// A reserve that lies beside a store that cannot even be opened.
TEST_F(RecoveryEdges, AFullDiskAtTheStartTakesTheReserve) {
  begin_anew();
  expect_whole();
  recald::testing::write_text(reserve_file(config_), "room");
  recald::testing::before_file_change = [&](const FileChange& change) {
    const bool grows = change.call.starts_with("open") || change.call.starts_with("pwrite");
    return grows && std::filesystem::exists(reserve_file(config_)) ? ENOSPC : 0;
  };
  const auto opened = open_store(config_, kRigStart + hours{300});
  recald::testing::before_file_change = {};
  ASSERT_TRUE(opened.has_value()) << opened.error().message;
  EXPECT_EQ(opened->recovery, "");
  EXPECT_FALSE(std::filesystem::exists(reserve_file(config_)));
}

/// A gateway with its jobs and upkeep on a store on disk.
class Life {
 public:
  /// @param on_commit  Told of each batch once it is committed; may be empty.
  Life(const std::filesystem::path& folder, VirtualLoop& loop,
       std::function<void(const StoreBatch&)> on_commit = {})
      : on_commit_(std::move(on_commit)),
        site_(testing::load_rig_site(folder, testing::two_meter_site())),
        loop_(loop) {
    site_.store.backup_at = minutes{0};
  }

  /// Begins a process: as the daemon does, again after a while where it cannot.
  void begin() {
    end();
    auto opened = open_store(site_.store, loop_.now().instant());
    if (!opened) return;
    behind_ = std::move(opened->store);
    store_ = std::make_unique<FailingStore>(*behind_);
    store_->after_commit = on_commit_;
    worker_ = std::make_unique<VirtualWorker>(loop_, minutes{3});
    jobs_ = std::make_unique<JobRunner>(
        JobRunner::Ports{loop_, *store_, *worker_},
        [](const StoredJob&, Instant, const GoesOn&) -> Result<JobOutcome> {
          return JobOutcome{.accepted = true, .result = {.document = "{}"}};
        },
        OnJob{});
    rig_ = std::make_unique<Rig>(*store_, loop_);
    if (!rig_->open(site_)) return end();
    upkeep_ = std::make_unique<Upkeep>(
        *store_, checker_, site_.store, metering::LocalCalendar::open(site_.timezone).value(),
        [this](StoreEvent event) { rig_->note(std::move(event)); },
        UpkeepRules{.reserve_bytes = 64 * 1024});
    jobs_->resume();
  }
  void end() {
    jobs_.reset();
    upkeep_.reset();
    rig_.reset();
    worker_.reset();
    store_.reset();
    behind_.reset();
  }
  [[nodiscard]] bool runs() const { return upkeep_ != nullptr; }

  /// Half an hour with all that a daemon does in one.
  void live() {
    loop_.run_for(minutes{4});
    (void)jobs_->ask(JobKind::calibration, "api");
    loop_.run_for(minutes{4});
    for (int i = 0; i < 100 && upkeep_->maintain(loop_.now().instant()) < seconds{1}; ++i) {
    }
    (void)rig_->reload(site_);
    loop_.run_for(minutes{22});
  }

  [[nodiscard]] Store& store() { return *store_; }
  [[nodiscard]] const SiteConfig& site() const { return site_; }

 private:
  class Rig : public testing::GatewayRig {
   public:
    Rig(Store& store, VirtualLoop& loop) : GatewayRig{store, loop, kRigStart} {}
    void note(StoreEvent event) { gateway_->note(std::move(event)); }
  };

  std::function<void(const StoreBatch&)> on_commit_;
  SiteConfig site_;
  VirtualLoop& loop_;
  VirtualWorker checker_{loop_, minutes{1}};
  std::unique_ptr<Store> behind_;
  std::unique_ptr<FailingStore> store_;
  std::unique_ptr<VirtualWorker> worker_;
  std::unique_ptr<JobRunner> jobs_;
  std::unique_ptr<Rig> rig_;
  std::unique_ptr<Upkeep> upkeep_;
};

/// What a store must hold after a life: the energy of both meters, its jobs ended, nothing damaged.
void expect_all_there(Life& life, VirtualLoop& loop) {
  Store& store = life.store();
  const auto checked = store.check().value();
  EXPECT_EQ(checked.damage, "");
  EXPECT_THAT(checked.problems, ::testing::IsEmpty());
  EXPECT_EQ(testing::what_energy_is_wrong(store), "");
  for (std::uint32_t meter = 0; meter < 2; ++meter) {
    const auto extent = store.interval_extent(meter).value();
    ASSERT_TRUE(extent.has_value());
    EXPECT_LE(extent->begin, kRigStart + minutes{45});
    EXPECT_GE(extent->end + kQuarter + minutes{16}, loop.now().instant());
  }
  const auto jobs = store.jobs(JobKind::calibration, 10).value();
  for (const StoredJob& job : jobs) EXPECT_EQ(job.state, JobState::done) << job.message;
}

// The n-th change of a file fails, n raised until a life passes without any.
TEST(LifeEdges, AnyStepMayFail) {
  for (const int error : {EIO, ENOSPC}) {
    bool has_failed = true;
    int nth = 1;
    for (; has_failed; nth += nth < 60 ? 1 : 7) {
      SCOPED_TRACE(fmt::format("errno {}, change {}", error, nth));
      const TemporaryFolder folder;
      VirtualLoop loop{kRigStart};
      Life life{folder.path(), loop};
      {
        const FailingChanges faults{nth, error, false};
        life.begin();
        if (life.runs()) life.live();
        has_failed = faults.has_failed();
      }
      if (!life.runs()) life.begin();
      ASSERT_TRUE(life.runs());
      life.live();
      life.live();
      expect_all_there(life, loop);
      if (::testing::Test::HasFailure()) return;
    }
    EXPECT_GE(nth, 100);
  }
}

TEST(LifeEdges, KilledAtAnyMomentItLosesNothing) {
  const int kills_wanted = given_or("RECALD_EDGE_KILLS", 100);
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "site");
  const testing::SharedWitness witness{kRigStart};
  Rng rng{1};
  for (int kill = 0; kill < kills_wanted; ++kill) {
    SCOPED_TRACE(fmt::format("seed 1, kill {}", kill));
    const int steps = 1 + static_cast<int>(rng.below(400));
    const bool is_done = ends_before(steps, [&] {
      VirtualLoop loop{witness->now};
      const auto until = recald::testing::before_file_change;
      recald::testing::before_file_change = [&](const FileChange& change) {
        witness->now = loop.now().wall;
        return until(change);
      };
      Life life{folder / "site", loop, [&](const StoreBatch& batch) { witness->add(batch); }};
      life.begin();
      for (int i = 0; i < 1000; ++i) life.live();
    });
    ASSERT_FALSE(is_done);
    witness->now += std::chrono::milliseconds{rng.below(40'000)};  // until it is started again
    const std::filesystem::path copy = folder / "looked-at";
    std::filesystem::remove_all(copy);
    std::filesystem::copy(folder / "site", copy, std::filesystem::copy_options::recursive);
    const auto opened = stores::open_checked(copy / "site.db", {}, kRigStart);
    ASSERT_TRUE(opened.has_value()) << opened.error().message;
    EXPECT_EQ(opened->recovery, "");
    if (!opened->store->find_meter("cooling").value()) continue;
    EXPECT_EQ(testing::what_is_wrong(*opened->store, 2, witness->all()), "");
    EXPECT_EQ(testing::what_energy_is_wrong(*opened->store), "");
    if (::testing::Test::HasFailure()) return;
  }
  // Of its jobs none waits for ever: three kills at the most each.
  VirtualLoop loop{witness->now};
  Life life{folder / "site", loop};
  life.begin();
  life.live();
  const auto jobs = life.store().jobs(JobKind::calibration, 100'000).value();
  EXPECT_THAT(jobs, ::testing::Not(::testing::IsEmpty()));
  for (const StoredJob& job : jobs) EXPECT_TRUE(job.ended.has_value()) << job.number;
}

/// What is wrong with what a power cut left of a site; empty: nothing. Its backups count too.
std::string what_is_wrong_with(const std::filesystem::path& image,
                               std::span<const testing::Promise> promises) {
  const std::filesystem::path file = image / "site.db";
  if (!std::filesystem::exists(file)) return promises.empty() ? "" : "the store is lost";
  const auto opened = stores::open_checked(file, {}, kRigStart);
  if (!opened) return opened.error().message;
  if (!opened->recovery.empty()) return opened->recovery;
  for (const auto& entry : std::filesystem::recursive_directory_iterator{image}) {
    if (!entry.path().filename().string().ends_with(".db") || entry.path() == file) continue;
    auto backup = sqlite::SqliteStore::open(entry.path());
    if (!backup) return entry.path().string() + ": " + backup.error().message;
    const auto checked = backup->check();
    if (!checked || !checked->damage.empty()) return "damaged: " + entry.path().string();
  }
  const auto known = opened->store->find_meter("cooling");
  if (!known || !*known) return promises.empty() ? "" : "the meters are lost";
  const std::string wrong = testing::what_is_wrong(*opened->store, 2, promises);
  return wrong.empty() ? testing::what_energy_is_wrong(*opened->store) : wrong;
}

/// Opens, reloads, backs up and works until so many images were looked at.
/// @return what is wrong with any of them.
std::vector<std::string> live_with_power_cuts(int wanted, bool heeds_syncs) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "site");
  VirtualLoop loop{kRigStart};
  std::vector<testing::Promise> promises;
  Life life{folder / "site", loop,
            [&](const StoreBatch& batch) { testing::promise(batch, promises); }};
  Rng rng{1};
  std::vector<std::string> wrong;
  std::vector<std::size_t> promised;
  for (int seen = 0; seen < wanted;) {
    promised.clear();
    life.end();
    Images images{folder / "site", folder / "images", rng,
                  [&] { promised.push_back(promises.size()); }};
    images.heeds_syncs = heeds_syncs;
    life.begin();
    if (!life.runs()) return {"it does not open"};
    life.live();
    recald::testing::before_file_change = {};
    for (int i = 0; i < images.taken(); ++i, ++seen) {
      auto found = what_is_wrong_with(images.image(i), std::span{promises}.first(promised[i]));
      if (!found.empty()) wrong.push_back(fmt::format("seed 1, image {}: {}", seen, found));
    }
  }
  return wrong;
}

TEST(LifeEdges, APowerCutAtAnyMomentCostsNothing) {
  EXPECT_THAT(live_with_power_cuts(given_or("RECALD_EDGE_CUTS", 60), true), ::testing::IsEmpty());
}

// The test above would see a sync that is forgotten.
TEST(LifeEdges, WithoutSyncsAPowerCutDoesCost) {
  EXPECT_THAT(live_with_power_cuts(60, false), ::testing::SizeIs(::testing::Ge(5)));
}

}  // namespace
}  // namespace recald::daemon::edges_test
