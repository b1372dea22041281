/// The real program against real sockets: it polls, is killed, goes on, and ends when it is told
/// to.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "adapters/http/client.hpp"
#include "adapters/sqlite/tables/database.hpp"
#include "adapters/stores/open.hpp"
#include "tests/daemon/gateway/run/polled_site.hpp"
#include "tests/support/background_process.hpp"
#include "tests/support/damage.hpp"
#include "tests/support/message_sink.hpp"

namespace recald::daemon::run_command_test {
namespace {

using namespace std::chrono_literals;
using recald::testing::BackgroundProcess;
using recald::testing::eventually;
using ::testing::AllOf;
using ::testing::HasSubstr;

class RunCommand : public recald::testing::PolledSite {
 protected:
  [[nodiscard]] std::vector<std::string> command(const std::string& verb) const {
    return {RECALD_PROGRAM, verb, (folder_ / "site.toml").string()};
  }
  [[nodiscard]] std::filesystem::path said() const { return folder_ / "said.txt"; }
  [[nodiscard]] std::string what_was_said() const { return recald::testing::read_text(said()); }

  [[nodiscard]] bool said_so(const std::string& words) const {
    return what_was_said().find(words) != std::string::npos;
  }

  /// Samples in the store, as a reader beside the daemon sees them; 0 while there is no store.
  [[nodiscard]] std::int64_t samples() const {
    if (!std::filesystem::exists(folder_ / "site.db")) return 0;
    auto store = sqlite::Database::open(folder_ / "site.db",
                                        {.access = sqlite::Database::Access::read_only});
    if (!store) return 0;
    auto count = store->execute("SELECT 1 FROM sample LIMIT 1");
    if (!count) return 0;
    auto query = store->prepare("SELECT count(DISTINCT value) FROM sample");
    return query && query->step().value_or(false) ? query->integer(0) : 0;
  }

  /// A meter "chw" whose readings are pushed.
  void add_pushed_meter() const {
    recald::testing::write_text(folder_ / "site.toml",
                                recald::testing::read_text(folder_ / "site.toml") +
                                    "[[meter]]\nid = \"chw\"\nsource = \"http\"\n"
                                    "utility = \"chilled_water\"\n"
                                    "[http]\nlisten = \"127.0.0.1:0\"\n");
  }
  /// Pushes the reading of two hours ago. @param more  Further members of the body.
  /// @return the whole response; empty: it does not listen yet.
  [[nodiscard]] std::string push(const std::string& value, const std::string& more = "") const {
    const std::string text = what_was_said();
    const std::size_t port = text.rfind(" port=");
    if (port == std::string::npos) return "";
    const std::string body = R"({"meter":"chw","unit":"kWh",)" + more + R"("readings":[{"time":")" +
                             metering::to_string(std::chrono::floor<std::chrono::hours>(
                                 std::chrono::system_clock::now() - std::chrono::hours{2})) +
                             R"(","value":)" + value + "}]}";
    boost::asio::ip::tcp::iostream server{"127.0.0.1",
                                          text.substr(port + 6, text.find('\n', port) - port - 6)};
    server << "POST /api/v1/readings HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n"
              "Content-Type: application/json\r\nContent-Length: "
           << body.size() << "\r\n\r\n"
           << body << std::flush;
    return {std::istreambuf_iterator{server}, {}};
  }
};

TEST_F(RunCommand, PollsIsKilledGoesOnAndEnds) {
  std::int64_t before = 0;
  {
    BackgroundProcess daemon{command("run"), said()};
    ASSERT_TRUE(eventually([&] { return samples() >= 3; })) << what_was_said();
    EXPECT_EQ(daemon.end(SIGKILL), -SIGKILL);
    before = samples();
  }
  BackgroundProcess daemon{command("run"), said()};
  ASSERT_TRUE(eventually([&] { return samples() >= before + 3; })) << what_was_said();
  EXPECT_EQ(daemon.end(SIGTERM), 0) << what_was_said();
  EXPECT_THAT(what_was_said(), HasSubstr("event=started site=tower"));
  EXPECT_THAT(what_was_said(), HasSubstr("event=ended"));
}

