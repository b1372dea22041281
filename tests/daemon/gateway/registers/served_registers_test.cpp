/// The registers of the real program, as mbpoll and pymodbus read them: neither shares anything
/// with us.
#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/daemon/command_line.hpp"
#include "tests/daemon/serving_daemon.hpp"

namespace recald::daemon::served_registers_test {
namespace {

using Json = nlohmann::ordered_json;
using recald::testing::BackgroundProcess;
using recald::testing::eventually;
using recald::testing::run_in_shell;
using recald::testing::ServingDaemon;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
namespace fs = std::filesystem;

constexpr const char* kMbpoll = "/usr/bin/mbpoll";
constexpr const char* kPymodbus = "/usr/lib/python3/dist-packages/pymodbus";

/// Two pushed meters: one with readings since the month before last, one with none.
class ServedRegisters : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kMbpoll)) GTEST_SKIP() << "the Debian package mbpoll is absent";
    if (!fs::exists(kPymodbus)) GTEST_SKIP() << "the Debian package python3-pymodbus is absent";
    write_site("127.0.0.1:0");
  }

  void write_site(const std::string& modbus) {
    recald::testing::write_text(folder_ / "site.toml",
                                "[site]\nid = \"tower\"\ntimezone = \"America/Chicago\"\n"
                                "[http]\nlisten = \"127.0.0.1:0\"\n[modbus]\nlisten = \"" +
                                    modbus + "\"\n" + meter("main") + meter("empty"));
  }
  static std::string meter(const std::string& id) {
    return "[[meter]]\nid = \"" + id + "\"\nsource = \"http\"\nutility = \"electricity\"\n";
  }

  /// With readings from 75 days ago to the last full hour; months close when a daemon starts.
  void push() {
    const ServingDaemon daemon{RECALD_PROGRAM, folder_.path()};
    const auto now = std::chrono::floor<std::chrono::hours>(std::chrono::system_clock::now());
    const auto count = 75 * 24 * 4;
    const std::string pushed = daemon.post(
        "/api/v1/readings",
        recald::testing::readings_json(now - std::chrono::days{75}, std::chrono::minutes{15}, count,
                                       [](int i) { return 50.0 + 20.0 * std::sin(0.01 * i); }));
    ASSERT_THAT(pushed, HasSubstr(" 200 ")) << daemon.said();
  }

  void begin() {
    daemon_ = std::make_unique<ServingDaemon>(RECALD_PROGRAM, folder_.path());
    std::smatch found;
    const std::string said = daemon_->said();
    ASSERT_TRUE(std::regex_search(said, found, std::regex{"event=listening_modbus .*port=(\\d+)"}))
        << said;
    port_ = found[1];
  }

  /// What stands behind "[ADDRESS]: " in what mbpoll says.
  [[nodiscard]] std::string mbpoll(int address, const std::string& type) const {
    const auto [status, said] =
        run_in_shell(std::string{kMbpoll} + " -1 -0 -B -a 9 -t " + type + " -r " +
                     std::to_string(address) + " -p " + port_ + " 127.0.0.1 2>&1");
    std::smatch found;
    const std::regex line{"\\[" + std::to_string(address) + "\\]: \\t(.*)"};
    return std::regex_search(said, found, line) ? found[1].str() : said;
  }

  /// Two registers as pymodbus has them, put together by us.
  [[nodiscard]] double pymodbus_float(int address) const {
    const auto [status, said] = run_in_shell(
        "/usr/bin/python3 " RECALD_SOURCE_DIR "/tests/support/modbus_client.py tcp:" + port_ +
        " 1 4 " + std::to_string(address) + " 2 2>&1");
    std::uint32_t high = 0, low = 0;
    EXPECT_EQ(std::sscanf(said.c_str(), "%u %u", &high, &low), 2) << said;
    return std::bit_cast<float>(high << 16 | low);
  }

  /// Address of a register, as the command lists it. @param meter  Empty: of the site.
  [[nodiscard]] int address(const std::string& meter, const std::string& name) const {
    const Json map =
        Json::parse(testing::run({"registers", (folder_ / "site.toml").string(), "--json"}).out);
    for (const Json& one : map["registers"]) {
      const std::string of = one["meter"].is_null() ? "" : one["meter"].get<std::string>();
      if (of == meter && one["name"] == name) return one["address"].get<int>();
    }
    ADD_FAILURE() << "no register " << name << " of '" << meter << "'";
    return -1;
  }

  [[nodiscard]] Json get(const std::string& path) const {
    const std::string response = daemon_->get(path);
    return Json::parse(response.substr(response.find("\r\n\r\n") + 4));
  }

  recald::testing::TemporaryFolder folder_;
  std::unique_ptr<ServingDaemon> daemon_;
  std::string port_;
};

