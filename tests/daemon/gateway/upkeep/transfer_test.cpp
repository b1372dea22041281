/// export, import and verify on the command line, over a store that a gateway filled.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "adapters/csv/fields.hpp"
#include "adapters/sqlite/sqlite_store.hpp"
#include "adapters/system/files/file_lock.hpp"
#include "adapters/system/time_zone_release.hpp"
#include "tests/daemon/command_line.hpp"
#include "tests/daemon/gateway/gateway_rig.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using recald::testing::read_text;
using recald::testing::TemporaryFolder;
using recald::testing::VirtualLoop;
using recald::testing::write_text;
using std::chrono::days;
using std::chrono::hours;
using ::testing::HasSubstr;
using testing::Outcome;
using testing::run;

/// Filled once: five weeks of two meters, an outage over the night, one month closed.
class Transfer : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    filled_ = std::make_unique<TemporaryFolder>();
    const SiteConfig site = testing::load_rig_site(filled_->path(), testing::two_meter_site());
    auto store = sqlite::SqliteStore::open(site.store.file).value();
    VirtualLoop loop{testing::kRigStart};
    {
      testing::GatewayRig rig{store, loop, testing::kRigStart};
      rig.begin(site);
      loop.run_for(days{4} + hours{2});
    }
    loop.run_for(hours{3});
    testing::GatewayRig rig{store, loop, testing::kRigStart};
    rig.begin(site);
    loop.run_for(days{34});
  }
  static void TearDownTestSuite() { filled_.reset(); }

  Transfer() {
    for (const char* name : {"site.toml", "counter.toml", "site.db"}) {
      std::filesystem::copy(*filled_ / name, folder_ / name);
    }
  }
  [[nodiscard]] std::string site() const { return folder_ / "site.toml"; }
  [[nodiscard]] std::string csv() const { return folder_ / "out.csv"; }
  [[nodiscard]] sqlite::SqliteStore store() const {
    return sqlite::SqliteStore::open(folder_ / "site.db").value();
  }
  Outcome import(const std::string& text, std::vector<std::string> options = {}) {
    write_text(csv(), text);
    std::vector<std::string> words{"import", site(), csv(), "--reason", "the logger's file"};
    words.insert(words.end(), options.begin(), options.end());
    return run(words);
  }
  /// A quarter of an hour of March that the outage made an estimate.
  static constexpr const char* kScaled = "2024-03-03T04:00:00Z";
  static constexpr const char* kMeasured = "2024-03-10T12:00:00Z";
  [[nodiscard]] StoredInterval stored(const char* stamp) const {
    const auto t = csv::parse_timestamp(stamp).value();
    std::optional<StoredInterval> found;
    auto opened = store();
    (void)opened.for_each_interval(0, {t, t + std::chrono::seconds{1}},
                                   [&](const StoredInterval& one) { found = one; });
    return found.value();
  }

  static std::unique_ptr<TemporaryFolder> filled_;
  TemporaryFolder folder_;
};
std::unique_ptr<TemporaryFolder> Transfer::filled_;

TEST_F(Transfer, ExportThenImportGivesTheSameReadingsAndMonths) {
  const Outcome readings = run({"export", site()});
  ASSERT_EQ(readings.exit_code, 0) << readings.err;
  EXPECT_THAT(readings.out, HasSubstr("timestamp,meter,value,unit,validity,late,reasons\n"));
  EXPECT_THAT(readings.out, HasSubstr(std::string{kScaled} + ",main,"));
  EXPECT_THAT(readings.out, HasSubstr("kW,scaled,0,"));
  const Outcome months = run({"export", site(), "--months"});
  EXPECT_THAT(months.out,
              HasSubstr("month,meter,value,unit,coverage,filled_share,peak_kW,peak_at,method,"
                        "revision,tzdata\n2024-02,main,"));
  std::filesystem::remove(folder_ / "site.db");
  const Outcome imported = import(readings.out);
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_EQ(run({"export", site()}).out, readings.out);
  // All months of 2024 have ended by now, so the last one closes as well.
  const std::string months_again = run({"export", site(), "--months"}).out;
  auto opened = store();
  const auto release = opened.months(0)->at(0).time_zone_release;
  std::string expected = months.out;
  for (auto at = expected.find(",2025b\n"); at != std::string::npos;
       at = expected.find(",2025b\n", at + 1)) {
    expected.replace(at + 1, 5, release);
  }
  std::istringstream lines{expected};
  for (std::string line; std::getline(lines, line);) EXPECT_THAT(months_again, HasSubstr(line));
}

