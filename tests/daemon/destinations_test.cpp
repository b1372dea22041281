/// The daemon with a real broker and real databases, which it and they are killed under.
#include <gmock/gmock.h>

#include <algorithm>
#include <csignal>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/daemon/serving_daemon.hpp"
#include "tests/support/influxdb.hpp"
#include "tests/support/mosquitto.hpp"
#include "tests/support/prometheus.hpp"

namespace recald::daemon::destinations_test {
namespace {

using metering::Instant;
using nlohmann::json;
using recald::testing::eventually;
using recald::testing::InfluxDb;
using recald::testing::Mosquitto;
using recald::testing::Prometheus;
using recald::testing::read_text;
using recald::testing::readings_json;
using recald::testing::ServingDaemon;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr seconds kQuarter{900};

/// A quarter hour two days ago.
Instant begin() {
  const auto now = std::chrono::floor<seconds>(std::chrono::system_clock::now());
  const auto then = now.time_since_epoch() - std::chrono::days{2};
  return Instant{then - then % kQuarter};
}

class DestinationsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Mosquitto::can_run() || !InfluxDb::can_run() || !Prometheus::can_run()) {
      GTEST_SKIP() << "mosquitto, influxdb and prometheus of Debian are not installed";
    }
    broker_.start();
    influx_.start();
    influx_.query("CREATE DATABASE buildings");
    prometheus_.start();
    write_text(folder_ / "site.toml",
               "[site]\nid = \"depot\"\ntimezone = \"Europe/Berlin\"\n[http]\nlisten = "
               "\"127.0.0.1:0\"\n[mqtt]\nurl = \"mqtt://localhost:" +
                   std::to_string(broker_.port()) +
                   "\"\n[[remote_write]]\nprotocol = \"influx\"\nurl = \"" +
                   influx_.write_url("buildings") +
                   "\"\n[[remote_write]]\nprotocol = \"prometheus\"\nurl = \"" +
                   prometheus_.write_url() + R"("
[[meter]]
id = "main"
source = "http"
utility = "electricity"
[[meter]]
id = "heat"
source = "mqtt"
utility = "heating"
rated_kW = 100
every = "5m"
energy_from = { topic = "plant/heat", pointer = "/total", time_pointer = "/time", unit = "MWh" }
)");
    daemon_ = start();
  }

  std::unique_ptr<ServingDaemon> start() {
    return std::make_unique<ServingDaemon>(RECALD_PROGRAM, folder_.path());
  }
  /// Intervals of "main" from number `from` on, with 1 kW more in each.
  void push(int from, int count) {
    const auto answer =
        daemon_->post("/api/v1/readings", readings_json(begin_ + from * kQuarter, kQuarter, count,
                                                        [&](int i) { return 10.0 + from + i; }));
    ASSERT_THAT(answer, HasSubstr("200 OK"));
  }
  /// Time and value of what each database has of "main".
  [[nodiscard]] std::set<std::pair<std::int64_t, double>> in_influx() const {
    std::set<std::pair<std::int64_t, double>> found;
    for (const json& series : influx_.query(
             "SELECT mean_kilowatts FROM recald_interval WHERE meter = 'main'", "buildings")) {
      for (const json& row : series["values"]) found.emplace(row[0], row[1]);
    }
    return found;
  }
  [[nodiscard]] std::set<std::pair<std::int64_t, double>> in_prometheus() const {
    std::set<std::pair<std::int64_t, double>> found;
    for (const json& series :
         prometheus_.query("recald_interval_mean_kilowatts{site=\"depot\",meter=\"main\"}[30d]")) {
      for (const json& row : series["values"]) {
        found.emplace(static_cast<std::int64_t>(row[0].get<double>()),
                      std::stod(row[1].get<std::string>()));
      }
    }
    return found;
  }
  /// As the databases should have the first so many intervals: at their ends.
  [[nodiscard]] std::set<std::pair<std::int64_t, double>> first(int count) const {
    std::set<std::pair<std::int64_t, double>> all;
    for (int i = 0; i < count; ++i) {
      all.emplace((begin_ + (i + 1) * kQuarter).time_since_epoch().count(), 10.0 + i);
    }
    return all;
  }
  [[nodiscard]] static std::set<double> values_of(const std::vector<mqtt::Message>& messages,
                                                  const std::string& topic) {
    std::set<double> found;
    for (const mqtt::Message& one : messages) {
      if (one.topic == topic) found.insert(json::parse(one.payload)["mean_kW"].get<double>());
    }
    return found;
  }

  const Instant begin_ = begin();
  TemporaryFolder folder_;
  Mosquitto broker_{{.is_persistent = true}};
  InfluxDb influx_;
  Prometheus prometheus_{{.out_of_order_window = "40d"}};
  std::unique_ptr<ServingDaemon> daemon_;
};

TEST_F(DestinationsTest, EverythingArrivesWhoeverIsKilled) {
  const auto reader = broker_.reader("recald/depot/#");
  push(0, 40);
  ASSERT_TRUE(eventually([&] { return in_influx() == first(40); })) << daemon_->said();
  ASSERT_TRUE(eventually([&] { return in_prometheus() == first(40); })) << daemon_->said();
  ASSERT_TRUE(eventually([&] {
    return values_of(reader->messages(), "recald/depot/meter/main/interval").size() == 40;
  }));
  broker_.kill();
  influx_.kill();
  prometheus_.kill();
  push(40, 40);
  EXPECT_TRUE(eventually([&] {
    const std::string metrics = daemon_->get("/metrics");
    return metrics.find("recald_outbox_entries{destination=\"InfluxDB at 127.0.0.1:" +
                        influx_.port() + "\"} 40") != std::string::npos;
  })) << daemon_->get("/metrics");
  EXPECT_EQ(daemon_->end(SIGKILL), -SIGKILL);
  daemon_ = start();
  push(80, 10);
  influx_.start();
  prometheus_.start();
  broker_.start();
  EXPECT_TRUE(eventually([&] { return in_influx() == first(90); })) << daemon_->said();
  EXPECT_TRUE(eventually([&] { return in_prometheus() == first(90); })) << daemon_->said();
  EXPECT_TRUE(eventually([&] {
    return values_of(reader->messages(), "recald/depot/meter/main/interval").size() == 90;
  })) << daemon_->said();
  EXPECT_EQ(daemon_->end(SIGTERM), 0) << daemon_->said();
}