TEST_F(ServedRegisters, AreWhatTheApiSays) {
  push();
  begin();
  const int closed = address("main", "closed_daily_average");
  ASSERT_TRUE(eventually([&] { return mbpoll(closed, "3:float") != "nan"; })) << daemon_->said();
  const Json months = get("/api/v1/months?meter=main")["months"];
  const Json meter = get("/api/v1/meters/main");
  const Json month = months.back();
  const std::string month_number =
      month["month"].get<std::string>().substr(0, 4) + month["month"].get<std::string>().substr(5);
  EXPECT_EQ(mbpoll(address("main", "closed_month"), "3:int"), month_number);
  // For mbpoll six digits, the words of pymodbus with all that a float has.
  for (const auto& [name, value] : {std::pair{"closed_daily_average", month["daily_average_kWh"]},
                                    {"closed_peak", month["peak"]["peak_kW"]},
                                    {"closed_coverage", month["coverage"]},
                                    {"interval_mean", meter["last_interval"]["mean_kW"]},
                                    {"month_coverage", meter["open_month_coverage"]}}) {
    const auto expected = value.get<double>();
    const int at = address("main", name);
    EXPECT_EQ(pymodbus_float(at), static_cast<double>(static_cast<float>(expected))) << name;
    for (const char* type : {"3:float", "4:float"}) {  // input and holding registers
      EXPECT_NEAR(std::stod(mbpoll(at, type)), expected, 1e-5 * expected) << name << " " << type;
    }
  }
  EXPECT_EQ(mbpoll(address("", "map_version"), "3"), "1");
  EXPECT_EQ(mbpoll(address("", "meters"), "3"), "2");
  EXPECT_EQ(mbpoll(address("", "clock_ok"), "3"), "1");
  EXPECT_EQ(mbpoll(address("", "store_ok"), "3"), "1");
  EXPECT_EQ(mbpoll(address("", "model_age"), "3:float"), "nan");
  EXPECT_EQ(mbpoll(address("main", "state"), "3"), "4");
  EXPECT_EQ(mbpoll(address("empty", "interval_mean"), "3:float"), "nan");
  EXPECT_TRUE(std::isnan(pymodbus_float(address("empty", "closed_daily_average"))));
  EXPECT_EQ(mbpoll(address("empty", "quality"), "3"), "0");
  EXPECT_EQ(daemon_->end(SIGTERM), 0) << daemon_->said();
}

TEST_F(ServedRegisters, GoOnWithTheTime) {
  begin();
  const auto uptime = [&] { return std::stoi(mbpoll(address("", "uptime"), "3:int")); };
  const int first = uptime();
  EXPECT_TRUE(eventually([&] { return uptime() > first; }));
}

TEST_F(ServedRegisters, AreNotWrittenAndEndAfterTheLastMeter) {
  begin();
  EXPECT_EQ(run_in_shell("/usr/bin/python3 " RECALD_SOURCE_DIR "/tests/support/modbus_writes.py " +
                         port_ + " 2>&1")
                .said,
            "5 1\n6 1\n15 1\n16 1\n22 1\n23 1\n");
  EXPECT_THAT(
      run_in_shell(std::string{kMbpoll} + " -1 -0 -a 1 -t 4 -r 0 -p " + port_ + " 127.0.0.1 7 2>&1")
          .said,
      HasSubstr("Illegal function"));
  EXPECT_EQ(mbpoll(0, "4"), "1");
  EXPECT_THAT(mbpoll(100 + 2 * 64, "3"), HasSubstr("Illegal data address"));
  EXPECT_EQ(mbpoll(100 + 2 * 64 - 1, "3"), "0");
}

TEST_F(ServedRegisters, AreAtOneInterface) {
  begin();
  EXPECT_THAT(
      run_in_shell(std::string{kMbpoll} + " -1 -0 -a 1 -t 3 -r 0 -p " + port_ + " 127.0.0.2 2>&1")
          .said,
      HasSubstr("Connection refused"));
  EXPECT_EQ(mbpoll(0, "3"), "1");
}

TEST_F(ServedRegisters, AnotherAddressNeedsARestart) {
  begin();
  write_site("127.0.0.2:0");
  const auto rejected = [&] {
    return daemon_->said().find("a changed [modbus] listen needs a restart") != std::string::npos;
  };
  daemon_->signal(SIGHUP);
  EXPECT_TRUE(eventually(rejected)) << daemon_->said();
  EXPECT_EQ(mbpoll(0, "3"), "1");
}

TEST_F(ServedRegisters, AnAddressThatIsTakenIsSaid) {
  begin();
  fs::create_directory(folder_ / "second");
  const std::string site = recald::testing::read_text(folder_ / "site.toml");
  recald::testing::write_text(folder_ / "second/site.toml",
                              std::regex_replace(site, std::regex{"modbus]\nlisten = .*"},
                                                 "modbus]\nlisten = \"127.0.0.1:" + port_ + "\""));
  const auto [status, said] = run_in_shell(std::string{RECALD_PROGRAM} + " run " +
                                           (folder_ / "second/site.toml").string() + " 2>&1");
  EXPECT_NE(status, 0);
  EXPECT_THAT(said, HasSubstr("Modbus registers cannot be served at 127.0.0.1:" + port_ +
                              ": Address already in use"));
}

TEST(RegistersCommand, ListsTheMapOfASite) {
  recald::testing::TemporaryFolder folder;
  recald::testing::write_text(folder / "site.toml",
                              "[site]\nid = \"x\"\ntimezone = \"UTC\"\n[[meter]]\nid = \"m\"\n"
                              "utility = \"gas\"\nfile = \"m.csv\"\n");
  const std::string site = (folder / "site.toml").string();
  const std::string csv = testing::run({"registers", site, "--csv"}).out;
  EXPECT_THAT(csv,
              HasSubstr("address,registers,type,meter,name,unit,meaning\n0,1,u16,,map_version,,"));
  EXPECT_THAT(
      csv,
      HasSubstr(
          "\n102,2,f32,m,power,kW,\"at the last answer of a polled meter, while it answers\"\n"));
  EXPECT_THAT(testing::run({"registers", site}).out, HasSubstr("    102  f32  m "));
  EXPECT_THAT(testing::run({"registers"}).out, HasSubstr("# The map of the registers, version 1"));
  const auto wrong = testing::run({"registers", (folder / "none.toml").string()});
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_EQ(testing::run({"registers", "--csv"}).exit_code, 2);
}

}  // namespace
}  // namespace recald::daemon::served_registers_test
