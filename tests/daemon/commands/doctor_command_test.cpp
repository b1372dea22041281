/// recald doctor: the facts are right, problems are told, secrets are not, and nothing is written.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "adapters/sqlite/sqlite_store.hpp"
#include "adapters/system/files/file_lock.hpp"
#include "daemon/site/config/register_map_file.hpp"
#include "daemon/version.hpp"
#include "tests/adapters/http/raw_client.hpp"
#include "tests/adapters/http/self_signed.hpp"
#include "tests/daemon/command_line.hpp"
#include "tests/support/damage.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon::doctor_command_test {
namespace {

namespace fs = std::filesystem;

using recald::testing::read_text;
using recald::testing::RunningServer;
using recald::testing::write_text;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::run;

constexpr const char* kSite = R"([site]
id = "tower"
timezone = "America/Chicago"

[http]
listen = "127.0.0.1:0"
token_file = "token"
certificate_file = "tower.pem"
key_file = "tower.key"

[[meter]]
id = "main"
utility = "electricity"
source = "http"

[[meter]]
id = "steam"
utility = "steam"
file = "steam.csv"

[alerts]
[[alerts.webhook]]
url = "https://hooks.example.org/T0SECRET1"
token_file = "hook-token"

[[alerts.mail]]
server = "smtps://mail.example.org"
user = "recald"
password_file = "mail-password"
from = "recald@example.org"
to = ["operator@example.org"]
)";

const metering::Instant kStart = std::chrono::sys_days{std::chrono::year{2024} / 3 / 1};

class DoctorCommand : public ::testing::Test {
 protected:
  DoctorCommand() {
    write_text(path("site.toml"), kSite);
    write_text(path("steam.csv"), "timestamp,meter,value,unit\n");
    write_secret("token", "0123456789SECRET2");
    write_secret("hook-token", "0123456789SECRET3");
    write_secret("mail-password", "SECRET4");
    recald::testing::write_self_signed(path(""), "tower", 90 * 86'400);
    auto store = sqlite::SqliteStore::open(path("site.db")).value();
    const auto meter = store.meter_number("main", std::chrono::seconds{900}).value();
    StoreBatch batch;
    for (int i = 0; i < 4000; ++i) {
      batch.intervals.push_back({{meter, kStart + i * std::chrono::seconds{900}, 1.0 * i}});
    }
    const auto tell = [&](Severity severity, const char* kind) {
      batch.events.push_back({kStart, severity, kind, "", "said with SECRET5"});
    };
    tell(Severity::warning, "meter_silent");
    tell(Severity::warning, "meter_silent");
    tell(Severity::error, "store_refused");
    tell(Severity::info, "started");
    EXPECT_TRUE(store.commit(batch).has_value());
    EXPECT_TRUE(store
                    .add_job({.state = JobState::failed,
                              .asked_by = "api",
                              .asked = kStart,
                              .message = "SECRET6"})
                    .has_value());
  }

  [[nodiscard]] fs::path path(const std::string& name) const { return folder_ / name; }
  void write_secret(const char* name, const char* text) const {
    write_text(path(name), text);
    fs::permissions(path(name), fs::perms::owner_read | fs::perms::owner_write);
  }
  void edit_site(const std::string& from, const std::string& to) const {
    std::string text = read_text(path("site.toml"));
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos);
    write_text(path("site.toml"), text.replace(at, from.size(), to));
  }
  [[nodiscard]] testing::Outcome doctor() const {
    auto outcome = run({"doctor", path("site.toml")});
    EXPECT_THAT(outcome.out + outcome.err, Not(HasSubstr("SECRET")));
    return outcome;
  }
  /// By name: "value", or "value ! problem".
  [[nodiscard]] std::map<std::string, std::string> facts() const {
    std::map<std::string, std::string> facts;
    const auto outcome = run({"doctor", path("site.toml"), "--json"});
    EXPECT_THAT(outcome.out + outcome.err, Not(HasSubstr("SECRET")));
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(json["sound"], outcome.exit_code == 0);
    for (const auto& fact : json["facts"]) {
      const auto problem = fact.value("problem", std::string{});
      facts[fact["name"]] =
          fact["value"].get<std::string>() + (problem.empty() ? "" : " ! " + problem);
    }
    return facts;
  }
  /// A problem that stops work, in words and by the exit code.
  void expect_problem(const std::string& words) const {
    const auto outcome = doctor();
    EXPECT_EQ(outcome.exit_code, 1) << words;
    EXPECT_THAT(outcome.out, HasSubstr("  ! ")) << words;
    EXPECT_THAT(outcome.out, HasSubstr(words));
  }

