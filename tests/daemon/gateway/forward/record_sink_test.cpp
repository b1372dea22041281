/// What a fleet's record gets through a real broker: everything, in order, whoever is away. The
/// test plays the record; the waits between attempts are on a virtual clock.
#include "daemon/gateway/forward/record_sink.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <functional>
#include <set>
#include <thread>
#include <utility>

#include "adapters/ports/destination_cursors.hpp"
#include "adapters/sqlite/sqlite_store.hpp"
#include "daemon/gateway/forward/forwarder.hpp"
#include "daemon/gateway/forward/outbox/outbox_identity.hpp"
#include "daemon/gateway/forward/outbox/store_outbox.hpp"
#include "tests/support/mosquitto.hpp"
#include "tests/support/played_record.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/virtual_loop.hpp"
#include "tests/support/virtual_worker.hpp"

namespace recald::daemon::record_sink_test {
namespace {

using metering::Instant;
using recald::testing::eventually;
using recald::testing::Mosquitto;
using recald::testing::MosquittoOptions;
using recald::testing::PlayedRecord;
using recald::testing::TemporaryFolder;
using recald::testing::VirtualLoop;
using recald::testing::VirtualWorker;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Mood = PlayedRecord::Mood;

const Instant kNoon = std::chrono::sys_days{std::chrono::year{2026} / 2 / 3} + hours{12};

/// Of a test in which the record answers, and of one in which it does not.
constexpr RecordRules kPatient{};
constexpr RecordRules kHasty{.confirm_max = milliseconds{200}};

class RecordSinkTest : public ::testing::Test {
 protected:
  explicit RecordSinkTest(const MosquittoOptions& options = {}) : broker_{options} {}
  void SetUp() override {
    if (!Mosquitto::can_run()) GTEST_SKIP() << "mosquitto of Debian is not installed";
    broker_.start();
  }

  /// A gateway starts: a connection of its own, and what the store has.
  void begin(const RecordRules& rules = kPatient, const ForwardRules& forward = {},
             std::int64_t waiting_max = kWaitingMax) {
    end();
    ASSERT_TRUE(store_.keep_outbox_for({"fleet"}).has_value());
    BrokerConfig broker;
    broker.host = "127.0.0.1";
    broker.port = broker_.port();
    broker.client_id = "gateway";
    link_ = RecordLink::open(
                broker, "depot", [this] { ++signs_; },
                [this](bool, const std::string& why) {
                  const std::scoped_lock lock{mutex_};
                  heard_.push_back(why);
                })
                .value();
    ASSERT_TRUE(is_connected());
    auto outbox = std::make_unique<StoreOutbox>(
        StoreOutbox::Ports{loop_, store_},
        Destination{.id = "fleet",
                    .words = "the fleet",
                    .wants_events = true,
                    .wants_results = true,
                    .has_identity = true,
                    .history = history_},
        [this](const StoreEvent& event) { told_.push_back(event.kind + ": " + event.text); },
        waiting_max);
    forwarder_ = std::make_unique<Forwarder>(
        loop_, std::make_unique<VirtualWorker>(loop_, seconds{1}), std::move(outbox),
        make_record_sink("depot", link_, rules), forward);
    forwarder_->poll_within(milliseconds{0});
  }
  void end() {
    forwarder_.reset();
    link_.reset();
  }
  [[nodiscard]] bool is_connected() const {
    return eventually([this] { return link_->is_connected(); });
  }

  /// Within virtual minutes.
  bool runs_until(const std::function<bool()>& is_so) {
    for (int i = 0; i < 600 && !is_so(); ++i) loop_.run_for(milliseconds{500});
    return is_so();
  }

