/// A site file's [fleet] on the real loop, with a real broker and a record that the test plays.
#include "daemon/gateway/forward/forwarding.hpp"

#include <gmock/gmock.h>

#include "adapters/asio/asio_loop.hpp"
#include "adapters/ports/destination_cursors.hpp"
#include "adapters/sqlite/sqlite_store.hpp"
#include "tests/support/mosquitto.hpp"
#include "tests/support/played_record.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::forwarding_test {
namespace {

using metering::Instant;
using recald::testing::Mosquitto;
using recald::testing::PlayedRecord;
using recald::testing::TemporaryFolder;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::Contains;
using ::testing::ElementsAre;
using Mood = PlayedRecord::Mood;

const Instant kNoon = std::chrono::sys_days{std::chrono::year{2026} / 2 / 3} + hours{12};

class ForwardingTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Mosquitto::can_run()) GTEST_SKIP() << "mosquitto of Debian is not installed";
    ASSERT_TRUE(store_.keep_outbox_for({"fleet"}).has_value());
    ASSERT_TRUE(store_.put_cursor(history_cursor("fleet"), record::kHistorySent).has_value());
    ASSERT_TRUE(store_.commit({.intervals = {{{main_, kNoon, 4.0}}}}).has_value());
  }

  [[nodiscard]] std::shared_ptr<const SiteConfig> site(const std::string& fleet) const {
    return std::make_shared<const SiteConfig>(
        parse_site("[site]\nid = \"depot\"\ntimezone = \"Europe/Berlin\"\n" + fleet +
                       "[[meter]]\nid = \"main\"\nsource = \"http\"\nutility = \"gas\"\n",
                   "/nowhere/site.toml")
            .value());
  }
  [[nodiscard]] std::string fleet() const {
    return "[fleet]\nurl = \"mqtt://127.0.0.1:" + std::to_string(broker_.port()) + "\"\n";
  }
  /// Of a destination that fails, nothing is tried again by itself while the test runs.
  void begin() {
    forwarding_ = std::make_unique<Forwarding>(
        Forwarding::Ports{.loop = loop_,
                          .store = store_,
                          .rules = {.retry_min = hours{1}, .retry_max = hours{1}}},
        site(fleet()), metering::LocalCalendar::open("Europe/Berlin").value(),
        [this](const StoreEvent& event) { told_.push_back(event.kind); }, [](const MeterValue&) {});
    forwarding_->start();
  }
  /// Runs the loop until then.
  template <class Condition>
  [[nodiscard]] bool soon(Condition condition) {
    for (int looks = 0; looks < 1500; ++looks) {
      if (condition()) return true;
      context_.run_for(milliseconds{20});
    }
    return false;
  }
  [[nodiscard]] bool is_told(const std::string& kind) const {
    return std::ranges::find(told_, kind) != told_.end();
  }

  TemporaryFolder folder_;
  sqlite::SqliteStore store_ = sqlite::SqliteStore::open(folder_ / "site.db").value();
  std::uint32_t main_ = store_.meter_number("main", seconds{900}).value();
  Mosquitto broker_;
  boost::asio::io_context context_{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{
      context_.get_executor()};
  asio::AsioLoop loop_{context_};
  std::vector<std::string> told_;
  std::unique_ptr<Forwarding> forwarding_;
};

TEST_F(ForwardingTest, ASignOfTheRecordEndsTheWait) {
  begin();
  ASSERT_TRUE(soon([&] { return is_told("forward_failed") && is_told("broker_lost"); }));
  const StoreEvent event{kNoon, Severity::info, "meter_silent", "main", "."};
  ASSERT_TRUE(store_.commit({.events = {event}}).has_value());
  ASSERT_TRUE(store_.add_job({.state = JobState::done, .asked_by = "api", .asked = kNoon}));
  broker_.start();
  const PlayedRecord record{broker_.port()};
  ASSERT_TRUE(soon([&] { return is_told("broker_found"); }));
  // Of what another outbox said; the record is there.
  broker_.send({.topic = "recald/v1/depot/watermark",
                .payload = record::to_json(record::Watermark{.outbox = 1, .until = {}}),
                .is_retained = true});
  EXPECT_TRUE(soon([&] { return !record.means_of("depot").empty(); }));
  EXPECT_TRUE(soon([&] { return is_told("forward_works"); }));
  EXPECT_EQ(forwarding_->status().at(0).waiting, 0);
  EXPECT_TRUE(soon([&] { return !record.of("depot").results.empty(); }));
  EXPECT_EQ(record.of("depot").events.at(0).kind, "meter_silent");
}

TEST_F(ForwardingTest, WhileTheRecordIsAwaitedEverythingElseGoesOn) {
  broker_.start();
  const PlayedRecord record{broker_.port(), Mood::away};
  broker_.send({.topic = "recald/v1/depot/watermark",
                .payload = record::to_json(record::Watermark{.outbox = 1, .until = {}}),
                .is_retained = true});
  begin();
  ASSERT_TRUE(soon([&] { return !record.payloads().empty(); }));
  int ticks = 0;
  std::function<void()> tick = [&] {
    ++ticks;
    loop_.after(milliseconds{1}, tick);
  };
  tick();
  EXPECT_TRUE(soon([&] { return ticks > 100; }));
  EXPECT_EQ(forwarding_->status().at(0).waiting, 1);
  forwarding_.reset();  // which does not wait for the record
}

TEST_F(ForwardingTest, AFleetThatIsTakenOutIsToldNothingMore) {
  broker_.start();
  const PlayedRecord record{broker_.port()};
  broker_.send({.topic = "recald/v1/depot/watermark",
                .payload = record::to_json(record::Watermark{.outbox = 1, .until = {}}),
                .is_retained = true});
  begin();
  ASSERT_TRUE(soon([&] { return !record.means_of("depot").empty(); }));
  ASSERT_TRUE(soon([&] { return forwarding_->status().at(0).waiting == 0; }));
  forwarding_->set_site(site(""));
  EXPECT_TRUE(forwarding_->status().empty());
  ASSERT_TRUE(store_.commit({.intervals = {{{main_, kNoon + hours{1}, 5.0}}}}).has_value());
  // Back again, it is told the past and then what comes, under another numbering.
  const std::int64_t before = record.of("depot").watermark.outbox;
  forwarding_->set_site(site(fleet()));
  ASSERT_TRUE(store_.commit({.intervals = {{{main_, kNoon + hours{2}, 6.0}}}}).has_value());
  EXPECT_TRUE(soon([&] { return record.means_of("depot").size() == 4; }));
  EXPECT_THAT(record.means_of("depot"), ElementsAre(4.0, 4.0, 5.0, 6.0));
  EXPECT_NE(record.of("depot").watermark.outbox, before);
}

}  // namespace
}  // namespace recald::daemon::forwarding_test