// A gateway's owner edits the file and makes a mistake: the meters must not notice.
TEST_F(RunCommand, ReloadBadFile) {
  const std::string good = recald::testing::read_text(folder_ / "site.toml");
  BackgroundProcess daemon{command("run"), said()};
  ASSERT_TRUE(eventually([&] { return samples() >= 1; })) << what_was_said();
  recald::testing::write_text(folder_ / "site.toml", good + "pol = \"2s\"\n");
  daemon.signal(SIGHUP);
  ASSERT_TRUE(eventually([&] { return said_so("event=not_reloaded"); })) << what_was_said();
  EXPECT_THAT(what_was_said(), HasSubstr("unknown key 'pol'"));
  const std::int64_t before = samples();
  EXPECT_TRUE(eventually([&] { return samples() >= before + 2; })) << what_was_said();
  EXPECT_EQ(server_.connections(), 2);  // the old file goes on, on another connection

  recald::testing::write_text(folder_ / "site.toml", good + "timeout = \"2s\"\n");
  daemon.signal(SIGHUP);
  ASSERT_TRUE(eventually([&] { return said_so("event=reloaded"); })) << what_was_said();
  EXPECT_TRUE(eventually([&] { return server_.connections() == 3; })) << what_was_said();
  EXPECT_EQ(daemon.end(SIGTERM), 0) << what_was_said();
}

// A path that cannot even be looked at: here one that leads to itself.
TEST_F(RunCommand, AFolderThatCannotBeLookedAtEndsNothing) {
  const std::filesystem::path loop = folder_ / "loop";
  std::filesystem::create_symlink(loop, loop);
  const std::string good = recald::testing::read_text(folder_ / "site.toml");
  recald::testing::write_text(folder_ / "site.toml",
                              good + "\n[store]\nbackup = \"00:00\"\nbackup_folder = \"loop/b\"\n");
  BackgroundProcess daemon{command("run"), said()};
  ASSERT_TRUE(eventually([&] { return samples() >= 1; }));
  ASSERT_TRUE(eventually([&] { return said_so("event=backup_failed"); })) << what_was_said();
  std::filesystem::remove(folder_ / "site.toml");
  std::filesystem::create_symlink(loop, folder_ / "site.toml");
  daemon.signal(SIGHUP);
  ASSERT_TRUE(eventually([&] { return said_so("event=not_reloaded"); })) << what_was_said();
  EXPECT_THAT(what_was_said(), HasSubstr("cannot be reached"));
  const std::int64_t before = samples();
  EXPECT_TRUE(eventually([&] { return samples() >= before + 2; })) << what_was_said();
  EXPECT_EQ(daemon.end(SIGTERM), 0) << what_was_said();
}