  void store(int from, int until) {
    StoreBatch batch;
    for (int i = from; i < until; ++i) {
      batch.intervals.push_back({{main_, kNoon + i * seconds{900}, static_cast<double>(i)}});
    }
    ASSERT_TRUE(store_.commit(batch).has_value());
  }
  void happens(const std::string& kind) {
    const StoreEvent event{kNoon, Severity::info, kind, "main", "."};
    ASSERT_TRUE(store_.commit({.events = {event}}).has_value());
  }
  void finish_job(const std::string& document) {
    StoredJob job{.state = JobState::done, .asked_by = "api", .asked = kNoon};
    job.ended = kNoon;
    job.result.document = document;
    ASSERT_TRUE(store_.add_job(job).has_value());
  }
  static std::vector<record::RecordBatch> batches_of(const std::vector<std::string>& payloads) {
    std::vector<record::RecordBatch> batches;
    for (const std::string& one : payloads) batches.push_back(record::parse_batch(one).value());
    return batches;
  }
  /// @param until  Where the first begins.
  static void expect_one_after_the_other(const PlayedRecord& record, record::Progress until) {
    for (const std::string& payload : record.payloads()) {
      const auto batch = record::parse_batch(payload).value();
      EXPECT_EQ(batch.after, until) << payload;
      until = batch.until();
    }
  }
  static std::vector<double> numbers(int from, int until) {
    std::vector<double> all;
    for (int i = from; i < until; ++i) all.push_back(i);
    return all;
  }