TEST_F(Transfer, ExportTakesLocalDaysAndAFile) {
  const Outcome day =
      run({"export", site(), "--from", "2024-03-10", "--to", "2024-03-10", "--out", csv()});
  ASSERT_EQ(day.exit_code, 0) << day.err;
  const std::string text = read_text(csv());
  // The day that summer time begins: 23 hours.
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 2 * 92);
  EXPECT_THAT(text, HasSubstr("\n2024-03-10T06:00:00Z,main,"));
  EXPECT_EQ(run({"export", site(), "--from", "2024-03-10", "--to", "2024-03-09"}).exit_code, 2);
  EXPECT_EQ(run({"export", site(), "--from", "March"}).exit_code, 2);
}

TEST_F(Transfer, AnImportIsAnEditAndClosesTheMonthAgain) {
  ASSERT_EQ(stored(kScaled).reading.validity, metering::Validity::scaled);
  const std::string text =
      "timestamp,meter,value,unit\n" + std::string{kScaled} + ",main,77.5,kW\n";
  const Outcome imported = import(text);
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_THAT(imported.out, HasSubstr("1 readings: 1 stored"));
  const StoredInterval now = stored(kScaled);
  EXPECT_EQ(now.reading.mean_kW, 77.5);
  EXPECT_EQ(now.reading.validity, metering::Validity::ok);
  EXPECT_TRUE(now.reading.late);
  EXPECT_EQ(now.revision, 1);
  {
    auto opened = store();
    auto edits = opened.database().prepare("SELECT reason, sha256 FROM edit").value();
    ASSERT_TRUE(edits.step().value());
    EXPECT_EQ(edits.text(0), "the logger's file");
    EXPECT_EQ(edits.text(1).size(), 64u);
    EXPECT_FALSE(edits.step().value());
    EXPECT_EQ(opened.months(0)->at(1).figure.revision, 1);
  }
  // Once more: nothing new, no second edit.
  EXPECT_THAT(import(text).out, HasSubstr("0 stored, 1 already known"));
  auto opened = store();
  auto edits = opened.database().prepare("SELECT count(*) FROM edit").value();
  ASSERT_TRUE(edits.step().value());
  EXPECT_EQ(edits.integer(0), 1);
  EXPECT_EQ(opened.months(0)->at(1).figure.revision, 1);
}

TEST_F(Transfer, GoodReadingsStayUnlessSuperseded) {
  const double before = stored(kMeasured).reading.mean_kW;
  const std::string text =
      "timestamp,meter,value,unit\n" + std::string{kMeasured} + ",main,1.25,kW\n";
  EXPECT_THAT(import(text).out,
              HasSubstr("0 stored, 0 already known, 0 weaker than the stored ones, 1 in conf"));
  EXPECT_EQ(stored(kMeasured).reading.mean_kW, before);
  EXPECT_THAT(import(text, {"--supersede", "--dry-run"}).out,
              HasSubstr("dry run: 1 readings: 1 would be stored"));
  EXPECT_EQ(stored(kMeasured).reading.mean_kW, before);
  EXPECT_THAT(import(text, {"--supersede"}).out, HasSubstr("1 stored"));
  EXPECT_EQ(stored(kMeasured).reading.mean_kW, 1.25);
}

// end_stamped_import: slots shift by one, and the month's last quarter hour stays in the month.
TEST_F(Transfer, EndStampedImport) {
  std::filesystem::remove(folder_ / "site.db");
  // Midnight in Chicago ends January.
  const Outcome imported = import(
      "timestamp,meter,value,unit\n2024-02-01T05:45:00Z,main,10,kW\n"
      "2024-02-01T06:00:00Z,main,20,kW\n2024-02-01T06:15:00Z,main,30,kW\n",
      {"--stamps", "end"});
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_EQ(stored("2024-02-01T05:30:00Z").reading.mean_kW, 10.0);
  EXPECT_EQ(stored("2024-02-01T05:45:00Z").reading.mean_kW, 20.0);
  EXPECT_EQ(stored("2024-02-01T06:00:00Z").reading.mean_kW, 30.0);
  auto opened = store();
  EXPECT_EQ(opened.months(0)->at(0).figure.slots_by_validity[0], 2);  // January has both of its own
}

// A recovery that was refused by a full disk, and an import before the daemon starts again: a new
// store would hide all that the damaged one holds.
TEST_F(Transfer, AnImportGoesOnWithARecovery) {
  std::filesystem::rename(folder_ / "site.db", folder_ / "site.db.damaged-20240401T000000Z");
  write_text(folder_ / "site.db.recovery", "site.db.damaged-20240401T000000Z\nbad page\n");
  const std::uint64_t before =
      sqlite::SqliteStore::open(folder_ / "site.db.damaged-20240401T000000Z")
          .value()
          .check()
          .value()
          .intervals;
  const Outcome imported = import(
      "timestamp,meter,value,unit\n2024-02-01T00:00:00Z,main,4,kW\n"
      "2024-02-01T00:15:00Z,main,5,kW\n");
  EXPECT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_THAT(imported.err, HasSubstr("it is kept as 'site.db.damaged-20240401T000000Z'"));
  EXPECT_EQ(store().check().value().intervals, before + 2);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "site.db.recovery"));
}