  recald::testing::TemporaryFolder folder_;
};

TEST_F(DoctorCommand, TheMachineAlone) {
  const auto outcome = run({"doctor"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr(kVersion), HasSubstr(kBuildType), HasSubstr("SQLite 3."),
                    HasSubstr("libmodbus 3."), HasSubstr("OpenSSL "), HasSubstr("libcurl "),
                    HasSubstr("Linux "), HasSubstr("synchronised"), HasSubstr("EnergyPlus")));
  EXPECT_THAT(outcome.out,
              HasSubstr(fmt::format("{} processors", std::thread::hardware_concurrency())));
}

/// What a shell command prints, in one line.
std::string said_by(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe{::popen(command.c_str(), "r"), ::pclose};
  std::array<char, 256> line{};
  const bool has_some = std::fgets(line.data(), line.size(), pipe.get()) != nullptr;
  std::string text = has_some ? line.data() : "";
  while (text.ends_with('\n')) text.pop_back();
  return text;
}

TEST_F(DoctorCommand, SaysCommitAndUser) {
  EXPECT_EQ(facts().at("user"), said_by("id -un") + " (" + said_by("id -u") + ")");
  const std::string build = facts().at("build");
  const std::string in_checkout = "git -C '" RECALD_SOURCE_DIR "' rev-parse --short=12 ";
  if (said_by(in_checkout + "HEAD 2>/dev/null").empty()) {
    EXPECT_THAT(build, HasSubstr("unknown commit"));
    return;
  }
  // That of the build, since which there may have been others.
  const std::string commit = build.substr(build.rfind(' ') + 1);
  EXPECT_EQ(said_by(in_checkout + "'" + commit + "^{commit}' 2>/dev/null"), commit) << build;
}

TEST_F(DoctorCommand, OpensWhatTheSiteFileNames) {
  const auto found = facts();
  EXPECT_EQ(found.at("readings steam.csv"), "can be read, 0.0 MiB");
  EXPECT_EQ(found.at("store's folder ."), "can be written");
  EXPECT_EQ(found.at("backups' folder backups"), "can be written");
  EXPECT_THAT(found.at("[http] key_file"), HasSubstr("can be read"));
  fs::remove(path("steam.csv"));
  expect_problem(path("steam.csv").string() + " does not exist; put it there");
  fs::create_directory(path("steam.csv"));
  expect_problem(path("steam.csv").string() + " is a folder, not a file");
  fs::remove(path("steam.csv"));
  ASSERT_EQ(::mkfifo(path("steam.csv").c_str(), 0600), 0);  // would wait for ever
  expect_problem(path("steam.csv").string() + " is not a file");
}

