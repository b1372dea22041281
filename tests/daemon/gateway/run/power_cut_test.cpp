/// power_cut_unsynced: the power goes while the gateway writes. What was not synced is lost, torn
/// or written in another order; what was acknowledged is there.
///
/// RECALD_CUTS: how often the power goes at least, 300 unless set.
#include <gmock/gmock.h>

#include "daemon/gateway/upkeep/open_store.hpp"
#include "tests/daemon/gateway/gateway_rig.hpp"
#include "tests/daemon/gateway/run/surviving_store.hpp"
#include "tests/support/failing_store.hpp"
#include "tests/support/faulty_disk.hpp"
#include "tests/support/seed.hpp"

namespace recald::daemon::power_cut_test {
namespace {

using recald::testing::FailingStore;
using recald::testing::FaultyDisk;
using recald::testing::Seed;
using recald::testing::TemporaryFolder;
using recald::testing::VirtualLoop;
using std::chrono::hours;
using std::chrono::milliseconds;
using testing::GatewayRig;
using testing::kRigStart;
using testing::Promise;

constexpr std::uint32_t kMeters = 2;
constexpr double kTick_kWh = 0.1 + 1e-6;  // two registers of 0.1 kWh bound an energy

/// A gateway that writes to a disk whose power may go at any step.
class PowerCut : public ::testing::Test {
 protected:
  /// Runs for a day, or as long as it takes, with cuts at random steps. The site is reloaded every
  /// hour, and jobs come and go. @return how many images it looked at.
  /// @param synchronous  As SQLite's pragma; the store's own is FULL.
  int run_with_cuts(const std::string& synchronous) {
    auto store = sqlite::SqliteStore::open(folder_ / "site.db", {.vfs = disk_.name()}).value();
    // Checkpoints are rare by nature; here every fourth commit or so makes one.
    EXPECT_TRUE(store.database().execute("PRAGMA wal_autocheckpoint=40").has_value());
    EXPECT_TRUE(store.database().execute("PRAGMA synchronous=" + synchronous).has_value());
    FailingStore watched{store};
    watched.after_commit = [&](const StoreBatch& batch) { testing::promise(batch, promises_); };
    disk_.before = [&](const FaultyDisk::Step& step) {
      const bool is_sync = step.operation == FaultyDisk::Operation::sync;
      const bool reads = step.operation == FaultyDisk::Operation::read;
      if (!reads && rng_.below(is_sync ? 2 : 8) == 0) cut();
      return 0;
    };
    GatewayRig rig{watched, loop_, kRigStart};
    rig.begin(site_);
    const int cuts = recald::testing::given_or("RECALD_CUTS", 0);
    for (int hour = 0; hour < 26 || (images_ < cuts && wrong_.empty()); ++hour) {
      loop_.run_for(hours{1});
      StoredJob job{.asked_by = "api", .asked = loop_.now().instant()};
      job.number = watched.add_job(job).value();
      EXPECT_TRUE(rig.reload(site_).has_value());
      job.state = JobState::done;
      job.ended = loop_.now().instant();
      EXPECT_TRUE(watched.put_job(job).has_value());
    }
    disk_.before = {};
    return images_;
  }

  /// The power goes now: the store is opened again from what is left, and goes on.
  void cut() {
    recald::testing::write_image(disk_.after_power_cut(rng_), folder_ / "left");
    ++images_;
    auto left = open_store(default_store(folder_ / "left" / "site.toml"), loop_.now().instant());
    const std::string wrong = what_is_wrong(left);
    if (!wrong.empty()) {
      wrong_.push_back(fmt::format("image {}: {}", images_, wrong));
    } else if (images_ % 20 == 0) {
      goes_on(*left->store);
    }
  }

  [[nodiscard]] std::string what_is_wrong(const Result<stores::CheckedStore>& left) const {
    if (!left) return left.error().message;
    if (!left->recovery.empty()) return left->recovery;
    const std::string wrong = testing::what_is_wrong(*left->store, kMeters, promises_);
    return wrong.empty() ? testing::what_energy_is_wrong(*left->store) : wrong;
  }

  /// A gateway that starts on what is left books all that the meters counted meanwhile.
  void goes_on(Store& left) {
    VirtualLoop loop{loop_.now().wall + milliseconds{17'000}};
    GatewayRig rig{left, loop, kRigStart};
    rig.begin(site_);
    loop.run_for(hours{2});
    const auto extent = left.interval_extent(0).value();
    ASSERT_TRUE(extent.has_value());
    const metering::TimeSpan span{extent->begin, extent->end + std::chrono::seconds{900}};
    EXPECT_GE(span.end, std::chrono::floor<std::chrono::seconds>(loop.now().wall) - hours{1});
    EXPECT_NEAR(testing::stored_kWh(left, 0, span),
                testing::main_kWh(span.end - kRigStart) - testing::main_kWh(span.begin - kRigStart),
                kTick_kWh)
        << "image " << images_;
  }

  TemporaryFolder folder_;
  SiteConfig site_ = testing::load_rig_site(folder_.path(), testing::two_meter_site());
  VirtualLoop loop_{kRigStart};
  FaultyDisk disk_{"power-cut"};
  Seed seed_;
  Rng rng_{seed_.value()};
  std::vector<Promise> promises_;
  std::vector<std::string> wrong_;
  int images_ = 0;
};

TEST_F(PowerCut, LosesNothingThatWasAcknowledged) {
  EXPECT_GE(run_with_cuts("FULL"), 300);
  EXPECT_GE(promises_.size(), 2u * 4 * 25);
  EXPECT_THAT(wrong_, ::testing::IsEmpty());
}

// The same with less syncing loses commits: these tests would see it.
TEST_F(PowerCut, WithoutASyncACommitItDoesLose) {
  EXPECT_GE(run_with_cuts("NORMAL"), 300);
  EXPECT_THAT(wrong_, ::testing::Contains(::testing::HasSubstr("was acknowledged and is lost")));
}

TEST_F(PowerCut, WithoutAnySyncTheFileItselfIsDamaged) {
  EXPECT_GE(run_with_cuts("OFF"), 300);
  EXPECT_THAT(wrong_, ::testing::SizeIs(::testing::Gt(images_ / 4)));
}

}  // namespace
}  // namespace recald::daemon::power_cut_test
