/// A gateway, a worker, a broker and a database, all real, with a network between them that is cut:
/// whatever passes when, everything is in the record at the end, once.
#include <gmock/gmock.h>

#include <memory>

#include "tests/adapters/record/record_fixture.hpp"
#include "tests/daemon/serving_daemon.hpp"
#include "tests/support/dropping_proxy.hpp"
#include "tests/support/mosquitto.hpp"

namespace recald::daemon::fleet_partition_test {
namespace {

using recald::testing::BackgroundProcess;
using recald::testing::DroppingProxy;
using recald::testing::eventually;
using recald::testing::Mosquitto;
using recald::testing::readings_json;
using recald::testing::ServingDaemon;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using std::chrono::seconds;
using ::testing::HasSubstr;

constexpr seconds kQuarter{900};
constexpr auto kCut = std::chrono::seconds{3};

class FleetPartition : public record::Record {
 protected:
  void SetUp() override {
    if (!Mosquitto::can_run()) GTEST_SKIP() << "mosquitto of Debian is not installed";
    Record::SetUp();
    if (IsSkipped()) return;
    broker_.start();
    gateway_to_broker_ = std::make_unique<DroppingProxy>(broker_.port());
    worker_to_broker_ = std::make_unique<DroppingProxy>(broker_.port());
    worker_to_database_ = std::make_unique<DroppingProxy>(server_->port());
    const std::string database = url_.substr(url_.rfind('/') + 1);
    write_text(folder_ / "fleet.toml",
               "[record]\nurl = \"" +
                   recald::testing::PostgresServer::url_of(worker_to_database_->port(), database) +
                   "\"\n[mqtt]\nurl = \"" + address_of(*worker_to_broker_) +
                   "\"\n[worker]\njobs = 1\n");
    write_text(folder_ / "site.toml", R"([site]
id = "tower"
timezone = "Europe/Berlin"
[http]
listen = "127.0.0.1:0"
[fleet]
url = ")" + address_of(*gateway_to_broker_) +
                                          R"("
[[meter]]
id = "main"
source = "http"
utility = "electricity"
)");
    gateway_ = std::make_unique<ServingDaemon>(RECALD_PROGRAM, folder_.path());
    worker_ = std::make_unique<BackgroundProcess>(
        std::vector<std::string>{RECALD_PROGRAM, "worker", (folder_ / "fleet.toml").string()},
        folder_ / "worker.txt");
  }
  static std::string address_of(const DroppingProxy& proxy) {
    return "mqtt://127.0.0.1:" + std::to_string(proxy.port());
  }

  /// What never falls for a day would be taken for a register.
  static int load_kW(int interval) { return interval % 17; }

  void push(int count) {
    const auto answer = gateway_->post("/api/v1/readings",
                                       readings_json(begin_ + pushed_ * kQuarter, kQuarter, count,
                                                     [&](int i) { return load_kW(pushed_ + i); }));
    ASSERT_THAT(answer, HasSubstr("200 OK"));
    pushed_ += count;
  }
  /// All that was pushed is in the record, each with its value.
  [[nodiscard]] bool has_all() const {
    int sum = 0;
    for (int i = 0; i < pushed_; ++i) sum += load_kW(i);
    const std::string all = std::to_string(pushed_) + "|" + std::to_string(sum) + "\n";
    return eventually([&] { return ask("SELECT count(*), sum(mean_kw) FROM interval") == all; });
  }
  [[nodiscard]] std::string words() const {
    return ask("SELECT count(*), sum(mean_kw) FROM interval") + gateway_->said() +
           recald::testing::read_text(folder_ / "worker.txt");
  }

  const metering::Instant begin_ =
      std::chrono::floor<std::chrono::days>(
          std::chrono::floor<seconds>(std::chrono::system_clock::now())) -
      std::chrono::days{3};
  int pushed_ = 0;
  TemporaryFolder folder_;
  Mosquitto broker_;
  std::unique_ptr<DroppingProxy> gateway_to_broker_, worker_to_broker_, worker_to_database_;
  std::unique_ptr<ServingDaemon> gateway_;
  std::unique_ptr<BackgroundProcess> worker_;
};

TEST_F(FleetPartition, ANetworkThatIsCutAnywhereLosesAndRepeatsNothing) {
  push(10);
  ASSERT_TRUE(has_all()) << words();
  for (const auto* const link : {&gateway_to_broker_, &worker_to_broker_, &worker_to_database_}) {
    for (const auto mend : {&DroppingProxy::mend, &DroppingProxy::mend_and_reset}) {
      const std::string before = ask("SELECT count(*) FROM interval");
      (*link)->cut();
      push(20);
      std::this_thread::sleep_for(kCut);
      EXPECT_EQ(ask("SELECT count(*) FROM interval"), before) << "nothing was cut";
      push(10);
      ((*link).get()->*mend)();
      ASSERT_TRUE(has_all()) << words();
    }
  }
  EXPECT_EQ(worker_->end(SIGTERM), 128 + SIGTERM) << words();
  EXPECT_EQ(gateway_->end(SIGTERM), 0) << words();
  // Nothing came under another identity, as after a loss.
  EXPECT_EQ(ask("SELECT count(*) FROM source WHERE outbox > 0"), "1\n");
}

TEST_F(FleetPartition, ARecordOfBeforeIsToldWhatItHasLost) {
  push(10);
  ASSERT_TRUE(has_all()) << words();
  // As its backup of this moment would have it later.
  (void)ask(
      "CREATE TABLE kept_interval AS TABLE interval; CREATE TABLE kept_source AS TABLE source; "
      "CREATE TABLE kept_site AS TABLE site");
  push(30);
  ASSERT_TRUE(has_all()) << words();
  (void)ask(
      "BEGIN; DELETE FROM interval; INSERT INTO interval TABLE kept_interval; UPDATE source s "
      "SET (entries, events, results) = (SELECT entries, events, results FROM kept_source k "
      "WHERE k.site = s.site AND k.outbox = s.outbox); UPDATE site s SET (seq, event_seq) = "
      "(SELECT seq, event_seq FROM kept_site k WHERE k.number = s.number); "
      "CREATE TABLE after_loss AS SELECT count(*) FROM interval; COMMIT");
  // Counted in there: the gateway may be told at once, before anyone can look.
  ASSERT_EQ(ask("TABLE after_loss"), "10\n");
  push(5);
  ASSERT_TRUE(has_all()) << words();
  EXPECT_TRUE(eventually(
      [&] { return ask("SELECT count(*) FROM event WHERE kind = 'forward_anew'") == "1\n"; }));
  EXPECT_THAT(recald::testing::read_text(folder_ / "worker.txt"),
              HasSubstr("the record has less of site 'tower' than its gateway was told"));
}

}  // namespace
}  // namespace recald::daemon::fleet_partition_test
