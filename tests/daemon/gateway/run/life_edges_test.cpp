/// A gateway's life where it begins, changes and ends, with trouble at each step: whatever call
/// that changes a file fails, is the moment of a signal, ends the process or is the last before a
/// power cut, nothing that was acknowledged is lost and no energy is wrong.
///
/// RECALD_ALL_EDGES=1: trouble comes at each step and not at every ninth of them.
/// RECALD_EDGE_KILLS: how often a daemon is killed that opens, reloads, backs up and works all the
/// time, 100 unless set. RECALD_EDGE_CUTS: of such a life, how many images of a power cut are
/// looked at, 60 unless set. RECALD_SEED: which steps, kills and images these are.
#include <gmock/gmock.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <ostream>

#include "tests/daemon/gateway/run/edges.hpp"
#include "tests/daemon/gateway/run/life.hpp"
#include "tests/daemon/gateway/run/witness.hpp"
#include "tests/support/damage.hpp"
#include "tests/support/seed.hpp"

namespace recald::daemon::life_edges_test {
namespace {

using metering::Instant;
using recald::testing::FileChange;
using recald::testing::given_or;
using recald::testing::Seed;
using recald::testing::TemporaryFolder;
using recald::testing::VirtualLoop;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using testing::ends_before;
using ::testing::HasSubstr;
using testing::Images;
using ::testing::IsEmpty;
using testing::JobFate;
using testing::kKilled;
using testing::kRigStart;
using testing::Life;
using testing::LifeWitness;
using testing::SharedWitness;

constexpr seconds kQuarter{900};
constexpr int kStride = 9;
constexpr std::array kSignals{SIGHUP, SIGUSR1, SIGTERM};

LifeWitness told(const SharedWitness& witness) {
  return {
      .on_commit = [&](const StoreBatch& batch) { witness->add(batch); },
      .on_job = [&](std::int64_t job) { witness->last_job = std::max(witness->last_job, job); }};
}

/// What is wrong with jobs that are over; empty: nothing.
/// @param disk_failed  Then a result may be one that could not be written.
std::string what_job_is_wrong(const Life& life, const StoredJob& job, bool disk_failed) {
  const auto wrong = [&](const std::string& what) {
    return fmt::format("job {}: {} ({})", job.number, what, job.message);
  };
  if (!job.ended) return wrong("has not ended");
  if (job.message.find("an earlier request is still waiting") != std::string::npos) {
    return job.state == JobState::cancelled ? "" : wrong("is not cancelled");
  }
  const auto folder = job_folder(life.site().store, job.kind, job.number);
  const bool is_failed = job.state == JobState::failed;
  if (is_failed && disk_failed && job.message.find(folder.string()) != std::string::npos) return "";
  switch (testing::fate_of(job.number)) {
    case JobFate::fails:
      return is_failed && job.message == "the chains do not agree" ? "" : wrong("has not failed");
    case JobFate::throws:
      return is_failed && job.message.find("no such parameter") != std::string::npos
                 ? ""
                 : wrong("has not failed of what it threw");
    case JobFate::accepted:
      break;
  }
  if (job.state != JobState::done || !job.accepted) return wrong("is not done");
  const auto file = folder / Life::kResultFile;
  return std::filesystem::exists(file) &&
                 recald::testing::read_text(file) == Life::result_of(job.number)
             ? ""
             : wrong("its result is lost");
}

/// What must hold after any trouble: the energy of both meters, what was acknowledged, every job.
void expect_all_there(Life& life, const SharedWitness& witness, Instant now, bool disk_failed) {
  Store& store = life.store();
  EXPECT_EQ(testing::what_is_wrong(store, 2, witness->all()), "");
  EXPECT_EQ(testing::what_energy_is_wrong(store), "");
  for (std::uint32_t meter = 0; meter < 2; ++meter) {
    const auto extent = store.interval_extent(meter).value();
    ASSERT_TRUE(extent.has_value());
    EXPECT_LE(extent->begin, kRigStart + minutes{45});
    EXPECT_GE(extent->end + kQuarter + minutes{16}, now);
  }
  const auto jobs = store.jobs(JobKind::calibration, 100).value();
  ASSERT_THAT(jobs, ::testing::Not(IsEmpty()));
  EXPECT_GE(jobs.front().number, witness->last_job);  // the newest first
  for (const StoredJob& job : jobs) EXPECT_EQ(what_job_is_wrong(life, job, disk_failed), "");
}

/// What comes at some change of a file.
struct Trouble {
  const char* name;
  int error = 0;       ///< With which the change fails;
  bool lasts = false;  ///< with it all of the half hour after it.
  int signal = 0;      ///< Arrives then; SIGKILL: the process ends before the change.
  friend void PrintTo(const Trouble& trouble, std::ostream* out) { *out << trouble.name; }
};

/// A life that begins with nothing, or with what days of life have left and a page of it damaged.
class LifeEdges : public ::testing::TestWithParam<std::tuple<Trouble, bool>> {
 protected:
  LifeEdges() {
    std::filesystem::create_directory(folder_ / "before");
    if (!is_damaged()) return;
    VirtualLoop loop{start_};
    Life life{folder_ / "before", loop};
    for (int day = 0; day < 2; ++day) {  // its backup is made when a day begins
      life.begin();
      life.live();
      life.live();
      life.end();
      loop.run_for(hours{24});
    }
    start_ = loop.now().wall;
    recald::testing::damage_leaf(folder_ / "before" / "site.db", "interval", 0);
  }