TEST_F(Transfer, AFileWhoseHeaderIsDamagedIsToldSo) {
  ASSERT_TRUE(store().database().execute("PRAGMA user_version = 8").has_value());
  const Outcome verified = run({"verify", site()});
  EXPECT_EQ(verified.exit_code, 1);
  EXPECT_THAT(verified.err, HasSubstr("the file is damaged: its header says schema version 8"));
  EXPECT_THAT(verified.err,
              HasSubstr("the daemon recovers the rows that can be read when it starts"));
}

TEST_F(Transfer, NothingIsImportedWithoutReasonOrBesideADaemon) {
  write_text(csv(), "timestamp,meter,value,unit\n");
  EXPECT_EQ(run({"import", site(), csv()}).exit_code, 2);
  EXPECT_EQ(run({"import", site(), csv(), "--reason", " "}).exit_code, 2);
  const auto lock = system::FileLock::acquire(folder_ / "site.db.lock");
  ASSERT_TRUE(lock.has_value());
  const Outcome beside = run({"import", site(), csv(), "--reason", "r"});
  EXPECT_EQ(beside.exit_code, 1);
  EXPECT_THAT(beside.err, HasSubstr("is held by another recald"));
  EXPECT_THAT(beside.err, HasSubstr("stop the daemon, import, and start it again"));
}

TEST_F(Transfer, BadLinesAreToldAndKeptOut) {
  const Outcome imported = import("timestamp,meter,value,unit\n" + std::string{kScaled} +
                                  ",main,77.5,kW\n2024-03-03T04:15:00Z,nobody,1,kW\n");
  EXPECT_EQ(imported.exit_code, 0);
  EXPECT_THAT(
      imported.err,
      HasSubstr("out.csv: 1 meter is not configured, and its lines were left out: nobody (1)"));
  EXPECT_THAT(imported.out, HasSubstr("1 stored"));
  EXPECT_EQ(run({"import", site(), folder_ / "none.csv", "--reason", "r"}).exit_code, 1);
}

TEST_F(Transfer, ASoundStoreIsVerified) {
  const Outcome verified = run({"verify", site()});
  EXPECT_EQ(verified.exit_code, 0) << verified.err;
  EXPECT_THAT(verified.out, HasSubstr("the store is sound"));
  EXPECT_THAT(run({"verify", site(), "--json"}).out, HasSubstr("\"sound\": true"));
}

/// One way to break a store, and the sentence that finds it.
struct Fault {
  const char* name;
  const char* sql;
  const char* sentence;
};
constexpr Fault kFaults[] = {
    {"RevisionGap", "UPDATE interval SET revision = 2 WHERE meter = 0 AND t_start = 1710072000",
     "meter 'main': the revisions of the interval at 2024-03-10 12:00:00 UTC have a gap"},
    {"MonthGap", "UPDATE month SET revision = 1 WHERE meter = 1 AND month = '2024-03'",
     "meter 'cooling': the revisions of month 2024-03 have a gap"},
    {"Orphan", "PRAGMA foreign_keys = OFF; INSERT INTO sample VALUES (9, 0, 'energy', 1.0, NULL)",
     "table 'sample' has 1 rows that refer to a missing row"},
    {"OffGrid",
     "UPDATE interval SET t_start = t_start + 60 WHERE meter = 0 AND t_start = 1710072000",
     "meter 'main' has 1 intervals that are not on its interval grid"},
    {"State", "UPDATE register SET state = '{}' WHERE meter = 0",
     "meter 'main': the stored state of a register cannot be read"},
    {"Sum", "UPDATE interval SET mean_kW = mean_kW + 20 WHERE meter = 0 AND t_start = 1710072000",
     "meter 'main', 2024-03-10 UTC: its intervals sum to"},
    {"Month", "UPDATE month SET daily_average_kWh = 1 WHERE meter = 0 AND month = '2024-03'",
     "meter 'main', month 2024-03: 1.000 kWh/day stored,"},
};

TEST_F(Transfer, EachFaultHasItsSentence) {
  for (const Fault& fault : kFaults) {
    SCOPED_TRACE(fault.name);
    std::filesystem::copy(*filled_ / "site.db", folder_ / "site.db",
                          std::filesystem::copy_options::overwrite_existing);
    {
      auto opened = store();
      // The gateway closed its months under a release of the time zones that is not this machine's.
      const auto broken = opened.database().execute(fmt::format(
          "UPDATE month SET tzdata = '{}'; {}", system::time_zone_release(), fault.sql));
      ASSERT_TRUE(broken.has_value()) << broken.error().message;
    }
    const Outcome verified = run({"verify", site()});
    EXPECT_EQ(verified.exit_code, 1);
    EXPECT_THAT(verified.err, HasSubstr(fault.sentence));
  }
}

}  // namespace
}  // namespace recald::daemon