/// What a program says, through a pipe: its files may not grow.
class SaidThroughPipe {
 public:
  explicit SaidThroughPipe(std::filesystem::path path) : path_(std::move(path)) {
    ::mkfifo(path_.c_str(), 0600);
    file_ = ::open(path_.c_str(), O_RDWR | O_NONBLOCK);
  }
  ~SaidThroughPipe() { ::close(file_); }
  SaidThroughPipe(const SaidThroughPipe&) = delete;
  SaidThroughPipe& operator=(const SaidThroughPipe&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  const std::string& text() {
    char bytes[4096];
    for (ssize_t size = 0; (size = ::read(file_, bytes, sizeof bytes)) > 0;) {
      text_.append(bytes, static_cast<std::size_t>(size));
    }
    return text_;
  }
  bool has(const std::string& words) { return text().find(words) != std::string::npos; }

 private:
  std::filesystem::path path_;
  int file_ = -1;
  std::string text_;
};

// Files that may not grow are what a full disk is.
TEST_F(RunCommand, OnAFullDiskItStartsInMemoryAndHandsOverLater) {
  SaidThroughPipe said{folder_ / "said"};
  BackgroundProcess daemon{{"/bin/sh", "-c", "trap '' XFSZ; ulimit -S -f 0; exec \"$@\"", "sh",
                            RECALD_PROGRAM, "run", (folder_ / "site.toml").string()},
                           said.path()};
  ASSERT_TRUE(eventually([&] { return said.has("event=no_store"); })) << said.text();
  const int asked = server_.requests() + 3;
  ASSERT_TRUE(eventually([&] { return server_.requests() >= asked; })) << said.text();
  EXPECT_EQ(samples(), 0);
  const rlimit unlimited{RLIM_INFINITY, RLIM_INFINITY};
  ASSERT_EQ(::prlimit(daemon.id(), RLIMIT_FSIZE, &unlimited, nullptr), 0);
  ASSERT_TRUE(eventually([&] { return said.has("event=store_opened"); })) << said.text();
  const int polled = server_.requests() + 2;
  EXPECT_TRUE(eventually([&] { return samples() >= polled; })) << samples() << said.text();
  EXPECT_EQ(daemon.end(SIGTERM), 0) << said.text();
  const auto store = stores::open_to_read(folder_ / "site.db").value();
  const auto events = store->events(10).value();
  EXPECT_THAT(events, ::testing::Contains(::testing::Field(&StoreEvent::kind, "no_store")));
}

// What it would tell cannot be stored either.
TEST_F(RunCommand, ADiskThatFillsUpIsHeardOf) {
  using recald::testing::MessageSink;
  if (!MessageSink::can_run()) GTEST_SKIP() << "the Debian package python3-aiosmtpd is absent";
  const MessageSink sink{RECALD_SOURCE_DIR "/tests/support/message_sink.py", {"--refuse", "1"}};
  recald::testing::write_text(folder_ / "site.toml",
                              recald::testing::read_text(folder_ / "site.toml") +
                                  "[alerts]\nabout = [\"store_refuses\", \"store_accepts\"]\n"
                                  "[[alerts.mail]]\nserver = \"" +
                                  sink.mail_url() +
                                  "\"\nfrom = \"recald@example.org\"\nto = \"ada@example.org\"\n"
                                  "[[alerts.webhook]]\nurl = \"" +
                                  sink.web_url("/hook") + "\"\n");
  const auto told_by = [&](const std::string& by, const std::string& words) {
    return std::ranges::count_if(sink.messages(), [&](const nlohmann::json& one) {
      return one["by"] == by && one.dump().find(words) != std::string::npos;
    });
  };
  SaidThroughPipe said{folder_ / "said"};
  BackgroundProcess daemon{{"/bin/sh", "-c", "trap '' XFSZ; exec \"$@\"", "sh", RECALD_PROGRAM,
                            "run", (folder_ / "site.toml").string()},
                           said.path()};
  ASSERT_TRUE(eventually([&] { return samples() >= 1; })) << said.text();
  const rlimit full{0, RLIM_INFINITY};
  ASSERT_EQ(::prlimit(daemon.id(), RLIMIT_FSIZE, &full, nullptr), 0);
  ASSERT_TRUE(eventually([&] { return told_by("mail", "recald keeps a day of readings") == 1; }))
      << said.text();
  const rlimit unlimited{RLIM_INFINITY, RLIM_INFINITY};
  ASSERT_EQ(::prlimit(daemon.id(), RLIMIT_FSIZE, &unlimited, nullptr), 0);
  EXPECT_TRUE(eventually([&] { return said.has("event=store_accepts"); })) << said.text();
  EXPECT_TRUE(eventually([&] { return told_by("mail", "store accepts data again") == 1; }))
      << said.text();
  EXPECT_TRUE(said.has("event=alert_not_sent subject=webhook at 127.0.0.1")) << said.text();
  EXPECT_EQ(daemon.end(SIGTERM), 0) << said.text();
  EXPECT_EQ(told_by("mail", "recald keeps a day of readings"), 1);  // and not again from the store
}

/// Begins without a store: where the lock would be made there is a folder. As long as `opening` is
/// a pipe, whoever opens the store afterwards waits: the note of a recovery is read first.
class WithoutAStore : public RunCommand {
 protected:
  WithoutAStore() {
    std::filesystem::create_directory(lock());
    recald::testing::write_text(said(), "");
  }
  ~WithoutAStore() override { let_opening_go_on(); }

  [[nodiscard]] std::filesystem::path lock() const { return folder_ / "site.db.lock"; }
  [[nodiscard]] std::filesystem::path note() const { return folder_ / "site.db.recovery"; }

