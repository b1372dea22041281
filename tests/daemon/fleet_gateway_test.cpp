/// The real program with a real broker, and a record that the test plays: what one of a fleet's
/// gateways sends, whoever is killed.
#include <gmock/gmock.h>

#include <algorithm>
#include <csignal>
#include <memory>
#include <nlohmann/json.hpp>

#include "tests/daemon/serving_daemon.hpp"
#include "tests/support/mosquitto.hpp"
#include "tests/support/played_record.hpp"

namespace recald::daemon::fleet_gateway_test {
namespace {

using metering::Instant;
using recald::testing::eventually;
using recald::testing::Mosquitto;
using recald::testing::PlayedRecord;
using recald::testing::readings_json;
using recald::testing::ServingDaemon;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using std::chrono::seconds;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using Mood = PlayedRecord::Mood;

constexpr seconds kQuarter{900};

class FleetGateway : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Mosquitto::can_run()) GTEST_SKIP() << "mosquitto of Debian is not installed";
    broker_.set_password("depot", "secret");
    broker_.start();
    write_text(folder_ / "password", "secret\n");
    std::filesystem::permissions(folder_ / "password", std::filesystem::perms{0600});
    write_text(folder_ / "site.toml", R"([site]
id = "depot"
timezone = "Europe/Berlin"
[http]
listen = "127.0.0.1:0"
[fleet]
url = "mqtt://127.0.0.1:)" + std::to_string(broker_.port()) +
                                          R"("
user = "depot"
password_file = "password"
[[meter]]
id = "main"
source = "http"
utility = "electricity"
)");
    start();
  }
  void start() { daemon_ = std::make_unique<ServingDaemon>(RECALD_PROGRAM, folder_.path()); }

  /// Intervals of "main" from number `from` on, each of its number in kW.
  void push(int from, int count) {
    const auto answer = daemon_->post(
        "/api/v1/readings",
        readings_json(begin_ + from * kQuarter, kQuarter, count, [&](int i) { return from + i; }));
    ASSERT_THAT(answer, HasSubstr("200 OK"));
  }
  /// How many entries wait for the fleet; a month that closes meanwhile is one too.
  [[nodiscard]] int waiting() const {
    const std::string name =
        "recald_outbox_entries{destination=\"fleet at 127.0.0.1:" + std::to_string(broker_.port()) +
        "\"} ";
    const std::string metrics = daemon_->get("/metrics");
    const std::size_t at = metrics.find(name);
    return at == std::string::npos ? -1 : std::stoi(metrics.substr(at + name.size()));
  }
  /// How often something of a kind has happened; an event that is repeated is one with a count.
  [[nodiscard]] int count(const std::string& kind) const {
    const std::string answer = daemon_->get("/api/v1/events");
    const auto events = nlohmann::json::parse(answer.substr(answer.find("\r\n\r\n")));
    int times = 0;
    for (const auto& event : events["events"]) {
      if (event["kind"] == kind) times += event.value("count", 1);
    }
    return times;
  }
  static std::vector<double> first(int count) {
    std::vector<double> all;
    for (int i = 0; i < count; ++i) all.push_back(i);
    return all;
  }

  const Instant begin_ = std::chrono::floor<std::chrono::days>(
                             std::chrono::floor<seconds>(std::chrono::system_clock::now())) -
                         std::chrono::days{2};
  TemporaryFolder folder_;
  Mosquitto broker_;  ///< Without persistence: a kill wipes it.
  std::unique_ptr<ServingDaemon> daemon_;
};

TEST_F(FleetGateway, EverythingReachesTheRecordWhoeverIsKilled) {
  EXPECT_EQ(daemon_->end(SIGTERM), 0);
  auto record = std::make_unique<PlayedRecord>(broker_.port(), "depot", "secret", Mood::away);
  start();
  push(0, 40);
  ASSERT_TRUE(eventually([&] { return !record->payloads().empty(); })) << daemon_->said();
  // While it waits for the record's word, everything else goes on.
  push(40, 40);
  EXPECT_TRUE(eventually([&] { return waiting() >= 80; })) << daemon_->get("/metrics");
  record.reset();
  broker_.kill();
  push(80, 20);
  EXPECT_TRUE(eventually([&] { return waiting() >= 100; })) << daemon_->get("/metrics");
  EXPECT_EQ(daemon_->end(SIGKILL), -SIGKILL);
  broker_.start();
  record = std::make_unique<PlayedRecord>(broker_.port(), "depot", "secret");
  start();
  push(100, 20);
  EXPECT_TRUE(eventually([&] { return record->means_of("depot").size() >= 120; }))
      << daemon_->said();
  EXPECT_THAT(record->means_of("depot"), ElementsAreArray(first(120)));
  EXPECT_TRUE(eventually([&] { return waiting() == 0; })) << daemon_->get("/metrics");
  EXPECT_EQ(daemon_->end(SIGTERM), 0) << daemon_->said();
}

TEST_F(FleetGateway, ABrokerThatComesBackIsUsedAgain) {
  EXPECT_EQ(daemon_->end(SIGTERM), 0);
  PlayedRecord record{broker_.port(), "depot", "secret"};
  start();
  // It has no past.
  ASSERT_TRUE(eventually([&] { return !record.of("depot").entries.empty(); })) << daemon_->said();
  push(0, 4);
  ASSERT_TRUE(eventually([&] { return record.means_of("depot").size() == 4; })) << daemon_->said();
  ASSERT_TRUE(eventually([&] { return waiting() == 0; }));
  // One that was slow to connect at first has said so already.
  const int failures = count("forward_failed");
  broker_.kill();
  push(4, 4);
  ASSERT_TRUE(eventually([&] { return count("forward_failed") > failures; })) << daemon_->said();
  broker_.start();
  EXPECT_TRUE(eventually([&] { return record.means_of("depot").size() == 8; })) << daemon_->said();
  EXPECT_TRUE(eventually([&] {
    return std::ranges::any_of(record.of("depot").events,
                               [](const StoreEvent& one) { return one.kind == "forward_works"; });
  }));
}

TEST_F(FleetGateway, AWrongPasswordIsSaidAndCostsNothing) {
  write_text(folder_ / "password", "wrong\n");
  EXPECT_EQ(daemon_->end(SIGTERM), 0);
  start();
  push(0, 3);
  EXPECT_TRUE(eventually([&] {
    const std::string events = daemon_->get("/api/v1/events");
    return events.find("the broker of the fleet at 127.0.0.1") != std::string::npos &&
           events.find("refused the connection: Not authorized") != std::string::npos;
  })) << daemon_->said();
  EXPECT_TRUE(eventually([&] { return waiting() >= 3; }));
  write_text(folder_ / "password", "secret\n");
  const PlayedRecord record{broker_.port(), "depot", "secret"};
  daemon_->signal(SIGHUP);
  EXPECT_TRUE(eventually([&] { return record.means_of("depot").size() == 3; })) << daemon_->said();
}

}  // namespace
}  // namespace recald::daemon::fleet_gateway_test