  [[nodiscard]] const Trouble& trouble() const { return std::get<0>(GetParam()); }
  [[nodiscard]] bool is_damaged() const { return std::get<1>(GetParam()); }

  [[nodiscard]] std::filesystem::path begin_anew() const {
    const std::filesystem::path work = folder_ / "work";
    std::filesystem::remove_all(work);
    std::filesystem::copy(folder_ / "before", work, std::filesystem::copy_options::recursive);
    return work;
  }

  /// A process that ends before the n-th change. @return whether there are so many.
  [[nodiscard]] bool is_killed(const std::filesystem::path& work, int nth,
                               const SharedWitness& witness) const {
    return !ends_before(nth, [&] {
      VirtualLoop loop{start_};
      const auto until = recald::testing::before_file_change;
      recald::testing::before_file_change = [&](const FileChange& change) {
        witness->now = loop.now().wall;
        return until(change);
      };
      Life life{work, loop, told(witness)};
      life.begin();
      life.live();
    });
  }

  /// Half an hour with the trouble at the n-th change. @return whether there are so many.
  [[nodiscard]] bool is_troubled(Life& life, int nth) const {
    int seen = 0;
    recald::testing::before_file_change = [&](const FileChange&) {
      const bool is_now = ++seen == nth || (trouble().lasts && seen > nth);
      if (!is_now) return 0;
      if (trouble().signal != 0) life.signal(trouble().signal);
      return trouble().error;
    };
    life.begin();
    if (life.runs()) life.live();
    recald::testing::before_file_change = {};
    return seen >= nth;
  }