  void begin_opening() {
    ASSERT_EQ(::mkfifo(note().c_str(), 0600), 0);
    std::filesystem::remove(lock());
    ASSERT_TRUE(eventually([&] { return std::filesystem::is_regular_file(lock()); }));
  }
  void let_opening_go_on() {
    const int pipe = ::open(note().c_str(), O_WRONLY | O_NONBLOCK);
    std::filesystem::remove(note());
    if (pipe >= 0) ::close(pipe);
  }
  [[nodiscard]] int how_often_said(const std::string& words) const {
    const std::string text = what_was_said();
    int count = 0;
    for (std::size_t at = text.find(words); at != std::string::npos;
         at = text.find(words, at + 1)) {
      ++count;
    }
    return count;
  }
};

TEST_F(WithoutAStore, WhileItIsOpenedMetersArePolledAndSignalsHeeded) {
  BackgroundProcess daemon{command("run"), said()};
  ASSERT_TRUE(eventually([&] { return said_so("event=no_store"); })) << what_was_said();
  ASSERT_NO_FATAL_FAILURE(begin_opening());
  const int asked = server_.requests() + 3;
  EXPECT_TRUE(eventually([&] { return server_.requests() >= asked; })) << what_was_said();
  daemon.signal(SIGHUP);
  EXPECT_TRUE(eventually([&] { return said_so("event=reloaded"); })) << what_was_said();
  const int polled = server_.requests();
  let_opening_go_on();
  ASSERT_TRUE(eventually([&] { return said_so("event=store_opened"); })) << what_was_said();
  daemon.signal(SIGHUP);  // between the one store and the other
  EXPECT_TRUE(eventually([&] { return how_often_said("event=reloaded") == 2; })) << what_was_said();
  EXPECT_TRUE(eventually([&] { return samples() >= polled; })) << samples() << what_was_said();
  EXPECT_EQ(daemon.end(SIGTERM), 0) << what_was_said();
}

// Nor does it wait for the opening, which may take minutes.
TEST_F(WithoutAStore, WhileItIsOpenedItEndsWhenItIsToldTo) {
  BackgroundProcess daemon{command("run"), said()};
  ASSERT_TRUE(eventually([&] { return said_so("event=no_store"); })) << what_was_said();
  ASSERT_NO_FATAL_FAILURE(begin_opening());
  daemon.signal(SIGTERM);
  ASSERT_TRUE(eventually([&] { return said_so("event=ended"); })) << what_was_said();
  EXPECT_EQ(daemon.wait(), 0);
}

TEST_F(WithoutAStore, PushedReadingsAreTakenOnceThereIsOne) {
  add_pushed_meter();
  BackgroundProcess daemon{command("run"), said()};
  ASSERT_TRUE(eventually([&] { return said_so("event=no_store"); })) << what_was_said();
  const std::string refused = push("1.5");
  EXPECT_THAT(refused, HasSubstr(" 503 "));
  EXPECT_THAT(refused, HasSubstr("Retry-After: 60"));
  std::filesystem::remove(lock());
  EXPECT_TRUE(eventually([&] { return push("1.5").find(" 200 ") != std::string::npos; }))
      << what_was_said();
  EXPECT_EQ(daemon.end(SIGKILL), -SIGKILL);
  const auto store = stores::open_to_read(folder_ / "site.db").value();
  EXPECT_TRUE(store->interval_extent(store->find_meter("chw")->value())->has_value());
}

// A sentence that somebody sends must not pass for one of ours.
TEST_F(RunCommand, WhatOthersWroteIsOneLineOfTheLog) {
  add_pushed_meter();
  BackgroundProcess daemon{command("run"), said()};
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(said()) && said_so(" port="); }));
  EXPECT_THAT(push("1.5"), HasSubstr(" 200 "));
  EXPECT_THAT(push("2.5", R"("reason":"wrong\n2026-01-01T00:00:00.000Z error event=store_damaged)"
                          R"( \u001b[31m\u202e\u0000","author":"a\u0007",)"),
              HasSubstr(" 200 "));
  EXPECT_EQ(daemon.end(SIGTERM), 0);
  EXPECT_THAT(what_was_said(),
              HasSubstr(R"(corrected by a\x07: wrong\x0A2026-01-01T00:00:00.000Z error )"
                        R"(event=store_damaged \x1B[31m\u202E\x00")"));
  EXPECT_THAT(what_was_said(), ::testing::Not(HasSubstr("\n2026-01-01")));
}