TEST_F(DestinationsTest, WhoWatchesSeesWhetherTheDaemonLives) {
  const auto status = [&] {
    const auto kept = broker_.read("recald/depot/status", 1, seconds{5});
    return kept.empty() ? std::string{} : kept.front().payload;
  };
  EXPECT_TRUE(eventually([&] { return status() == "online"; }));
  EXPECT_EQ(daemon_->end(SIGKILL), -SIGKILL);
  EXPECT_EQ(status(), "offline");
  daemon_ = start();
  EXPECT_TRUE(eventually([&] { return status() == "online"; }));
  EXPECT_EQ(daemon_->end(SIGTERM), 0);
  EXPECT_EQ(status(), "offline");
}

// 12 kW: 1 kWh every five minutes. Some messages come twice, out of order, or from long ago.
TEST_F(DestinationsTest, ACounterInMessagesIsACounter) {
  const auto send = [&](int step, bool is_retained = false) {
    const Instant at = begin_ + step * minutes{5};
    broker_.send(
        {.topic = "plant/heat",
         .payload = json{{"time", metering::to_string(at)}, {"total", 81.0 + 0.001 * step}}.dump(),
         .is_retained = is_retained});
  };
  const auto intervals = [&] {
    const std::string answer = daemon_->get(
        "/api/v1/intervals?meter=heat&from=" + metering::to_string(begin_) + "&limit=1000");
    return json::parse(answer.substr(answer.find("\r\n\r\n") + 4))["intervals"];
  };
  ASSERT_TRUE(eventually([&] { return broker_.subscriptions("recald-depot") > 0; }));
  send(0, true);
  for (int step = 1; step <= 24; ++step) {
    send(step);
    if (step == 9) send(9);
    if (step == 15) send(11);
  }
  broker_.send({.topic = "plant/heat", .payload = "nonsense"});
  ASSERT_TRUE(eventually([&] { return intervals().size() == 8; })) << intervals();
  EXPECT_EQ(daemon_->end(SIGTERM), 0);
  // The broker keeps what is sent while the daemon is away.
  for (int step = 25; step <= 30; ++step) send(step);
  daemon_ = start();
  ASSERT_TRUE(eventually([&] { return intervals().size() == 10; })) << intervals();
  for (const json& interval : intervals()) {
    EXPECT_EQ(interval["validity"], "ok") << interval;
    EXPECT_NEAR(interval["energy_kWh"].get<double>(), 3.0, 1e-6) << interval;
  }
  EXPECT_THAT(daemon_->get("/api/v1/events"), HasSubstr("'nonsense' of 'plant/heat' is no JSON"));
}

TEST_F(DestinationsTest, HomeAssistantFindsEveryMeter) {
  if (!std::filesystem::exists(RECALD_HOME_ASSISTANT "/installed")) {
    GTEST_SKIP() << "Home Assistant could not be installed in " RECALD_HOME_ASSISTANT;
  }
  EXPECT_EQ(daemon_->end(SIGTERM), 0);
  std::string site = read_text(folder_ / "site.toml");
  site.replace(site.find("[mqtt]\n"), 7, "[mqtt]\nhome_assistant = \"homeassistant\"\n");
  write_text(folder_ / "site.toml", site);
  daemon_ = start();
  constexpr std::size_t kEntities = 5 + 2 * 7;
  std::vector<mqtt::Message> kept;
  ASSERT_TRUE(eventually([&] {
    kept = broker_.read("homeassistant/#", kEntities, seconds{2});
    // A reader that was there before they came gets them as any other message.
    return kept.size() == kEntities && std::ranges::all_of(kept, &mqtt::Message::is_retained);
  })) << daemon_->said();
  const auto states = broker_.read("recald/depot/#", 4, seconds{2});
  kept.insert(kept.end(), states.begin(), states.end());
  std::string lines;
  for (const mqtt::Message& one : kept) {
    EXPECT_TRUE(one.is_retained) << one.topic;
    lines += json{{"topic", one.topic}, {"payload", one.payload}}.dump() + "\n";
  }
  write_text(folder_ / "messages.jsonl", lines);
  const auto checked =
      recald::testing::run_in_shell(RECALD_HOME_ASSISTANT "/bin/python " RECALD_SOURCE_DIR
                                                          "/tests/daemon/check_home_assistant.py " +
                                    (folder_ / "messages.jsonl").string());
  EXPECT_EQ(checked.status, 0) << checked.said;
  EXPECT_THAT(checked.said, HasSubstr(std::to_string(kEntities)));
}

TEST_F(DestinationsTest, AWrongPasswordIsSaidAndCostsNothing) {
  EXPECT_TRUE(eventually([&] { return broker_.subscriptions("recald-depot") > 0; }));
  broker_.stop();
  broker_.set_password("somebody", "secret");
  broker_.start();
  push(0, 3);
  EXPECT_TRUE(eventually([&] {
    return daemon_->get("/api/v1/events").find("is not connected") != std::string::npos;
  })) << daemon_->said();
  EXPECT_TRUE(eventually([&] { return in_influx() == first(3); }));
}

}  // namespace
}  // namespace recald::daemon::destinations_test
