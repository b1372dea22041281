/// What a destination gets, on a virtual clock, whatever it does: everything, in order.
#include "daemon/gateway/forward/forwarder.hpp"

#include <gmock/gmock.h>

#include "adapters/sqlite/sqlite_store.hpp"
#include "daemon/gateway/forward/outbox/store_outbox.hpp"
#include "tests/support/failing_store.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/virtual_loop.hpp"
#include "tests/support/virtual_worker.hpp"

namespace recald::daemon::forwarder_test {
namespace {

using metering::Instant;
using recald::testing::FailingStore;
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

const Instant kNoon = std::chrono::sys_days{std::chrono::year{2026} / 2 / 3} + hours{12};

/// What the other side does and has taken; it outlives the processes that talk to it.
struct Other {
  bool is_down = false;
  std::optional<double> refused;  ///< A value that it refuses, with all that is sent beside it.
  bool refuses_all = false;
  std::vector<double> taken;
  std::vector<std::string> events;
  std::vector<std::string> results;  ///< Their documents.
  record::Progress after;            ///< Of the last batch.
  std::vector<std::size_t> sizes;    ///< Of the batches that it was sent.
};

class ScriptedSink final : public Sink {
 public:
  explicit ScriptedSink(Other& other) : other_(other) {}

  Sent send(const OutgoingBatch& batch, const std::stop_token&) override {
    if (other_.is_down) return {.outcome = Sent::Outcome::later, .why = "connection refused"};
    if (other_.refuses_all) return {.outcome = Sent::Outcome::refused, .why = "no such database"};
    if (batch.size() > 0) other_.sizes.push_back(batch.size());
    std::vector<double> values;
    for (const OutboxEntry& entry : batch.entries) {
      values.push_back(std::get<StoredInterval>(entry.stored).reading.mean_kW);
      if (other_.refused == values.back()) {
        return {.outcome = Sent::Outcome::refused, .why = "too old"};
      }
    }
    other_.taken.insert(other_.taken.end(), values.begin(), values.end());
    for (const StoreEvent& event : batch.events) other_.events.push_back(event.kind);
    for (const StoredJob& job : batch.results) other_.results.push_back(job.result.document);
    other_.after = batch.after;
    return {};
  }

 private:
  Other& other_;
};

class ForwarderTest : public ::testing::Test {
 protected:
  void begin(const ForwardRules& rules = {}, std::int64_t waiting_max = kWaitingMax) {
    ASSERT_TRUE(store_.keep_outbox_for({"other"}).has_value());
    forwarder_.reset();
    auto outbox = std::make_unique<StoreOutbox>(
        StoreOutbox::Ports{loop_, failing_},
        Destination{.id = "other",
                    .words = "the other",
                    .wants_events = true,
                    .wants_results = true,
                    .history = history_},
        [this](const StoreEvent& event) { told_.push_back(event.kind + ": " + event.text); },
        waiting_max);
    forwarder_ = std::make_unique<Forwarder>(
        loop_, std::make_unique<VirtualWorker>(loop_, seconds{1}), std::move(outbox),
        std::make_unique<ScriptedSink>(other_), rules);
    forwarder_->poll_within(milliseconds{0});
  }
  void store(int from, int until) {
    StoreBatch batch;
    for (int i = from; i < until; ++i) {
      batch.intervals.push_back({{main_, kNoon + i * seconds{900}, static_cast<double>(i)}});
    }
    ASSERT_TRUE(store_.commit(batch).has_value());
  }
  static std::vector<double> numbers(int from, int until) {
    std::vector<double> all;
    for (int i = from; i < until; ++i) all.push_back(i);
    return all;
  }

