/// A fleet's programs beside a PostgreSQL that hangs as a whole: connections are taken, and nothing
/// is answered.
#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/adapters/record/record_fixture.hpp"
#include "tests/support/background_process.hpp"
#include "tests/support/mosquitto.hpp"

namespace recald::daemon::fleet_frozen_test {
namespace {

using recald::testing::BackgroundProcess;
using recald::testing::eventually;
using recald::testing::Mosquitto;
using recald::testing::read_text;
using recald::testing::run_in_shell;
using recald::testing::TemporaryFolder;
using recald::testing::write_text;
using ::testing::HasSubstr;

class FrozenRecord : public record::Record {
 protected:
  void SetUp() override {
    Record::SetUp();
    if (IsSkipped()) return;
    if (!Mosquitto::can_run()) GTEST_SKIP() << "mosquitto of Debian is not installed";
    broker_.start();
    write_text(folder_ / "fleet.toml",
               "[record]\nurl = \"" + url_ + "\"\n[mqtt]\nurl = \"mqtt://127.0.0.1:" +
                   std::to_string(broker_.port()) + "\"\n[http]\nlisten = \"127.0.0.1:0\"\n");
  }
  void TearDown() override {
    if (server_ != nullptr) server_->thaw();
    Record::TearDown();
  }

  void start(std::vector<std::string> words) {
    words.insert(words.begin(), RECALD_PROGRAM);
    words.push_back((folder_ / "fleet.toml").string());
    process_ = std::make_unique<BackgroundProcess>(words, folder_ / "said.txt");
  }
  [[nodiscard]] std::string said() const {
    const auto file = folder_ / "said.txt";
    return std::filesystem::exists(file) ? read_text(file) : "";
  }
  [[nodiscard]] bool says(const std::string& words) const {
    return eventually([&] { return said().find(words) != std::string::npos; });
  }
  /// What a GET is answered; empty: nothing, within ten seconds.
  [[nodiscard]] std::string get(const std::string& path) const {
    const std::string text = said();
    const std::size_t at = text.find("127.0.0.1:");
    const std::string address = text.substr(at, text.find('\n', at) - at);
    return run_in_shell("curl -s -m 10 http://" + address + path).said;
  }
  /// @return the exit code; the test fails where a signal does not end it.
  [[nodiscard]] int end() {
    process_->signal(SIGTERM);
    EXPECT_TRUE(eventually([this] { return process_->has_ended(); })) << said();
    return process_->has_ended() ? process_->wait() : process_->end(SIGKILL);
  }

  TemporaryFolder folder_;
  Mosquitto broker_;
  std::unique_ptr<BackgroundProcess> process_;
};

TEST_F(FrozenRecord, AServedFleetIsAliveAndEndsWhenItIsTold) {
  start({"fleet", "serve"});
  ASSERT_TRUE(says("listening on 127.0.0.1:"));
  EXPECT_THAT(get("/healthz"), HasSubstr("\"ok\":true"));
  server_->freeze();
  // Somebody waits for a page meanwhile.
  const std::string page =
      "curl -s -m 60 -o /dev/null http://" + said().substr(said().find("127.0.0.1:"));
  const BackgroundProcess reader{{"/bin/sh", "-c", page}, folder_ / "reader.txt"};
  for (int i = 0; i < 5; ++i) EXPECT_THAT(get("/healthz"), HasSubstr("\"ok\":true")) << i;
  EXPECT_EQ(end(), 143) << said();
}

TEST_F(FrozenRecord, AWorkerEndsWhenItIsTold) {
  start({"worker"});
  ASSERT_TRUE(says("batches of gateways are taken"));
  server_->freeze();
  EXPECT_EQ(end(), 143) << said();
}

// Its first connection of all.
TEST_F(FrozenRecord, AWorkerThatIsStartedBesideItEndsToo) {
  server_->freeze();
  start({"worker"});
  std::this_thread::sleep_for(std::chrono::seconds{1});  // until it has begun to connect
  EXPECT_EQ(end(), 143) << said();
}

}  // namespace
}  // namespace recald::daemon::fleet_frozen_test
