/// A recovery with a fault at each step: whatever call that changes a file fails, ends the process
/// or is the last before a power cut, nothing that was stored is lost.
///
/// RECALD_EDGE_CUTS: how many images of a power cut are looked at, 60 unless set.
/// RECALD_ALL_EDGES=1: errors that pass and that stay, both of both kinds.
#include <gmock/gmock.h>

#include <cerrno>
#include <cstdlib>

#include "adapters/sqlite/sqlite_store.hpp"
#include "daemon/gateway/upkeep/open_store.hpp"
#include "tests/daemon/gateway/gateway_rig.hpp"
#include "tests/daemon/gateway/run/edges.hpp"
#include "tests/support/damage.hpp"
#include "tests/support/seed.hpp"

namespace recald::daemon::edges_test {
namespace {

using metering::Instant;
using recald::testing::FailingChanges;
using recald::testing::FileChange;
using recald::testing::given_or;
using recald::testing::Seed;
using recald::testing::TemporaryFolder;
using std::chrono::hours;
using std::chrono::seconds;
using testing::ends_before;
using testing::Images;
using testing::kRigStart;

constexpr seconds kQuarter{900};

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
  const bool has_time = std::getenv("RECALD_ALL_EDGES") != nullptr;
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
  const Seed seed;
  Rng rng{seed.value()};
  for (int seen = 0; seen < wanted;) {
    begin_anew();
    Images images{folder_ / "work", folder_ / "images", rng};
    ASSERT_TRUE(open_store(config_, kRigStart + hours{100}).has_value());
    recald::testing::before_file_change = {};
    for (int i = 0; i < images.taken(); ++i) {
      SCOPED_TRACE(fmt::format("image {}", ++seen));
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
  EXPECT_THAT(opened.recovery,
              ::testing::HasSubstr("the recovery was interrupted and has been repeated"));
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

}  // namespace
}  // namespace recald::daemon::edges_test
