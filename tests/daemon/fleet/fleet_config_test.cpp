#include "daemon/fleet/config/fleet_config.hpp"

#include <gtest/gtest.h>

#include <string>

namespace recald::daemon {
namespace {

constexpr auto kRecord =
    "[record]\nurl = \"postgresql://recald@db.example.org/fleet?sslmode=verify-full\"\n";

std::vector<std::string> problems_of(const std::string& text) {
  const auto config = parse_fleet(text, "/etc/recald/fleet.toml");
  return config ? std::vector<std::string>{} : config.error();
}

TEST(FleetConfig, HasWhatAWorkerNeeds) {
  const auto config = parse_fleet(std::string{kRecord} + R"(password_file = "db-password"
[mqtt]
url = "mqtts://broker.example.org"
[worker]
jobs = 3
folder = "work"
time_max = "10m"
memory_max_MB = 2000
)",
                                  "/etc/recald/fleet.toml");
  ASSERT_TRUE(config) << config.error().front();
  EXPECT_EQ(config->record.password_file, "/etc/recald/db-password");
  ASSERT_TRUE(config->broker);
  EXPECT_EQ(config->worker.jobs, 3);
  EXPECT_EQ(config->worker.folder, "/etc/recald/work");
  EXPECT_EQ(config->worker.time_max, std::chrono::minutes{10});
  EXPECT_EQ(config->worker.memory_max_bytes, 2'000'000'000u);
}

TEST(FleetConfig, TheExampleIsRead) {
  const auto config = load_fleet(RECALD_SOURCE_DIR "/daemon/fleet/fleet.toml");
  ASSERT_TRUE(config) << config.error().front();
  EXPECT_EQ(config->worker.jobs, 2);
  ASSERT_TRUE(config->http);
  EXPECT_EQ(config->http->port, 8090);
}

TEST(FleetConfig, AnAddressWithAPasswordIsRefusedWithoutRepeatingIt) {
  const auto problems =
      problems_of("[record]\nurl = \"postgresql://recald:hunter2@localhost/fleet\"\n");
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems.front().find("password_file"), std::string::npos) << problems.front();
  EXPECT_EQ(problems.front().find("hunter2"), std::string::npos) << problems.front();
}

// libpq gives the password to whoever answers, unless it is told to look.
TEST(FleetConfig, ADatabaseElsewhereIsVerifiedOrSaidToBeTrusted) {
  const auto is_refused = [](const std::string& url) {
    const auto problems = problems_of("[record]\nurl = \"" + url + "\"\n");
    return !problems.empty() && problems.front().find("sslmode=verify-full") != std::string::npos;
  };
  for (const char* here :
       {"postgresql://recald@localhost/fleet", "postgresql://recald@127.0.0.1:5433/fleet",
        "postgresql://[::1]:5432/fleet", "postgresql:///fleet", "postgresql:///fleet?host=/run/pg",
        "postgresql://recald@%2Frun%2Fpostgresql/fleet", "postgresql://localhost,127.0.0.2/fleet",
        "postgresql://db/fleet?sslmode=verify-full&sslrootcert=/etc/ca.pem",
        "postgresql://db/fleet?application_name=x&sslmode=disable",
        "postgresql://db?sslmode=require"}) {
    EXPECT_FALSE(is_refused(here)) << here;
  }
  for (const char* elsewhere :
       {"postgresql://recald@db.example.org/fleet", "postgres://db/fleet?sslmode=prefer",
        "postgresql://db/fleet?sslmode=allow", "postgresql://localhost,db.example.org/fleet",
        "postgresql://127.0.0.1.example.org/fleet", "postgresql:///fleet?host=db.example.org",
        "postgresql://localhost/fleet?hostaddr=10.0.0.5", "postgresql://[2001:db8::1]:5432/fleet",
        "postgresql://db/fleet?xsslmode=disable", "postgresql://db/sslmode=disable"}) {
    EXPECT_TRUE(is_refused(elsewhere)) << elsewhere;
  }
}

TEST(FleetConfig, SaysWhatIsMissingOrWrong) {
  EXPECT_NE(problems_of("").front().find("[record] is missing"), std::string::npos);
  EXPECT_EQ(problems_of("[record]\nurl = \"mysql://db/fleet\"\n").size(), 1u);
  EXPECT_EQ(problems_of(std::string{kRecord} + "[worker]\njobs = -1\n").size(), 1u);
  EXPECT_EQ(problems_of(std::string{kRecord} + "[worker]\nmemory_max_MB = 10\n").size(), 1u);
  EXPECT_EQ(problems_of(std::string{kRecord} + "[workers]\n").size(), 1u);
}

}  // namespace
}  // namespace recald::daemon