  TemporaryFolder folder_;
  sqlite::SqliteStore store_ = sqlite::SqliteStore::open(folder_ / "site.db").value();
  std::uint32_t main_ = store_.meter_number("main", seconds{900}).value();
  FailingStore failing_{store_};
  VirtualLoop loop_{kNoon};
  Other other_;
  std::vector<MeterInStore> history_;
  std::vector<std::string> told_;
  std::unique_ptr<Forwarder> forwarder_;
};

TEST_F(ForwarderTest, SendsWhatIsStoredInOrder) {
  begin({.batch = 7});
  store(0, 20);
  loop_.run_for(minutes{1});
  store(20, 21);
  loop_.run_for(minutes{1});
  EXPECT_THAT(other_.taken, ElementsAreArray(numbers(0, 21)));
  EXPECT_EQ(forwarder_->status().waiting, 0);
  EXPECT_THAT(told_, IsEmpty());
}

TEST_F(ForwarderTest, TellsThePastFirstToWhoeverWantsIt) {
  store(0, 250);  // nobody is told
  history_ = {{"main", seconds{900}}};
  begin({.batch = 40});
  store(250, 260);
  loop_.run_for(seconds{4});
  EXPECT_LT(other_.taken.size(), 200u);
  begin({.batch = 40});  // another process
  loop_.run_for(minutes{2});
  store(260, 261);
  loop_.run_for(minutes{1});
  // What came after the beginning is in the past and in the outbox, and a batch may come twice.
  EXPECT_LE(other_.taken.size(), 271u + 40u);
  std::vector<double> first;
  for (const double one : other_.taken) {
    if (std::ranges::find(first, one) == first.end()) first.push_back(one);
  }
  EXPECT_THAT(first, ElementsAreArray(numbers(0, 261)));
  EXPECT_EQ(other_.taken.back(), 260.0);
  // Its position is no number of an event.
  StoreBatch batch;
  batch.events.push_back({.time = kNoon, .kind = "something", .subject = "", .text = "It was."});
  ASSERT_TRUE(store_.commit(batch).has_value());
  EXPECT_LT(store_.events(1).value().front().number, 100);
}

TEST_F(ForwarderTest, AnOtherProcessGoesOnWhereTheLastOneEnded) {
  begin();
  store(0, 5);
  loop_.run_for(minutes{1});
  begin();
  store(5, 8);
  loop_.run_for(minutes{1});
  EXPECT_THAT(other_.taken, ElementsAreArray(numbers(0, 8)));
}

TEST_F(ForwarderTest, WhatCannotBeSentWaits) {
  begin({.batch = 10});
  other_.is_down = true;
  store(0, 300);
  loop_.run_for(hours{24});
  EXPECT_THAT(other_.taken, IsEmpty());
  EXPECT_EQ(forwarder_->status().waiting, 300);
  EXPECT_EQ(forwarder_->status().why, "connection refused");
  other_.is_down = false;
  loop_.run_for(minutes{10});
  EXPECT_THAT(other_.taken, ElementsAreArray(numbers(0, 300)));
  EXPECT_THAT(told_, ElementsAre(HasSubstr("nothing can be sent to the other: connection refused"),
                                 HasSubstr("the other takes data again")));
  EXPECT_EQ(forwarder_->status().why, "");
}

// The others of its batch are not lost with it, and it does not hold up what comes later.
TEST_F(ForwarderTest, WhatIsRefusedForGoodIsSetAsideAlone) {
  begin({.batch = 100});
  other_.refused = 61.0;
  store(0, 100);
  loop_.run_for(minutes{2});
  std::vector<double> expected = numbers(0, 100);
  std::erase(expected, 61.0);
  EXPECT_THAT(other_.taken, ElementsAreArray(expected));
  EXPECT_THAT(told_, ElementsAre(HasSubstr("refuses a reading of 'main', which is not sent again: "
                                           "too old")));
}

// An address that is wrong refuses everything; then nothing is at fault that is sent.
TEST_F(ForwarderTest, ADestinationThatRefusesEverythingLosesNothing) {
  begin();
  other_.refuses_all = true;
  store(0, 5);
  loop_.run_for(hours{2});
  EXPECT_EQ(forwarder_->status().waiting, 5);
  other_.refuses_all = false;
  loop_.run_for(minutes{10});
  EXPECT_THAT(other_.taken, ElementsAreArray(numbers(0, 5)));
}

TEST_F(ForwarderTest, EventsFromNowOnAreSentOnce) {
  const auto happens = [&](const char* kind) {
    const StoreEvent event{kNoon, Severity::info, kind, "main", "."};
    ASSERT_TRUE(store_.commit({.events = {event}}).has_value());
  };
  happens("long_ago");
  begin();
  loop_.run_for(minutes{1});
  happens("meter_silent");
  loop_.run_for(minutes{1});
  begin();
  happens("meter_answers");
  loop_.run_for(minutes{1});
  EXPECT_THAT(other_.events, ElementsAre("meter_silent", "meter_answers"));
}

// One that runs is told of when it has ended, and those after it wait for it.
TEST_F(ForwarderTest, ResultsFromNowOnAreSentOnceInOrder) {
  const auto ask = [&](JobKind kind, JobState state, const std::string& document) {
    StoredJob job{.kind = kind, .state = state, .asked_by = "api", .asked = kNoon};
    job.result.document = document;
    job.number = store_.add_job(job).value();
    return job;
  };
  ask(JobKind::calibration, JobState::done, "long ago");
  StoredJob running = ask(JobKind::calibration, JobState::running, "");
  begin();
  loop_.run_for(minutes{1});
  ask(JobKind::diagnosis, JobState::done, "third");
  loop_.run_for(minutes{1});
  EXPECT_THAT(other_.results, IsEmpty());
  running.state = JobState::failed;
  running.result.document = "second";
  ASSERT_TRUE(store_.put_job(running).has_value());
  StoredJob waiting = ask(JobKind::calibration, JobState::waiting, "");
  loop_.run_for(minutes{1});
  EXPECT_THAT(other_.results, ElementsAre("second", "third"));
  begin();
  waiting.state = JobState::done;
  waiting.result.document = "fourth";
  ASSERT_TRUE(store_.put_job(waiting).has_value());
  loop_.run_for(minutes{1});
  EXPECT_THAT(other_.results, ElementsAre("second", "third", "fourth"));
  EXPECT_EQ(other_.after, (record::Progress{.entries = 0, .events = 0, .results = 3}));
}

TEST_F(ForwarderTest, WhoIsKnownToBeThereIsNotWaitedFor) {
  begin();
  other_.is_down = true;
  store(0, 3);
  loop_.run_for(hours{24});
  forwarder_->try_now();
  loop_.run_for(seconds{3});
  EXPECT_THAT(other_.taken, IsEmpty());  // it was asked, and is still down
  other_.is_down = false;
  forwarder_->try_now();
  loop_.run_for(seconds{3});
  EXPECT_THAT(other_.taken, ElementsAreArray(numbers(0, 3)));
}

// An attempt takes a second here.
TEST_F(ForwarderTest, WhoIsThereDuringAnAttemptThatFailsIsAskedAgainAtOnce) {
  begin({.retry_min = hours{1}});
  other_.is_down = true;
  store(0, 3);
  loop_.run_for(milliseconds{500});
  forwarder_->try_now();
  loop_.run_for(milliseconds{600});
  EXPECT_EQ(forwarder_->status().why, "connection refused");
  other_.is_down = false;
  loop_.run_for(seconds{2});
  EXPECT_THAT(other_.taken, ElementsAreArray(numbers(0, 3)));
  other_.is_down = true;
  store(3, 4);
  loop_.run_for(minutes{1});
  other_.is_down = false;
  loop_.run_for(minutes{1});
  EXPECT_THAT(other_.taken, ElementsAreArray(numbers(0, 3)));  // once, not for ever
}

// A batch that was taken is sent again rather than forgotten.
TEST_F(ForwarderTest, WhileTheStoreRefusesNothingIsLeftOut) {
  begin();
  store(0, 3);
  failing_.refuses = true;
  loop_.run_for(minutes{1});
  EXPECT_THAT(other_.taken, IsEmpty());
  failing_.refuses = false;
  loop_.run_for(minutes{10});
  EXPECT_THAT(other_.taken, ElementsAreArray(numbers(0, 3)));
}

TEST_F(ForwarderTest, TheOldestAreLeftOutWhereFarTooManyWait) {
  other_.is_down = true;
  begin({}, 50);
  store(0, 60);
  loop_.run_for(hours{1});
  EXPECT_EQ(forwarder_->status().waiting, 50);
  other_.is_down = false;
  loop_.run_for(minutes{10});
  EXPECT_THAT(other_.taken, ElementsAreArray(numbers(10, 60)));
  EXPECT_THAT(told_, ::testing::Contains(HasSubstr("the oldest 10 intervals and months")));
}

}  // namespace
}  // namespace recald::daemon::forwarder_test