  TemporaryFolder folder_;
  std::chrono::sys_time<milliseconds> start_ = kRigStart;
};

TEST_P(LifeEdges, AnyStepMayBringTrouble) {
  const Seed seed;
  const int stride = std::getenv("RECALD_ALL_EDGES") != nullptr ? 1 : kStride;
  int nth = stride == 1 ? 1 : 1 + static_cast<int>(seed.value() % kStride);
  for (bool has_come = true; has_come; nth += stride) {
    SCOPED_TRACE(fmt::format("change {}", nth));
    const std::filesystem::path work = begin_anew();
    const SharedWitness witness{start_};
    const bool is_kill = trouble().signal == SIGKILL;
    if (is_kill) has_come = is_killed(work, nth, witness);
    VirtualLoop loop{is_kill ? witness->now + seconds{17} : start_};
    Life life{work, loop, told(witness)};
    if (!is_kill) has_come = is_troubled(life, nth);
    if (!life.runs()) life.begin();
    ASSERT_TRUE(life.runs());
    life.live();
    life.live();
    life.finish_jobs();
    expect_all_there(life, witness, loop.now().instant(), trouble().error != 0);
    if (HasFailure()) return;
  }
  EXPECT_GE(nth, 100);
}

INSTANTIATE_TEST_SUITE_P(
    Trouble, LifeEdges,
    ::testing::Combine(::testing::Values(Trouble{"io_error", EIO}, Trouble{"io_errors", EIO, true},
                                         Trouble{"disk_full_once", ENOSPC},
                                         Trouble{"disk_full", ENOSPC, true},
                                         Trouble{"sighup", 0, false, SIGHUP},
                                         Trouble{"sigusr1", 0, false, SIGUSR1},
                                         Trouble{"sigterm", 0, false, SIGTERM},
                                         Trouble{"sigkill", 0, false, SIGKILL}),
                       ::testing::Bool()),
    [](const auto& made) {
      return std::string{std::get<0>(made.param).name} +
             (std::get<1>(made.param) ? "_damaged" : "_new");
    });

/// A site's folder as the daemon opens it, its backups beside it.
Result<stores::CheckedStore> open_as_the_daemon(const std::filesystem::path& folder, Instant now) {
  return open_store(default_store(folder / "site.toml"), now);
}

/// Lives until it is killed, with signals now and then, and jobs that end the process themselves.
class RandomLife {
 public:
  RandomLife(std::filesystem::path folder, std::uint64_t seed) : folder_(folder), rng_(seed) {}