TEST_F(DoctorCommand, OpensWeatherMapsAndCertificates) {
  edit_site("[alerts]\n", R"([weather]
file = "place.csv"

[bus.roof]
type = "tcp"
host = "127.0.0.1"
port = 1

[[meter]]
id = "roof"
utility = "electricity"
source = "modbus"
bus = "roof"
unit = 7
map = "own.toml"
rated_kW = 400

[alerts]
)");
  const std::string site = read_text(path("site.toml"));
  write_text(path("site.toml"), site + "trusted_certificate = \"root.pem\"\n");
  write_text(path("own.toml"), std::string{*shipped_register_map("abb-b23")});
  write_text(path("place.csv"), "timestamp,dry_bulb_C\n");
  const auto found = facts();
  EXPECT_EQ(found.at("weather place.csv"), "can be read, 0.0 MiB");
  EXPECT_EQ(found.at("register map own.toml"), "can be read, 0.0 MiB");
  EXPECT_THAT(found.at("trusted certificate root.pem"),
              AllOf(HasSubstr("cannot be read ! "), HasSubstr("root.pem does not exist")));
}

// Only where a user has fewer rights than root can be seen what a right keeps away.
TEST_F(DoctorCommand, SaysWhatThisUserMayNotOpen) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can become somebody else";
  fs::permissions(path(""), fs::perms{0755});
  fs::permissions(path("steam.csv"), fs::perms{0600});
  ASSERT_EQ(::seteuid(65534), 0);
  const auto found = facts();
  ASSERT_EQ(::seteuid(0), 0);
  EXPECT_THAT(found.at("user"), HasSubstr("(65534)"));
  EXPECT_THAT(found.at("readings steam.csv"), HasSubstr("may not be read by this user"));
  EXPECT_THAT(found.at("store's folder ."), HasSubstr("may not be written by this user"));
}

TEST_F(DoctorCommand, ASoundSite) {
  fs::create_directory(path("backups"));
  fs::copy(path("site.db"), path("backups/site-2024-03-02.db"));
  const auto outcome = doctor();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  const auto found = facts();
  EXPECT_THAT(found.at("site file"), HasSubstr("site.toml, SHA-256 "));
  EXPECT_EQ(found.at("meters"), "1 csv, 1 http");
  EXPECT_THAT(found.at("store"), AllOf(HasSubstr("1 meter, newest reading 2024-04-11T15:45:00Z"),
                                       HasSubstr("MiB, schema version "), Not(HasSubstr("!"))));
  EXPECT_THAT(found.at("store's structure"), HasSubstr("intact"));
  EXPECT_EQ(found.at("events"), "of the newest 4: 2 meter_silent, 1 store_refused");
  EXPECT_EQ(found.at("newest calibration"), "1, failed, asked for at 2024-03-01T00:00:00Z");
  EXPECT_THAT(found.at("backups"), AllOf(HasSubstr("1, the newest of 2024-03-02"),
                                         HasSubstr("days old; see whether the daemon runs")));
  EXPECT_EQ(found.at("daemon"), "not running");
  EXPECT_EQ(found.at("[http] token_file"), "can be read, by its owner alone");
  EXPECT_THAT(found.at("[http] certificate_file"),
              AllOf(HasSubstr("ends 20"), Not(HasSubstr("!"))));
  EXPECT_EQ(found.at("[alerts] destination 2: password_file"), "can be read, by its owner alone");
}

/// Names, contents and times of all that is in the folder.
std::map<std::string, std::string> all_of(const fs::path& folder) {
  std::map<std::string, std::string> all;
  for (const auto& one : fs::recursive_directory_iterator(folder)) {
    struct stat about {};
    EXPECT_EQ(::stat(one.path().c_str(), &about), 0);
    all[one.path().string()] =
        fmt::format("{} {} {}", about.st_mtim.tv_sec, about.st_mtim.tv_nsec,
                    one.is_regular_file() ? read_text(one.path()) : std::string{});
  }
  return all;
}

TEST_F(DoctorCommand, WritesNothing) {
  const auto before = all_of(path(""));
  ASSERT_EQ(doctor().exit_code, 0);
  EXPECT_EQ(all_of(path("")), before);
  fs::remove(path("site.db"));
  const auto without = all_of(path(""));
  EXPECT_EQ(facts().at("store"), "none yet");
  EXPECT_EQ(all_of(path("")), without);
}

