/// `recald check --meters` and `recald scan` against devices on loopback and on a pseudo-terminal.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>

#include "adapters/system/files/file_holders.hpp"
#include "daemon/commands/meters/scan_bus.hpp"
#include "tests/daemon/command_line.hpp"
#include "tests/support/register_device.hpp"
#include "tests/support/sample_site.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::daemon {
namespace {

using recald::testing::answer_of;
using recald::testing::Bytes;
using recald::testing::Piece;
using recald::testing::put_words;
using recald::testing::Registers;
using recald::testing::Script;
using recald::testing::ScriptedLine;
using recald::testing::ScriptedServer;
using recald::testing::TemporaryFolder;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Outcome;
using testing::run;

/// Several units behind one endpoint; what is not listed is silent.
struct Plant {
  std::map<int, Registers> units;
  std::map<int, Bytes> identities;  ///< PDU of the reply to 0x2B.

  [[nodiscard]] Script script() const {
    return [this](const Bytes& request, int) -> std::vector<Piece> {
      const int unit = request[6];
      const auto found = units.find(unit);
      if (found == units.end()) return {};
      if (request[7] != 0x2B) return {{{}, answer_of(found->second, request)}};
      const auto identity = identities.find(unit);
      if (identity == identities.end()) return {{{}, answer_of({}, request)}};
      Bytes frame{request[0], request[1], 0,
                  0,          0,          static_cast<std::uint8_t>(identity->second.size() + 1),
                  request[6]};
      frame.insert(frame.end(), identity->second.begin(), identity->second.end());
      return {{{}, frame}};
    };
  }
};

/// A site with one bus at the port, and what is given of meters.
std::string site_file(const TemporaryFolder& folder, std::uint16_t port,
                      const std::string& meters) {
  const std::string text =
      "[site]\nid = \"tower\"\ntimezone = \"Europe/Zurich\"\n[bus.plant]\n"
      "type = \"tcp\"\nhost = \"127.0.0.1\"\ntimeout = \"300ms\"\nport = " +
      std::to_string(port) + "\n" + meters;
  recald::testing::write_text(folder / "site.toml", text);
  return (folder / "site.toml").string();
}

std::string meter(const std::string& id, int unit, const std::string& map) {
  return "[[meter]]\nid = \"" + id + "\"\nsource = \"modbus\"\nutility = \"electricity\"\n" +
         "bus = \"plant\"\nunit = " + std::to_string(unit) + "\nmap = \"" + map +
         "\"\nrated_kW = 400\n";
}

/// An ABB B23: 1000 kWh imported, 25 kWh exported, 12.3 kW.
Registers abb() {
  Registers registers;
  put_words(registers, 0x5000, {0, 0, 1, 0x86A0, 0, 0, 0, 0x09C4});
  put_words(registers, 0x5B14, {0x0012, 0xC4B0});
  return registers;
}

TEST(CheckMeters, ShowsEveryFieldOfAMeterThatAnswers) {
  const Plant plant{{{7, abb()}}, {}};
  ScriptedServer device{plant.script()};
  const TemporaryFolder folder;
  const Outcome done =
      run({"check", site_file(folder, device.port(), meter("main", 7, "abb-b23")), "--meters"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("* energy_import            1000 kWh"));
  EXPECT_THAT(done.out, HasSubstr("  energy_export            25 kWh"));
  EXPECT_THAT(done.out, HasSubstr("* power                    12300 W"));
  EXPECT_THAT(done.out, Not(HasSubstr("!")));
  EXPECT_EQ(device.connections(), 1);
}

TEST(CheckMeters, AMeterThatDoesNotAnswerFailsAndTheOthersAreShown) {
  const Plant plant{{{7, abb()}}, {}};
  ScriptedServer device{plant.script()};
  const TemporaryFolder folder;
  const Outcome done = run(
      {"check",
       site_file(folder, device.port(), meter("dead", 9, "abb-b23") + meter("main", 7, "abb-b23")),
       "--meters"});
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_THAT(done.err,
              AllOf(HasSubstr("meter 'dead' (unit 9 at 127.0.0.1:"), HasSubstr("does not answer")));
  EXPECT_THAT(done.err, Not(HasSubstr("'main'")));
  EXPECT_THAT(done.out, HasSubstr("1000 kWh"));
}

// Which field a device refuses shows only when it is asked for alone.
TEST(CheckMeters, RefusedFieldsAreNamedOneByOne) {
  Plant plant{{{7, abb()}}, {}};
  for (int at = 0x5004; at < 0x5008; ++at) plant.units[7].erase(at);
  ScriptedServer device{plant.script()};
  const TemporaryFolder folder;
  const std::string site = site_file(folder, device.port(), meter("main", 7, "abb-b23"));
  const Outcome unmetered = run({"check", site, "--meters"});
  EXPECT_EQ(unmetered.exit_code, 0) << "the export is not what the meter is for";
  EXPECT_THAT(unmetered.out, HasSubstr("refused: exception 2 (illegal data address)"));
  EXPECT_THAT(unmetered.out, HasSubstr("1000 kWh"));

  Plant silent{{{7, {}}}, {}};
  ScriptedServer other{silent.script()};
  const Outcome metered =
      run({"check", site_file(folder, other.port(), meter("main", 7, "abb-b23")), "--meters"});
  EXPECT_EQ(metered.exit_code, 1);
  EXPECT_THAT(metered.err, HasSubstr("'energy_import' is refused: exception 2"));
}

TEST(CheckMeters, OddValuesAreExplained) {
  // Power with its words swapped; an energy in float whose steps are coarse.
  Plant plant{{{7, abb()}}, {}};
  put_words(plant.units[7], 0x5B14, {0xC4B0, 0x0012});
  ScriptedServer device{plant.script()};
  const TemporaryFolder folder;
  const Outcome done =
      run({"check", site_file(folder, device.port(), meter("main", 7, "abb-b23")), "--meters"});
  EXPECT_EQ(done.exit_code, 1) << "no load is so large";
  EXPECT_THAT(done.out, HasSubstr("! 'power' is"));
  EXPECT_THAT(done.out, HasSubstr("12300 W with order CDAB"));
}

TEST(CheckMeters, SunSpecModelsAreFound) {
  Registers registers;
  put_words(registers, 40'000, {0x5375, 0x6E53, 203, 105});
  put_words(registers, 40'004, std::vector<std::uint16_t>(105));
  put_words(registers, 40'002 + 18, {1230, 0, 0, 0, 1});
  put_words(registers, 40'002 + 46, {0, 1000, 0, 0, 0, 0, 0, 0, 2});
  const Plant plant{{{3, registers}}, {}};
  ScriptedServer device{plant.script()};
  const TemporaryFolder folder;
  const Outcome done = run(
      {"check", site_file(folder, device.port(), meter("sun", 3, "sunspec-meter")), "--meters"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("SunSpec model 203 at address 40002"));
  EXPECT_THAT(done.out, HasSubstr("* power                    12300 W"));
  EXPECT_THAT(done.out, HasSubstr("* energy_import            100000 Wh"));
}

TEST(CheckMeters, JsonHoldsEachMeter) {
  const Plant plant{{{7, abb()}}, {}};
  ScriptedServer device{plant.script()};
  const TemporaryFolder folder;
  const Outcome done = run({"check", site_file(folder, device.port(), meter("main", 7, "abb-b23")),
                            "--meters", "--json"});
  const auto json = nlohmann::json::parse(done.out);
  EXPECT_EQ(json.at("ok"), true);
  const auto& tried = json.at("meters").at(0);
  EXPECT_EQ(tried.at("meter"), "main");
  EXPECT_EQ(tried.at("fields").at(0).at("value"), 1000.0);
  EXPECT_EQ(tried.at("fields").at(0).at("metered"), true);
}

TEST(CheckMeters, WithoutLiveMetersThereIsNothingToTry) {
  const TemporaryFolder folder;
  recald::testing::write_text(folder / "x.csv",
                              "timestamp,meter,value,unit\n2024-01-01T00:00:00Z,x,1,kW\n"
                              "2024-01-01T00:15:00Z,x,2,kW\n");
  const std::string recorded =
      "[[meter]]\nid = \"x\"\nutility = \"electricity\"\nfile = \"x.csv\"\n";
  const Outcome done = run({"check", site_file(folder, 1502, recorded), "--meters"});
  EXPECT_EQ(done.exit_code, 1);
  EXPECT_THAT(done.err, HasSubstr("no [[meter]] has source = \"modbus\""));
}

// Another program on the line: each garbles the other's frames.
TEST(CheckMeters, ASerialPortThatIsInUseIsLeftAlone) {
  ScriptedLine line{[](const Bytes&, int) { return std::vector<Piece>{}; }};
  int ready[2];
  ASSERT_EQ(::pipe(ready), 0);
  const pid_t holder = ::fork();
  ASSERT_GE(holder, 0);
  if (holder == 0) {
    const int descriptor = ::open(line.device().c_str(), O_RDWR | O_NOCTTY);
    const char said = descriptor >= 0 ? 'y' : 'n';
    (void)!::write(ready[1], &said, 1);
    for (;;) ::pause();
  }
  char said = 'n';
  ASSERT_EQ(::read(ready[0], &said, 1), 1);
  EXPECT_EQ(said, 'y');
  const TemporaryFolder folder;
  std::string text =
      "[site]\nid = \"tower\"\ntimezone = \"Europe/Zurich\"\n[bus.plant]\n"
      "type = \"rtu\"\nport = \"" +
      line.device() + "\"\n" + meter("main", 7, "abb-b23");
  recald::testing::write_text(folder / "site.toml", text);
  const Outcome checked = run({"check", (folder / "site.toml").string(), "--meters"});
  const Outcome scanned = run({"scan", (folder / "site.toml").string(), "--bus", "plant"});
  const auto holders = system::holders_of(line.device());
  ::kill(holder, SIGKILL);
  ::waitpid(holder, nullptr, 0);
  ::close(ready[0]);
  ::close(ready[1]);
  EXPECT_EQ(checked.exit_code, 1);
  const std::string words = "is open in process " + std::to_string(holder);
  EXPECT_THAT(checked.err, HasSubstr(words));
  EXPECT_EQ(scanned.exit_code, 1);
  EXPECT_THAT(scanned.err, HasSubstr(words));
  EXPECT_EQ(line.requests(), 0);
  EXPECT_TRUE(std::ranges::any_of(
      holders, [&](const system::FileHolder& one) { return one.process == holder; }));
}

TEST(Scan, FindsUnitsWithWhatTheySayOfThemselves) {
  Registers sunspec;
  put_words(sunspec, 0, {0});
  put_words(sunspec, 40'000, {0x5375, 0x6E53, 1, 2, 0, 0, 203, 1, 0, 0xFFFF, 0});
  const std::string vendor = "Siemens";
  const std::string product =
      "PAC\x1B"
      "3200";
  Bytes identity{0x2B, 0x0E, 1, 1, 0, 0, 2, 0, static_cast<std::uint8_t>(vendor.size())};
  identity.insert(identity.end(), vendor.begin(), vendor.end());
  identity.push_back(1);
  identity.push_back(static_cast<std::uint8_t>(product.size()));
  identity.insert(identity.end(), product.begin(), product.end());
  const Plant plant{{{2, abb()}, {4, sunspec}}, {{2, identity}}};
  ScriptedServer device{plant.script()};
  const TemporaryFolder folder;
  const std::string site = site_file(folder, device.port(), meter("main", 2, "abb-b23"));
  const Outcome done = run({"scan", site, "--bus", "plant", "--units", "2-4"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("unit 2    function 3: exception 2 (illegal data address)"));
  EXPECT_THAT(done.out, HasSubstr("Siemens PAC\\x1B"
                                  "3200"));
  EXPECT_THAT(done.out, HasSubstr("in the site file: main"));
  EXPECT_THAT(done.out, Not(HasSubstr("unit 3")));
  EXPECT_THAT(done.out, HasSubstr("unit 4    function 3: yes; function 4: yes"));
  EXPECT_THAT(done.out, HasSubstr("SunSpec models 1 @40002, 203 @40006"));

  const auto json =
      nlohmann::json::parse(run({"scan", site, "--bus", "plant", "--units", "4", "--json"}).out);
  EXPECT_EQ(json.at("found").size(), 1u);
  EXPECT_EQ(json.at("found").at(0).at("sunspec_models").at(1).at("id"), 203);
  EXPECT_EQ(json.at("found").at(0).at("identity"), nullptr);
}

TEST(Scan, NothingFoundAndNobodyThereAreSaid) {
  const Plant plant;
  ScriptedServer device{plant.script()};
  const TemporaryFolder folder;
  const Outcome silent = run({"scan", site_file(folder, device.port(), meter("main", 1, "abb-b23")),
                              "--bus", "plant", "--units", "5"});
  EXPECT_EQ(silent.exit_code, 1);
  EXPECT_THAT(silent.err, HasSubstr("no unit from 5 to 5 answers at 127.0.0.1:"));
  const Outcome unreachable = run({"scan", site_file(folder, 1, meter("main", 1, "abb-b23")),
                                   "--bus", "plant", "--units", "1-247"});
  EXPECT_EQ(unreachable.exit_code, 1);
  EXPECT_THAT(unreachable.err, HasSubstr("127.0.0.1:1: no connection"));
}

TEST(Scan, WrongUsageIsOneSentence) {
  const TemporaryFolder folder;
  const std::string site = site_file(folder, 1, meter("main", 1, "abb-b23"));
  for (const char* units : {"0", "248", "5-4", "1-", "-3", "all", "1-2-3", ""}) {
    const Outcome done = run({"scan", site, "--bus", "plant", "--units", units});
    EXPECT_EQ(done.exit_code, 2) << units;
    EXPECT_THAT(done.err, HasSubstr("--units is '" + std::string{units} + "'"));
  }
  const Outcome nobus = run({"scan", site, "--bus", "roof"});
  EXPECT_EQ(nobus.exit_code, 1);
  EXPECT_THAT(nobus.err, HasSubstr("there is no [bus.roof]; the buses of the site are plant"));
  EXPECT_EQ(parse_units("1-247")->last, 247);
  EXPECT_EQ(parse_units("17")->first, 17);
}

}  // namespace
}  // namespace recald::daemon
