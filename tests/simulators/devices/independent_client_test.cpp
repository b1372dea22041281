/// Simulated devices read by clients that share nothing with us: mbpoll and pymodbus.
#include <gmock/gmock.h>

#include "tests/simulators/devices/layout_words.hpp"
#include "tests/support/simulated_meters.hpp"

namespace recald::independent_client_test {
namespace {

namespace fs = std::filesystem;
using recald::testing::BackgroundProcess;
using recald::testing::LayoutWords;
using recald::testing::SimulatedMeters;
using ::testing::HasSubstr;

constexpr const char* kMbpoll = "/usr/bin/mbpoll";
constexpr const char* kPython = "/usr/bin/python3";
constexpr const char* kPymodbus = "/usr/lib/python3/dist-packages/pymodbus";

class IndependentClient : public ::testing::Test {
 protected:
  IndependentClient()
      : meters_{RECALD_SIM_PROGRAM,
                "[[endpoint]]\n" + recald::testing::devices_of_all_layouts() +
                    "[[endpoint]]\ntype = \"rtu\"\nlink = \"line\"\n" +
                    recald::testing::devices_of_all_layouts(),
                {{"hold.faults", recald::testing::kHoldCounters}},
                {"--faults", "hold.faults"}} {}

  std::string said_by(const std::vector<std::string>& command) {
    const fs::path said = folder_ / std::to_string(++runs_);
    BackgroundProcess process{command, said};
    EXPECT_EQ(process.wait(), 0) << recald::testing::read_text(said);
    return recald::testing::read_text(said);
  }

  SimulatedMeters meters_;
  recald::testing::TemporaryFolder folder_;
  int runs_ = 0;
};

TEST_F(IndependentClient, MbpollReadsEveryLayout) {
  if (!fs::exists(kMbpoll)) GTEST_SKIP() << "the Debian package mbpoll is absent";
  int unit = 0;
  for (const LayoutWords& each : recald::testing::layout_words()) {
    ++unit;
    SCOPED_TRACE(each.layout);
    // Registers in hexadecimal, numbered from 0; holding registers are its type 4, input 3.
    const std::vector<std::string> what{"-1", "-0",
                                        "-a", std::to_string(unit),
                                        "-t", each.function == 3 ? "4:hex" : "3:hex",
                                        "-r", std::to_string(each.energy_at),
                                        "-c", std::to_string(each.energy.size())};
    std::vector<std::string> tcp{kMbpoll, "-p", std::to_string(meters_.port(0))};
    std::vector<std::string> rtu{kMbpoll, "-m", "rtu", "-b", "115200", "-P", "none"};
    tcp.insert(tcp.end(), what.begin(), what.end());
    tcp.emplace_back("127.0.0.1");
    rtu.insert(rtu.end(), what.begin(), what.end());
    rtu.push_back(meters_.address(1));
    for (const auto& command : {tcp, rtu}) {
      const std::string said = said_by(command);
      for (std::size_t i = 0; i < each.energy.size(); ++i) {
        char line[32];
        std::snprintf(line, sizeof line, "[%d]: \t0x%04X\n", each.energy_at + static_cast<int>(i),
                      each.energy[i]);
        EXPECT_THAT(said, HasSubstr(line));
      }
    }
  }
}

TEST_F(IndependentClient, PymodbusReadsEveryLayout) {
  if (!fs::exists(kPymodbus)) GTEST_SKIP() << "the Debian package python3-pymodbus is absent";
  int unit = 0;
  for (const LayoutWords& each : recald::testing::layout_words()) {
    ++unit;
    SCOPED_TRACE(each.layout);
    std::string expected;
    for (const std::uint16_t word : each.power) {
      expected += (expected.empty() ? "" : " ") + std::to_string(word);
    }
    for (const std::string& where :
         {"tcp:" + std::to_string(meters_.port(0)), meters_.address(1)}) {
      EXPECT_EQ(said_by({kPython, RECALD_SOURCE_DIR "/tests/support/modbus_client.py", where,
                         std::to_string(unit), std::to_string(each.function),
                         std::to_string(each.power_at), std::to_string(each.power.size())}),
                expected + "\n");
    }
  }
}

}  // namespace
}  // namespace recald::independent_client_test
