/// The connection against a server that shares nothing with us: pymodbus, over TCP and over a line.
#include <gmock/gmock.h>

#include "adapters/modbus/connection.hpp"
#include "tests/support/background_process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::modbus {
namespace {

using namespace std::chrono_literals;
using recald::testing::BackgroundProcess;
using ::testing::ElementsAre;

/// tests/support/modbus_server.py: register a of unit u, 3 and 7, holds 1000 u + a.
class PymodbusServer : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists("/usr/lib/python3/dist-packages/pymodbus")) {
      GTEST_SKIP() << "the Debian package python3-pymodbus is absent";
    }
    const auto said = folder_ / "said.txt";
    recald::testing::write_text(said, "");
    server_ = std::make_unique<BackgroundProcess>(
        std::vector<std::string>{"/usr/bin/python3",
                                 RECALD_SOURCE_DIR "/tests/support/modbus_server.py", GetParam()},
        said);
    ASSERT_TRUE(recald::testing::eventually(
        [&] { return recald::testing::read_text(said).ends_with('\n'); }));
    where_ = recald::testing::read_text(said);
    where_.pop_back();
  }

  [[nodiscard]] Endpoint endpoint() const {
    if (GetParam() == "rtu") return SerialPort{.device = where_, .baud = 115'200};
    return TcpEndpoint{.host = "127.0.0.1", .port = static_cast<std::uint16_t>(std::stoi(where_))};
  }

  recald::testing::TemporaryFolder folder_;
  std::unique_ptr<BackgroundProcess> server_;
  std::string where_;
};

TEST_P(PymodbusServer, IsRead) {
  Connection connection{endpoint()};
  for (const Function function :
       {Function::read_holding_registers, Function::read_input_registers}) {
    const auto three = connection.read({3, function, 10, 3}, 10s);
    ASSERT_TRUE(three.has_value()) << three.error().what;
    EXPECT_THAT(*three, ElementsAre(3010, 3011, 3012));
    const auto seven = connection.read({7, function, 0, 125}, 10s);
    ASSERT_TRUE(seven.has_value()) << seven.error().what;
    ASSERT_EQ(seven->size(), 125U);
    EXPECT_EQ(seven->front(), 7000);
    EXPECT_EQ(seven->back(), 7124);
  }
  EXPECT_TRUE(connection.is_open());
}

TEST_P(PymodbusServer, SaysThatARegisterIsNotThere) {
  Connection connection{endpoint()};
  const auto beyond = connection.read({3, Function::read_holding_registers, 5000, 2}, 10s);
  ASSERT_FALSE(beyond.has_value());
  EXPECT_EQ(beyond.error().fault, ReadFault::exception);
  EXPECT_EQ(beyond.error().exception_code, 2);
  EXPECT_TRUE(connection.read({3, Function::read_holding_registers, 0, 1}, 10s).has_value());
}

INSTANTIATE_TEST_SUITE_P(OverBoth, PymodbusServer, ::testing::Values("tcp", "rtu"),
                         [](const auto& each) { return each.param; });

}  // namespace
}  // namespace recald::modbus