TEST_F(DoctorCommand, ASiteFileThatCannotBeReadIsSaidWithoutItsSecrets) {
  edit_site("smtps://mail.example.org", "recald:SECRET7 \\\"SECRET8\\\"@mail.example.org");
  edit_site("utility = \"steam\"", "utility = \"stream\"");
  expect_problem("'server' is (not shown)");
  expect_problem("site.toml:18: ");
  EXPECT_EQ(facts().count("store"), 0);
  fs::remove(path("site.toml"));
  expect_problem("site.toml");
}

TEST_F(DoctorCommand, SecretsThatOthersMayReadAndCertificatesThatEnd) {
  fs::permissions(path("mail-password"), fs::perms{0644});
  expect_problem("chmod 600");
  fs::permissions(path("mail-password"), fs::perms{0600});
  fs::remove(path("hook-token"));
  expect_problem("token file");
  write_secret("hook-token", "0123456789SECRET3");
  fs::permissions(path("tower.key"), fs::perms{0644});
  EXPECT_THAT(facts().at("[http] key_file"), HasSubstr("everybody may read"));
  recald::testing::write_self_signed(path(""), "tower");
  EXPECT_THAT(facts().at("[http] certificate_file"), HasSubstr("ends within 30 days"));
  EXPECT_EQ(doctor().exit_code, 0);
  recald::testing::write_self_signed(path(""), "tower", -60);
  expect_problem("the certificate has ended");
  write_text(path("tower.pem"), "no certificate");
  expect_problem("has no certificate (PEM)");
}

TEST_F(DoctorCommand, ADamagedStoreAndANewerOne) {
  const std::string whole = read_text(path("site.db"));
  recald::testing::damage_leaf(path("site.db"), "interval", 3);
  expect_problem("the daemon recovers the rows that can be read when it starts");
  write_text(path("site.db"), whole);
  ASSERT_TRUE(sqlite::Database::open(path("site.db"), {})
                  ->execute("CREATE TABLE more (thing TEXT); PRAGMA user_version = 99")
                  .has_value());
  expect_problem("use the newer recald that wrote it");
}

TEST_F(DoctorCommand, ASerialPortThatIsNotThere) {
  edit_site("[[meter]]", R"([bus.roof]
type = "rtu"
port = "ttyNOWHERE0"

[[meter]]
id = "roof"
utility = "electricity"
source = "modbus"
bus = "roof"
unit = 7
map = "abb-b23"
rated_kW = 400

[[meter]])");
  expect_problem("/dev/ttyNOWHERE0 does not exist");
}

TEST_F(DoctorCommand, ARunningDaemonIsAsked) {
  {
    const auto lock = system::FileLock::acquire(path("site.db.lock"));
    ASSERT_TRUE(lock.has_value());
    EXPECT_EQ(facts().at("daemon"), "a recald runs on the store");  // on a port that nobody knows
    const RunningServer server{[](const http::Request& request) {
      http::Response response;
      response.status = request.path == "/readyz" ? 503 : 404;
      response.body = R"({"status": "not_ready"})";
      return response;
    }};
    edit_site(
        "127.0.0.1:0\"\ntoken_file = \"token\"\ncertificate_file = \"tower.pem\"\nkey_file = "
        "\"tower.key\"\n",
        fmt::format("127.0.0.1:{}\"\n", server.port()));
    EXPECT_EQ(facts().at("daemon"), "a recald runs on the store, answers: not_ready");
  }
  EXPECT_EQ(facts().at("daemon"), "not running");
  const auto lock = system::FileLock::acquire(path("site.db.lock"));
  EXPECT_THAT(facts().at("daemon"), HasSubstr("a recald runs on the store, does not answer ! "));
  EXPECT_EQ(doctor().exit_code, 1);
}

}  // namespace
}  // namespace recald::daemon::doctor_command_test