// Who starts us waits for a recovery only if it hears that it goes on.
TEST_F(RunCommand, ARecoveryAsksForTime) {
  {
    BackgroundProcess daemon{command("run"), said()};
    ASSERT_TRUE(eventually([&] { return samples() >= 3; })) << what_was_said();
    EXPECT_EQ(daemon.end(SIGTERM), 0);
  }
  recald::testing::damage_leaf(folder_ / "site.db", "sample", 0);
  const std::string socket = (folder_ / "notify").string();
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  socket.copy(address.sun_path, sizeof address.sun_path - 1);
  const int file = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  ASSERT_EQ(::bind(file, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ::setenv("NOTIFY_SOCKET", socket.c_str(), 1);
  BackgroundProcess daemon{command("run"), said()};
  ::unsetenv("NOTIFY_SOCKET");
  std::string notified;
  EXPECT_TRUE(eventually([&] {
    char bytes[1024];
    for (ssize_t size = 0; (size = ::read(file, bytes, sizeof bytes)) > 0;) {
      notified.append(bytes, static_cast<std::size_t>(size)).append("\n");
    }
    return notified.find("READY=1") != std::string::npos;
  })) << notified;
  EXPECT_EQ(notified.find("EXTEND_TIMEOUT_USEC="), 0u) << notified;
  EXPECT_TRUE(said_so("event=store_recovered"));
  EXPECT_EQ(daemon.end(SIGTERM), 0);
  ::close(file);
}

TEST_F(RunCommand, WhatNeedsARestartIsNotReloaded) {
  const std::string good = recald::testing::read_text(folder_ / "site.toml");
  BackgroundProcess daemon{command("run"), said()};
  ASSERT_TRUE(eventually([&] { return samples() >= 1; })) << what_was_said();
  std::string moved = good;
  moved.replace(moved.find("America/Chicago"), 15, "America/Denver");
  recald::testing::write_text(folder_ / "site.toml", moved);
  daemon.signal(SIGHUP);
  EXPECT_TRUE(eventually([&] { return said_so("a changed timezone needs a restart"); }))
      << what_was_said();
  EXPECT_EQ(daemon.end(SIGTERM), 0) << what_was_said();
}

// An administrator's tool may reload before the daemon is ready; that must not end it.
TEST_F(RunCommand, SighupAtStart) {
  for (int time = 0; time < 5; ++time) {
    std::filesystem::remove(folder_ / "site.db.lock");
    std::filesystem::remove(said());
    BackgroundProcess daemon{command("run"), said()};
    ASSERT_TRUE(eventually([&] { return std::filesystem::exists(folder_ / "site.db.lock"); }));
    daemon.signal(SIGHUP);
    EXPECT_TRUE(eventually([&] { return said_so("event=reloaded"); })) << what_was_said();
    EXPECT_EQ(daemon.end(SIGTERM), 0) << what_was_said();
  }
}

TEST_F(RunCommand, OneAtATimeRunsOnAStore) {
  BackgroundProcess first{command("run"), said()};
  ASSERT_TRUE(eventually([&] { return samples() >= 1; })) << what_was_said();
  BackgroundProcess second{command("run"), folder_ / "second.txt"};
  EXPECT_EQ(second.wait(), 1);
  EXPECT_THAT(recald::testing::read_text(folder_ / "second.txt"),
              HasSubstr("site.db.lock' is held by another recald"));
  EXPECT_EQ(first.end(SIGINT), 0);
}

TEST_F(RunCommand, ASiteWithNothingToDoIsTold) {
  const std::string site =
      "[site]\nid = \"x\"\ntimezone = \"UTC\"\n[[meter]]\nid = \"m\"\n"
      "utility = \"electricity\"\n";
  recald::testing::write_text(folder_ / "site.toml", site + "file = \"m.csv\"\n");
  EXPECT_EQ((BackgroundProcess{command("run"), said()}.wait()), 1);
  EXPECT_THAT(what_was_said(),
              HasSubstr("no [[meter]] has source = \"modbus\", \"http\" or \"mqtt\""));
  recald::testing::write_text(folder_ / "site.toml", site + "source = \"http\"\n");
  EXPECT_EQ((BackgroundProcess{command("run"), said()}.wait()), 1);
  EXPECT_THAT(what_was_said(), HasSubstr("no [http] to send its readings to"));
}

class RecordedCommand : public RunCommand {
 protected:
  RecordedCommand() { add_pushed_meter(); }

  /// Four minutes in four seconds, so that there are intervals of one minute.
  [[nodiscard]] std::vector<std::string> recording() const {
    auto all = command("run");
    const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
    for (const std::string& word :
         {std::string{"--record"}, record().string(), std::string{"--clock"},
          fmt::format("{}@{}x60", metering::to_string(now), now.time_since_epoch().count())}) {
      all.push_back(word);
    }
    return all;
  }
  [[nodiscard]] std::filesystem::path record() const { return folder_ / "recording.jsonl"; }
  [[nodiscard]] bool has_recorded(const std::string& words) const {
    return recald::testing::read_text(record()).find(words) != std::string::npos;
  }
  void wait_for_intervals() const {
    ASSERT_TRUE(eventually([&] {
      return std::filesystem::exists(record()) && has_recorded("\"stored\":\"main\"");
    })) << what_was_said();
    EXPECT_THAT(push("12.5"), HasSubstr("HTTP/1.1 200"));
    const std::size_t length = recald::testing::read_text(record()).size();
    ASSERT_TRUE(eventually([&] {
      const std::string text = recald::testing::read_text(record());
      return text.find("\"stored\":\"main\"", length) != std::string::npos;
    }));
  }
  /// What a command says on standard output.
  [[nodiscard]] static std::string output(const std::string& line) {
    const auto ended = recald::testing::run_in_shell(line);
    EXPECT_EQ(ended.status, 0) << line;
    return ended.said;
  }
};

TEST_F(RecordedCommand, IsReplayedToTheSameReadings) {
  BackgroundProcess daemon{recording(), said()};
  wait_for_intervals();
  EXPECT_EQ(daemon.end(SIGTERM), 0);
  const std::string recald = std::string{RECALD_PROGRAM} + " ";
  const std::string exported = output(recald + "export " + (folder_ / "site.toml").string());
  EXPECT_THAT(exported, AllOf(HasSubstr(",main,"), HasSubstr(",chw,")));
  EXPECT_EQ(output(recald + "replay " + record().string() + " 2> " + said().string()), exported);
  EXPECT_THAT(what_was_said(), HasSubstr("intervals are as recorded"));
  EXPECT_THAT(what_was_said(), HasSubstr("because the daemon ended"));
  // On another machine.
  std::filesystem::remove(folder_ / "site.toml");
  std::filesystem::remove(folder_ / "counter.toml");
  (void)output(recald + "replay " + record().string() + " --out " + (folder_ / "again").string());
  EXPECT_EQ(recald::testing::read_text(folder_ / "again" / "readings.csv"), exported);
}

TEST_F(RecordedCommand, OfAKilledDaemonIsReplayedTo) {
  BackgroundProcess daemon{recording(), said()};
  wait_for_intervals();
  daemon.end(SIGKILL);
  const std::string again = output(std::string{RECALD_PROGRAM} + " replay " + record().string() +
                                   " 2> " + said().string());
  EXPECT_THAT(again, AllOf(HasSubstr(",main,"), HasSubstr(",chw,")));
  EXPECT_THAT(what_was_said(), HasSubstr("the recording has no end"));
  EXPECT_THAT(what_was_said(), HasSubstr("intervals are as recorded"));
}

// A gateway that cannot record says so, and polls.
TEST_F(RecordedCommand, ThatCannotBeWrittenIsNoReasonToStop) {
  recald::testing::write_text(record(), "of before");
  recald::testing::write_text(said(), "");
  BackgroundProcess daemon{recording(), said()};
  ASSERT_TRUE(eventually([&] { return said_so("event=not_recorded") && samples() > 2; }))
      << what_was_said();
  EXPECT_EQ(daemon.end(SIGTERM), 0);
  EXPECT_EQ(recald::testing::read_text(record()), "of before");
}

// A gateway without a bus: another program reads the meters and sends what it read.
TEST_F(RunCommand, ASiteOfPushedMetersAlone) {
  recald::testing::write_text(folder_ / "site.toml",
                              "[site]\nid = \"x\"\ntimezone = \"UTC\"\n"
                              "[http]\nlisten = \"127.0.0.1:0\"\n[[meter]]\nid = \"m\"\n"
                              "utility = \"electricity\"\nsource = \"http\"\n");
  recald::testing::write_text(said(), "");
  BackgroundProcess daemon{command("run"), said()};
  ASSERT_TRUE(eventually([&] { return said_so("event=listening"); })) << what_was_said();
  const std::string text = what_was_said();
  const auto port = static_cast<std::uint16_t>(std::stoi(text.substr(text.find(" port=") + 6)));
  EXPECT_TRUE(eventually([&] {
    const auto health = http::get({.port = port, .path = "/healthz"});
    return health && health->status == 200;
  })) << what_was_said();
  EXPECT_EQ(daemon.end(SIGTERM), 0) << what_was_said();
}

TEST_F(RunCommand, CheckTellsHowBusyTheBusIs) {
  BackgroundProcess check{command("check"), said()};
  EXPECT_EQ(check.wait(), 0) << what_was_said();
  EXPECT_THAT(what_was_said(), HasSubstr("busy 2 % of its time"));
  EXPECT_THAT(what_was_said(), HasSubstr("unit 1 on bus 'plant'"));
}

}  // namespace
}  // namespace recald::daemon::run_command_test
