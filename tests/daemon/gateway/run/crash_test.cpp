/// kill_at_any_commit: the gateway runs in a process of its own that ends without a word at a given
/// step of its writing. Nothing acknowledged is lost, nothing is doubled, the month is exact.
///
/// RECALD_KILLS: how often it is killed in a month, 300 unless set.
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include "daemon/gateway/upkeep/open_store.hpp"
#include "tests/daemon/gateway/gateway_rig.hpp"
#include "tests/daemon/gateway/run/witness.hpp"
#include "tests/support/failing_store.hpp"
#include "tests/support/faulty_disk.hpp"
#include "tests/support/seed.hpp"

namespace recald::daemon::crash_test {
namespace {

using recald::testing::FailingStore;
using recald::testing::FaultyDisk;
using recald::testing::given_or;
using recald::testing::Seed;
using recald::testing::TemporaryFolder;
using recald::testing::VirtualLoop;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using testing::kRigStart;
using WallTime = std::chrono::sys_time<milliseconds>;

constexpr std::uint32_t kMeters = 2;
constexpr double kTick_kWh = 0.1 + 1e-6;  // two registers of 0.1 kWh bound an energy
constexpr int kKilled = 9;
constexpr int kWholeRun = 0;

class Crash : public ::testing::Test {
 protected:
  /// A process of its own runs the gateway from `witness_->now` until `end`, or until it has taken
  /// so many steps of writing. @return its exit code.
  int run_process(const std::filesystem::path& file, WallTime end, std::uint64_t steps_max) {
    const pid_t child = ::fork();
    if (child == 0) {
      try {
        run_gateway(file, end, steps_max);
      } catch (...) {
        ::_exit(1);
      }
      ::_exit(kWholeRun);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  void run_gateway(const std::filesystem::path& file, WallTime end, std::uint64_t steps_max) {
    VirtualLoop loop{witness_->now};
    FaultyDisk disk{"crash"};
    std::uint64_t steps = 0;
    disk.before = [&](const FaultyDisk::Step& step) {
      witness_->now = loop.now().wall;
      if (step.operation == FaultyDisk::Operation::read) return 0;
      if (++steps == steps_max) ::_exit(kKilled);
      return 0;
    };
    auto store = sqlite::SqliteStore::open(file, {.vfs = disk.name()});
    if (!store) throw std::runtime_error(store.error().message);
    FailingStore watched{*store};
    watched.after_commit = [&](const StoreBatch& batch) { witness_->add(batch); };
    testing::GatewayRig rig{watched, loop, testing::kRigStart};
    rig.begin(site_);
    loop.run_for(end - witness_->now);
    witness_->now = loop.now().wall;
  }

  /// Looks at a copy, so that the next process finds the files as the last one left them.
  std::string what_is_wrong(const std::filesystem::path& folder) {
    const std::filesystem::path copy = folder_ / "looked-at";
    std::filesystem::remove_all(copy);
    std::filesystem::copy(folder, copy);
    auto opened = open_store(default_store(copy / "site.toml"), witness_instant());
    if (!opened) return opened.error().message;
    if (!opened->recovery.empty()) return opened->recovery;
    Store& store = *opened->store;
    if (!store.find_meter("cooling").value()) return "";  // killed before it knew its meters
    const std::string wrong = testing::what_is_wrong(store, kMeters, witness_->all());
    return wrong.empty() ? testing::what_energy_is_wrong(store) : wrong;
  }

  [[nodiscard]] metering::Instant witness_instant() const {
    return std::chrono::floor<std::chrono::seconds>(witness_->now);
  }

  [[nodiscard]] std::filesystem::path make_folder(const char* name) const {
    std::filesystem::create_directory(folder_ / name);
    return folder_ / name;
  }

  TemporaryFolder folder_;
  SiteConfig site_ = testing::load_rig_site(folder_.path(), testing::two_meter_site());
  testing::SharedWitness witness_{kRigStart};
};

TEST_F(Crash, AtEveryStepOfOpeningAndOfCommits) {
  const std::filesystem::path before = make_folder("before");
  const WallTime begin = kRigStart + hours{5} + minutes{50};
  ASSERT_EQ(run_process(before / "site.db", begin, 0), kWholeRun);
  const std::size_t promised = witness_->count;
  for (std::uint64_t step = 1;; ++step) {
    const std::filesystem::path work = folder_ / "work";
    std::filesystem::remove_all(work);
    std::filesystem::copy(before, work);
    witness_->now = begin;
    witness_->count = promised;
    const int code = run_process(work / "site.db", begin + minutes{28}, step);
    ASSERT_EQ(what_is_wrong(work), "") << "killed at step " << step;
    if (code == kWholeRun) {
      EXPECT_GE(step, 60u);
      EXPECT_EQ(witness_->count, promised + 2 * kMeters);
      break;
    }
    ASSERT_EQ(code, kKilled) << "at step " << step;
  }
}

TEST_F(Crash, AMonthOfKillsCostsNothing) {
  const int kills_wanted = given_or("RECALD_KILLS", 300);
  const std::filesystem::path folder = make_folder("store");
  const WallTime end = kRigStart + days{37};
  const auto steps_a_kill = static_cast<std::uint64_t>(240'000 / kills_wanted);
  const Seed seed;
  Rng rng{seed.value()};
  int kills = 0;
  for (;;) {
    const bool kill = kills < kills_wanted;
    const int code = run_process(folder / "site.db", end, kill ? 1 + rng.below(steps_a_kill) : 0);
    ASSERT_EQ(what_is_wrong(folder), "") << "after kill " << kills;
    if (code == kWholeRun) break;
    ASSERT_EQ(code, kKilled);
    ++kills;
    witness_->now += milliseconds{rng.below(40'000)};  // until it is started again
  }
  EXPECT_EQ(kills, kills_wanted);
  auto store = sqlite::SqliteStore::open(folder / "site.db").value();
  const auto calendar = metering::LocalCalendar::open(site_.timezone).value();
  const metering::TimeSpan march = calendar.month_span(std::chrono::year{2024} / 3);
  const double true_kWh =
      testing::main_kWh(march.end - kRigStart) - testing::main_kWh(march.begin - kRigStart);
  EXPECT_NEAR(testing::stored_kWh(store, 0, march), true_kWh, kTick_kWh);
  const auto months = store.months(0).value();
  ASSERT_EQ(months.size(), 2u);
  const metering::MonthlyFigure& figure = months[1].figure;
  EXPECT_NEAR(figure.daily_average_kWh, true_kWh / 31.0, kTick_kWh);
  EXPECT_EQ(figure.slots_by_validity[static_cast<std::size_t>(metering::Validity::missing)], 0);
}

}  // namespace
}  // namespace recald::daemon::crash_test