  /// A process until its end: that of a random change of a file, or one of those of its jobs.
  void live_until_killed() {
    const int steps = 1 + static_cast<int>(rng_.below(400));
    const bool is_done = ends_before(steps, [&] {
      VirtualLoop loop{witness_->now};
      LifeWitness told_of = told(witness_);
      told_of.on_work = [](std::int64_t job) {
        if (job % kKillerJobs == 0) ::_exit(kKilled);
      };
      Life life{folder_, loop, told_of};
      const auto until = recald::testing::before_file_change;
      recald::testing::before_file_change = [&](const FileChange& change) {
        witness_->now = loop.now().wall;
        if (rng_.below(60) == 0) life.signal(kSignals.at(rng_.below(kSignals.size())));
        return until(change);
      };
      life.begin();
      for (int i = 0; i < 1000; ++i) life.live();
    });
    ASSERT_FALSE(is_done);
    witness_->now += milliseconds{rng_.below(40'000)};  // until it is started again
  }

  /// Now and then the disk spoils a page of intervals while nobody looks; samples make them again.
  /// @return whether it did.
  bool spoil_now_and_then() {
    if (rng_.below(25) != 0 || witness_->count < 40) return false;
    recald::testing::damage_leaf(folder_ / "site.db", "interval", 0);
    return true;
  }

  SharedWitness& witness() { return witness_; }

  static constexpr std::int64_t kKillerJobs = 40;

 private:
  std::filesystem::path folder_;
  Rng rng_;
  SharedWitness witness_{kRigStart};
};

/// @param is_spoilt  The disk spoils pages meanwhile.
void expect_kills_lose_nothing(bool is_spoilt) {
  // An interval across a restart is made again between the same two reads, some steps apart.
  const double tolerance_kW = is_spoilt ? 0.1 / 0.25 + 1e-6 : testing::kRounding_kW;
  const int kills = given_or("RECALD_EDGE_KILLS", 100);
  const Seed seed;
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "site");
  RandomLife killed{folder / "site", seed.value()};
  const SharedWitness& witness = killed.witness();
  bool is_sound = true;
  for (int kill = 0; kill < kills; ++kill) {
    SCOPED_TRACE(fmt::format("kill {}", kill));
    killed.live_until_killed();
    const std::filesystem::path copy = folder / "looked-at";
    std::filesystem::remove_all(copy);
    std::filesystem::copy(folder / "site", copy, std::filesystem::copy_options::recursive);
    const auto opened = open_as_the_daemon(copy, std::chrono::floor<seconds>(witness->now));
    ASSERT_TRUE(opened.has_value()) << opened.error().message;
    if (is_sound) {
      EXPECT_EQ(opened->recovery, "");
    }
    is_sound = opened->recovery.empty();
    if (!opened->store->find_meter("cooling").value()) continue;
    EXPECT_EQ(testing::what_is_wrong(*opened->store, 2, witness->all(), tolerance_kW), "");
    EXPECT_EQ(testing::what_energy_is_wrong(*opened->store), "");
    if (::testing::Test::HasFailure()) return;
    is_sound = is_sound && !(is_spoilt && killed.spoil_now_and_then());
  }
  // Of its jobs none waits for ever, nor ends the process for ever.
  VirtualLoop loop{witness->now};
  Life life{folder / "site", loop};
  life.begin();
  ASSERT_TRUE(life.runs());
  life.live();
  life.finish_jobs();
  const auto jobs = life.store().jobs(JobKind::calibration, 100'000).value();
  ASSERT_THAT(jobs, ::testing::Not(IsEmpty()));
  EXPECT_GE(jobs.front().number, witness->last_job);
  for (const StoredJob& job : jobs) {
    if (job.state == JobState::failed && job.message.starts_with("recald was killed 3 times"))
      continue;
    EXPECT_EQ(what_job_is_wrong(life, job, false), "");
  }
}

TEST(LifeKills, AtAnyMomentTheyLoseNothing) { expect_kills_lose_nothing(false); }

TEST(LifeKills, OfASpoiltStoreTheyLoseNothing) { expect_kills_lose_nothing(true); }

/// What is wrong with what a power cut left of a site; empty: nothing. Its backups count too.
std::string what_is_wrong_with(const std::filesystem::path& image,
                               std::span<const testing::Promise> promises) {
  const std::filesystem::path file = image / "site.db";
  if (!std::filesystem::exists(file)) return promises.empty() ? "" : "the store is lost";
  const auto opened = open_as_the_daemon(image, kRigStart);
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

/// Opens, reloads, backs up and works, with signals now and then, until so many images were looked
/// at. @return what is wrong with any of them.
std::vector<std::string> live_with_power_cuts(int wanted, bool heeds_syncs, std::uint64_t seed) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "site");
  VirtualLoop loop{kRigStart};
  std::vector<testing::Promise> promises;
  Life life{folder / "site", loop, {.on_commit = [&](const StoreBatch& batch) {
              testing::promise(batch, promises);
            }}};
  Rng rng{seed};
  std::vector<std::string> wrong;
  std::vector<std::size_t> promised;
  for (int seen = 0; seen < wanted;) {
    promised.clear();
    life.end();
    Images images{folder / "site", folder / "images", rng,
                  [&] { promised.push_back(promises.size()); }};
    images.heeds_syncs = heeds_syncs;
    images.between = [&] {
      if (rng.below(60) == 0) life.signal(kSignals.at(rng.below(kSignals.size())));
    };
    life.begin();
    if (!life.runs()) return {"it does not open"};
    life.live();
    recald::testing::before_file_change = {};
    for (int i = 0; i < images.taken(); ++i, ++seen) {
      auto found = what_is_wrong_with(images.image(i), std::span{promises}.first(promised[i]));
      if (!found.empty()) wrong.push_back(fmt::format("image {}: {}", seen, found));
    }
  }
  return wrong;
}

TEST(LifePowerCuts, AtAnyMomentTheyCostNothing) {
  const Seed seed;
  EXPECT_THAT(live_with_power_cuts(given_or("RECALD_EDGE_CUTS", 60), true, seed.value()),
              IsEmpty());
}

// The test above would see a sync that is forgotten.
TEST(LifePowerCuts, WithoutSyncsTheyDoCost) {
  const Seed seed;
  EXPECT_THAT(live_with_power_cuts(60, false, seed.value()), ::testing::Not(IsEmpty()));
}

}  // namespace
}  // namespace recald::daemon::life_edges_test