  TemporaryFolder folder_;
  sqlite::SqliteStore store_ = sqlite::SqliteStore::open(folder_ / "site.db").value();
  std::uint32_t main_ = store_.meter_number("main", seconds{900}).value();
  std::vector<MeterInStore> history_ = {};
  VirtualLoop loop_{kNoon};
  Mosquitto broker_;  ///< Without persistence: a kill wipes it.
  std::atomic<int> signs_ = 0;
  std::mutex mutex_;
  std::vector<std::string> heard_;
  std::vector<std::string> told_;
  std::shared_ptr<RecordLink> link_;
  std::unique_ptr<Forwarder> forwarder_;
};

TEST_F(RecordSinkTest, EverythingIsSentInOrder) {
  const PlayedRecord record{broker_.port()};
  happens("long_ago");
  begin();
  loop_.run_for(seconds{10});
  store(0, 1200);
  ASSERT_TRUE(store_
                  .put_month(main_,
                             {.month = std::chrono::year{2026} / 1, .daily_average_kWh = 240.0},
                             "2025b", kNoon)
                  .has_value());
  happens("meter_silent");
  finish_job("{\"parameters\":[]}");
  loop_.run_for(minutes{1});
  happens("meter_answers");
  loop_.run_for(minutes{1});
  const auto taken = record.of("depot");
  EXPECT_THAT(record.means_of("depot"), ElementsAreArray(numbers(0, 1200)));
  ASSERT_THAT(taken.entries, SizeIs(1201));
  EXPECT_EQ(std::get<StoredMonth>(taken.entries.back().stored).figure.daily_average_kWh, 240.0);
  ASSERT_THAT(taken.events, SizeIs(2));
  EXPECT_EQ(taken.events[0].kind, "meter_silent");
  EXPECT_EQ(taken.events[1].kind, "meter_answers");
  ASSERT_THAT(taken.results, SizeIs(1));
  EXPECT_EQ(taken.results[0].result.document, "{\"parameters\":[]}");
  EXPECT_EQ(taken.watermark.outbox, outbox_identity(store_, "fleet").value());
  EXPECT_EQ(forwarder_->status().waiting, 0);
  EXPECT_THAT(told_, IsEmpty());
  expect_one_after_the_other(record, {.entries = 0, .events = 1, .results = 0});
  for (const std::string& payload : record.payloads()) EXPECT_LE(payload.size(), 128u * 1024u);
}

// What the broker has acknowledged is not what the record has.
TEST_F(RecordSinkTest, WithoutAWatermarkNothingIsForgottenAndTheSameComesAgain) {
  PlayedRecord record{broker_.port(), Mood::away};
  begin(kHasty);
  store(0, 3);
  loop_.run_for(minutes{1});
  const auto payloads = record.payloads();
  ASSERT_GE(payloads.size(), 2u);
  auto batches = batches_of(payloads);
  std::set<std::int64_t> questions;
  for (record::RecordBatch& batch : batches) questions.insert(std::exchange(batch.question, 0));
  EXPECT_THAT(questions, SizeIs(payloads.size()));
  for (const auto& batch : batches) EXPECT_EQ(to_json(batch), to_json(batches.front()));
  EXPECT_EQ(forwarder_->status().waiting, 3);
  EXPECT_THAT(told_, ElementsAre(HasSubstr("the fleet's record has not confirmed what was sent "
                                           "within 0.2 s; `recald worker` or its PostgreSQL is "
                                           "away, or site 'depot' is not registered there")));
  record.set(Mood::takes);
  loop_.run_for(minutes{5});
  EXPECT_THAT(record.means_of("depot"), ElementsAreArray(numbers(0, 3)));
  EXPECT_EQ(forwarder_->status().waiting, 0);
}

TEST_F(RecordSinkTest, AWatermarkOfAnotherOutboxOrOfLessDoesNotCount) {
  const PlayedRecord record{broker_.port(), Mood::away};
  begin(kHasty);
  loop_.run_for(seconds{10});
  store(0, 3);
  happens("meter_silent");
  finish_job("{}");
  const std::int64_t ours = outbox_identity(store_, "fleet").value();
  const auto say = [&](const record::Watermark& watermark) {
    const int before = signs_;
    broker_.send({.topic = "recald/v1/depot/watermark",
                  .payload = record::to_json(watermark),
                  .is_retained = true});
    ASSERT_TRUE(eventually([&] { return signs_ > before; }));
    loop_.run_for(minutes{5});
  };
  for (const record::Watermark& less :
       {record::Watermark{ours - 1, {1000, 1000, 1000}}, record::Watermark{ours, {2, 1000, 1000}},
        record::Watermark{ours, {1000, 0, 1000}}, record::Watermark{ours, {1000, 1000, 0}}}) {
    say(less);
    EXPECT_EQ(forwarder_->status().waiting, 3) << record::to_json(less);
  }
  say({.outbox = ours, .until = {.entries = 3, .events = 1, .results = 1}});
  EXPECT_EQ(forwarder_->status().waiting, 0);
}

TEST_F(RecordSinkTest, ABrokerThatIsKilledAndWipedLosesNothing) {
  PlayedRecord record{broker_.port()};
  begin(kHasty);
  store(0, 100);
  loop_.run_for(minutes{1});
  ASSERT_THAT(record.means_of("depot"), SizeIs(100));
  // Acknowledged by a broker that dies before the record has it.
  record.set(Mood::away);
  store(100, 200);
  loop_.run_for(seconds{5});
  const std::size_t arrived = record.payloads().size();
  broker_.kill();
  store(200, 300);
  loop_.run_for(minutes{1});
  EXPECT_EQ(forwarder_->status().waiting, 200);
  record.set(Mood::takes);
  broker_.start();
  ASSERT_TRUE(record.is_soon_connected());
  ASSERT_TRUE(is_connected());
  loop_.run_for(minutes{10});
  EXPECT_THAT(record.means_of("depot"), ElementsAreArray(numbers(0, 300)));
  EXPECT_GT(record.payloads().size(), arrived);
  EXPECT_EQ(forwarder_->status().waiting, 0);
}

class RecordSinkOfASmallBroker : public RecordSinkTest {
 protected:
  RecordSinkOfASmallBroker() : RecordSinkTest{{.more = "max_packet_size 1500\n"}} {}
};

// A sentence of every length, and documents: what comes after them must not wait for ever.
TEST_F(RecordSinkOfASmallBroker, AnEventThatIsTooLongForItArrivesShortened) {
  PlayedRecord record{broker_.port()};
  begin(kHasty);
  loop_.run_for(seconds{10});
  std::vector<std::size_t> lengths{1'200, 1'400, 3'999, 200'000};
  for (const std::size_t length : lengths) {
    const StoreEvent event{kNoon, Severity::info, std::string(length / 4, 'k'),
                           std::string(length / 4, 's'), std::string(length, 't')};
    ASSERT_TRUE(store_.commit({.events = {event}}).has_value());
    finish_job(std::string(length, '9'));
  }
  happens("after");
  store(0, 300);
  loop_.run_for(minutes{5});
  EXPECT_EQ(forwarder_->status().waiting, 0) << forwarder_->status().why;
  EXPECT_THAT(record.means_of("depot"), ElementsAreArray(numbers(0, 300)));
  std::map<std::int64_t, std::string> kinds;
  std::set<std::int64_t> results;
  for (const record::RecordBatch& batch : batches_of(record.payloads())) {
    for (const StoreEvent& event : batch.events) kinds[event.number] = event.kind;
    for (const StoredJob& job : batch.results) results.insert(job.number);
  }
  EXPECT_THAT(kinds, SizeIs(lengths.size() + 1));
  EXPECT_EQ(kinds.rbegin()->second, "after");
  EXPECT_THAT(results, SizeIs(lengths.size()));
}

// The broker has kept the record's last word, which a gateway finds after its start.
TEST_F(RecordSinkTest, WhatIsConfirmedWhileTheGatewayIsAwayIsNotSentAgain) {
  PlayedRecord record{broker_.port(), Mood::mute};
  begin(kHasty);
  store(0, 5);
  loop_.run_for(seconds{3});
  ASSERT_THAT(record.means_of("depot"), SizeIs(5));
  EXPECT_EQ(forwarder_->status().waiting, 5);
  end();
  record.set(Mood::takes);
  ASSERT_THAT(broker_.read("recald/v1/depot/watermark", 1, seconds{30}), SizeIs(1));
  const std::size_t arrived = record.payloads().size();
  begin();
  ASSERT_TRUE(eventually([&] { return signs_ > 0; }));
  loop_.run_for(minutes{1});
  EXPECT_EQ(record.payloads().size(), arrived);
  EXPECT_EQ(forwarder_->status().waiting, 0);
  store(5, 8);
  loop_.run_for(minutes{1});
  EXPECT_THAT(record.means_of("depot"), ElementsAreArray(numbers(0, 8)));
}

// Of an hour in which its database is away, the gateway waits no minute longer.
TEST_F(RecordSinkTest, ARecordThatComesBackEndsTheWait) {
  PlayedRecord record{broker_.port()};
  begin(kHasty);
  store(0, 5);
  loop_.run_for(minutes{1});
  record.set(Mood::away);
  store(5, 2000);
  loop_.run_for(hours{1});
  EXPECT_EQ(forwarder_->status().waiting, 1995);
  EXPECT_LT(record.payloads().size(), 30u);
  const int before = signs_;
  record.set(Mood::takes);
  ASSERT_TRUE(eventually([&] { return signs_ > before; }));
  forwarder_->try_now();
  loop_.run_for(seconds{10});
  EXPECT_THAT(record.means_of("depot"), ElementsAreArray(numbers(0, 2000)));
}

TEST_F(RecordSinkTest, AStoreOfAnotherNumberingIsAnotherOutbox) {
  const PlayedRecord record{broker_.port()};
  begin();
  store(0, 5);
  loop_.run_for(minutes{1});
  const std::int64_t first = record.of("depot").watermark.outbox;
  EXPECT_GT(first, 0);
  begin();
  EXPECT_EQ(outbox_identity(store_, "fleet").value(), first);
  // As from a backup of before.
  ASSERT_TRUE(store_.put_outbox_position("fleet", 2).has_value());
  ASSERT_TRUE(store_.keep_outbox_for({}).has_value());
  store(5, 6);  // nobody is told
  begin();
  store(6, 8);
  loop_.run_for(minutes{1});
  EXPECT_NE(record.of("depot").watermark.outbox, first);
  EXPECT_GT(record.of("depot").watermark.outbox, 0);
  EXPECT_THAT(record.means_of("depot"), ElementsAre(0, 1, 2, 3, 4, 6, 7));
}

// A backup of the record is restored, or it is lost and made again.
TEST_F(RecordSinkTest, ARecordThatHasLessThanItHadIsToldEverythingAgain) {
  PlayedRecord record{broker_.port()};
  history_ = {{"main", seconds{900}}};
  happens("long_ago");
  begin();
  loop_.run_for(seconds{10});
  store(0, 5);
  loop_.run_for(minutes{1});
  happens("meter_silent");
  finish_job("{}");
  loop_.run_for(minutes{1});
  ASSERT_THAT(record.means_of("depot"), ElementsAreArray(numbers(0, 5)));
  const PlayedRecord::Taken then = record.of("depot");
  store(5, 8);
  happens("meter_answers");
  loop_.run_for(minutes{1});
  ASSERT_THAT(record.means_of("depot"), ElementsAreArray(numbers(0, 8)));
  int next = 8;
  for (const PlayedRecord::Taken& before : {then, PlayedRecord::Taken{}}) {
    told_.clear();
    record.go_back("depot", before);
    loop_.run_for(minutes{1});
    std::vector<double> all = record.means_of("depot");  // nobody has noticed
    store(next, next + 1);
    loop_.run_for(minutes{1});
    std::ranges::copy(numbers(0, ++next), std::back_inserter(all));
    EXPECT_THAT(record.means_of("depot"), ElementsAreArray(all));
    EXPECT_NE(record.of("depot").watermark.outbox, then.watermark.outbox);
    EXPECT_THAT(told_, ElementsAre(HasSubstr("forward_anew: the fleet has less than it had")));
    EXPECT_EQ(forwarder_->status().waiting, 0);
    store(next, next + 1);
    happens("meter_fails");
    loop_.run_for(minutes{1});
    all.push_back(next++);
    EXPECT_THAT(record.means_of("depot"), ElementsAreArray(all));
    // Of a record that is lost nobody knows what it had heard.
    std::vector<std::string> kinds;
    for (const StoreEvent& event : record.of("depot").events) kinds.push_back(event.kind);
    EXPECT_THAT(kinds, before.events.empty()
                           ? ElementsAreArray({"meter_fails"})
                           : ElementsAreArray({"meter_silent", "meter_answers", "meter_fails"}));
  }
}

TEST_F(RecordSinkTest, ARecordThatLosesThePastWhileItIsToldLosesNothing) {
  PlayedRecord record{broker_.port()};
  history_ = {{"main", seconds{900}}};
  store(0, 20);
  happens("long_ago");
  begin(kPatient, {.batch = 6});
  ASSERT_TRUE(runs_until([&] { return record.means_of("depot").size() >= 12; }));
  record.go_back("depot", {});
  loop_.run_for(minutes{1});
  store(20, 22);
  loop_.run_for(minutes{1});
  EXPECT_THAT(record.means_of("depot"), ElementsAreArray(numbers(0, 22)));
  EXPECT_THAT(record.of("depot").events, IsEmpty());
  EXPECT_THAT(told_, ElementsAre(HasSubstr("forward_anew")));
}

TEST_F(RecordSinkTest, TwoRecordsThatAnswerInTurnsAreNotToldEverythingAllTheTime) {
  PlayedRecord record{broker_.port()};
  history_ = {{"main", seconds{900}}};
  begin();
  for (int i = 0; i < 600; ++i) {
    store(i, i + 1);
    loop_.run_for(seconds{2});
    record.go_back("depot", {});
    loop_.run_for(seconds{4});
  }
  EXPECT_GT(told_.size(), 5u);
  EXPECT_LT(told_.size(), 15u);
  loop_.run_for(hours{2});
  store(600, 601);
  loop_.run_for(hours{2});
  const auto means = record.means_of("depot");
  EXPECT_THAT(std::set<double>(means.begin(), means.end()), ElementsAreArray(numbers(0, 601)));
}

TEST_F(RecordSinkTest, WhereTooManyWaitTheStoreIsToldFromItsBeginning) {
  PlayedRecord record{broker_.port(), Mood::away};
  history_ = {{"main", seconds{900}}};
  begin(kHasty, {}, 50);
  store(0, 60);
  loop_.run_for(hours{1});
  EXPECT_THAT(told_, ::testing::Contains(HasSubstr("forward_anew: the fleet has not taken anything "
                                                   "for so long that more waits than is kept")));
  record.set(Mood::takes);
  loop_.run_for(hours{1});
  EXPECT_THAT(record.means_of("depot"), ElementsAreArray(numbers(0, 60)));
}

// Numbers are given again, for other readings.
TEST_F(RecordSinkTest, AnImageOfAnEarlierStoreIsAnotherOutbox) {
  const PlayedRecord record{broker_.port()};
  history_ = {{"main", seconds{900}}};
  begin();
  loop_.run_for(seconds{10});
  store(0, 5);
  loop_.run_for(minutes{1});
  end();
  store_ = sqlite::SqliteStore::open(folder_ / "other.db").value();  // closes the first
  std::filesystem::copy_file(folder_ / "site.db", folder_ / "image.db");
  store_ = sqlite::SqliteStore::open(folder_ / "site.db").value();
  begin();
  store(5, 600);
  loop_.run_for(minutes{1});
  std::vector<double> all = numbers(0, 600);
  ASSERT_THAT(record.means_of("depot"), ElementsAreArray(all));
  end();
  store_ = sqlite::SqliteStore::open(folder_ / "image.db").value();
  begin();
  store(1000, 2000);  // it has more numbers by now
  loop_.run_for(minutes{1});
  std::ranges::copy(numbers(0, 5), std::back_inserter(all));
  std::ranges::copy(numbers(1000, 2000), std::back_inserter(all));
  EXPECT_THAT(record.means_of("depot"), ElementsAreArray(all));
  EXPECT_THAT(told_, ElementsAre(HasSubstr("forward_anew: the fleet has more than this store")));
}

// A worker that has just come says how far the record is.
TEST_F(RecordSinkTest, WhatWasLostOnItsWayIsSentAgainWhenTheRecordCalls) {
  PlayedRecord record{broker_.port()};
  begin();  // it waits a minute for an answer
  store(0, 5);
  loop_.run_for(minutes{1});
  record.set(Mood::away);
  const std::size_t before = record.payloads().size();
  store(5, 8);
  std::jthread caller{[&] {
    if (eventually([&] { return record.payloads().size() > before; })) record.set(Mood::takes);
  }};
  loop_.run_for(seconds{3});
  caller.join();
  EXPECT_THAT(record.means_of("depot"), ElementsAreArray(numbers(0, 8)));
  EXPECT_THAT(told_, IsEmpty());
}

class StrictBrokerTest : public RecordSinkTest {
 protected:
  StrictBrokerTest() : RecordSinkTest({.more = "max_packet_size 3000\n"}) {}
};

TEST_F(StrictBrokerTest, ABrokerMayTakeShorterMessagesThanARecordDoes) {
  const PlayedRecord record{broker_.port()};
  begin();
  loop_.run_for(seconds{10});
  store(0, 100);
  finish_job(std::string(1000, 'a'));
  finish_job(std::string(5000, 'b'));
  loop_.run_for(minutes{1});
  const auto taken = record.of("depot");
  EXPECT_THAT(record.means_of("depot"), ElementsAreArray(numbers(0, 100)));
  ASSERT_THAT(taken.results, SizeIs(2));
  EXPECT_EQ(taken.results[0].result.document, std::string(1000, 'a'));
  EXPECT_EQ(taken.results[1].result.document, "");
  EXPECT_EQ(forwarder_->status().waiting, 0);
}

TEST_F(RecordSinkTest, NonsenseOnTheTopicIsTold) {
  begin();
  broker_.send({.topic = "recald/v1/depot/watermark", .payload = "nonsense"});
  EXPECT_TRUE(eventually([&] {
    const std::scoped_lock lock{mutex_};
    return std::ranges::find(heard_,
                             "recald/v1/depot/watermark: the watermark: it is no JSON object") !=
           heard_.end();
  }));
}

}  // namespace
}  // namespace recald::daemon::record_sink_test
