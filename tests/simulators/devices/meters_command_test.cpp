/// `recald-sim meters` as a process, asked by libmodbus and by bare sockets.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <modbus/modbus.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <chrono>

#include "tests/simulators/devices/layout_words.hpp"
#include "tests/support/simulated_meters.hpp"

namespace recald::meters_command_test {
namespace {

using recald::testing::eventually;
using recald::testing::LayoutWords;
using recald::testing::SimulatedMeters;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

constexpr const char* kAbb = "[[endpoint.device]]\nunit = 1\nlayout = \"abb-b23\"\nload_kW = 60\n";

/// An independent client.
class Client {
 public:
  explicit Client(std::uint16_t port) : context_(modbus_new_tcp("127.0.0.1", port)) {}
  explicit Client(const std::string& device)
      : context_(modbus_new_rtu(device.c_str(), 115'200, 'N', 8, 1)) {}
  ~Client() {
    modbus_close(context_);
    modbus_free(context_);
  }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  bool connect() { return modbus_connect(context_) == 0; }
  /// Empty on failure; errno says why.
  std::vector<std::uint16_t> read(int unit, int function, int address, int count) {
    modbus_set_slave(context_, unit);
    modbus_set_response_timeout(context_, 5, 0);
    std::vector<std::uint16_t> words(static_cast<std::size_t>(count));
    const int got = function == 3
                        ? modbus_read_registers(context_, address, count, words.data())
                        : modbus_read_input_registers(context_, address, count, words.data());
    if (got != count) words.clear();
    return words;
  }
  int write(int unit, int address) {
    modbus_set_slave(context_, unit);
    return modbus_write_register(context_, address, 1);
  }

 private:
  modbus_t* context_;
};

/// Bytes to and from a port, no protocol.
class Socket {
 public:
  explicit Socket(std::uint16_t port) : descriptor_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(port);
    const timeval patience{30, 0};  // a test that waits for ever tells nobody why
    ::setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    is_open_ = ::connect(descriptor_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~Socket() { ::close(descriptor_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  [[nodiscard]] bool is_open() const { return is_open_; }
  void put(const Bytes& bytes) const {
    ASSERT_EQ(::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }
  /// So many bytes, or fewer when the other end closes.
  [[nodiscard]] Bytes get(std::size_t count) const {
    if (count == 0) return {};  // recv would wait for a first byte
    Bytes bytes(count);
    const auto got = ::recv(descriptor_, bytes.data(), count, MSG_WAITALL);
    bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return bytes;
  }
  /// Bytes, or the end of the connection.
  [[nodiscard]] bool has_bytes(int within_ms = 0) const {
    pollfd waiting{descriptor_, POLLIN, 0};
    return ::poll(&waiting, 1, within_ms) > 0;
  }

 private:
  int descriptor_;
  bool is_open_;
};

const Bytes kReadEnergy{0, 9, 0, 0, 0, 6, 1, 3, 0x50, 0, 0, 4};
/// 1 234 kWh.
const Bytes kHonest{0, 9, 0, 0, 0, 11, 1, 3, 8, 0, 0, 0, 0, 0, 1, 0xE2, 0x08};

TEST(MetersCommand, EveryLayoutIsReadOverTcpAndOverALine) {
  SimulatedMeters meters{RECALD_SIM_PROGRAM,
                         "[[endpoint]]\n" + recald::testing::devices_of_all_layouts() +
                             "[[endpoint]]\ntype = \"rtu\"\nlink = \"line\"\n" +
                             recald::testing::devices_of_all_layouts(),
                         {{"hold.faults", recald::testing::kHoldCounters}},
                         {"--faults", "hold.faults"}};
  Client tcp{meters.port(0)};
  Client line{meters.address(1)};
  for (Client* client : {&tcp, &line}) {
    ASSERT_TRUE(client->connect()) << modbus_strerror(errno);
    int unit = 0;
    for (const LayoutWords& each : recald::testing::layout_words()) {
      ++unit;
      SCOPED_TRACE(each.layout);
      const auto read = [&](std::uint16_t address, std::size_t count) {
        return client->read(unit, each.function, address, static_cast<int>(count));
      };
      EXPECT_EQ(read(each.energy_at, each.energy.size()), each.energy);
      EXPECT_EQ(read(each.power_at, each.power.size()), each.power);
    }
  }
}

TEST(MetersCommand, EachFaultIsOnTheWire) {
  // Waits of hours never end: what came before them is all that comes.
  const std::vector<std::pair<std::string, Bytes>> expected{
      {"register 1234", kHonest},
      {"late 50ms", kHonest},
      {"split 5ms", kHonest},
      {"split 1h", Bytes(kHonest.begin(), kHonest.begin() + 7)},
      {"wrong_unit 9", {0, 9, 0, 0, 0, 11, 9, 3, 8, 0, 0, 0, 0, 0, 1, 0xE2, 0x08}},
      {"wrong_length 300", {0, 9, 0, 0, 1, 44, 1, 3, 8, 0, 0, 0, 0, 0, 1, 0xE2, 0x08}},
      {"wrong_count 2", {0, 9, 0, 0, 0, 11, 1, 3, 2, 0, 0, 0, 0, 0, 1, 0xE2, 0x08}},
      {"exception 11", {0, 9, 0, 0, 0, 3, 1, 0x83, 11}},
      {"flip 0", {1, 9, 0, 0, 0, 11, 1, 3, 8, 0, 0, 0, 0, 0, 1, 0xE2, 0x08}},
      {"silent", {}},
      {"late 1h", {}},
  };
  std::string plan;
  std::map<std::string, std::string> scripts;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const std::string name = std::to_string(i) + ".faults";
    plan += "[[endpoint]]\nfaults = \"" + name + "\"\n" + kAbb;
    scripts[name] =
        recald::testing::kHoldCounters + std::string{"0s..10000h all "} + expected[i].first + "\n";
  }
  SimulatedMeters meters{RECALD_SIM_PROGRAM, plan, scripts};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto& [fault, bytes] = expected[i];
    SCOPED_TRACE(fault);
    Socket socket{meters.port(i)};
    ASSERT_TRUE(socket.is_open());
    socket.put(kReadEnergy);
    EXPECT_EQ(socket.get(bytes.size()), bytes);
    EXPECT_FALSE(socket.has_bytes(200));
  }
}

TEST(MetersCommand, AnEndpointGoesAwayAndComesBack) {
  std::string script = recald::testing::kHoldCounters;
  for (int second = 1; second < 200; second += 2) {
    script += std::to_string(second) + "s.." + std::to_string(second + 1) + "s all refuse\n";
  }
  SimulatedMeters meters{RECALD_SIM_PROGRAM,
                         std::string{"[[endpoint]]\n"} + kAbb,
                         {{"reboot.faults", script}},
                         {"--faults", "reboot.faults"}};
  for (int reboots = 0; reboots < 2; ++reboots) {
    std::unique_ptr<Socket> socket;
    ASSERT_TRUE(eventually([&] {
      socket = std::make_unique<Socket>(meters.port(0));
      return socket->is_open();
    }));
    ASSERT_TRUE(eventually([&] { return socket->has_bytes() && socket->get(1).empty(); }));
    ASSERT_TRUE(eventually([&] { return !Socket{meters.port(0)}.is_open(); }));
  }
}

TEST(MetersCommand, TwoClientsShareAnEndpointUnlessItTakesOnlyOne) {
  SimulatedMeters meters{
      RECALD_SIM_PROGRAM,
      std::string{"[[endpoint]]\n"} + kAbb + "[[endpoint]]\nsingle_connection = true\n" + kAbb,
      {{"hold.faults", recald::testing::kHoldCounters}},
      {"--faults", "hold.faults"}};
  const Socket one{meters.port(0)};
  const Socket other{meters.port(0)};
  one.put(kReadEnergy);
  other.put(kReadEnergy);
  EXPECT_EQ(other.get(kHonest.size()), kHonest);
  EXPECT_EQ(one.get(kHonest.size()), kHonest);
  {
    const Socket first{meters.port(1)};
    first.put(kReadEnergy);
    EXPECT_EQ(first.get(kHonest.size()), kHonest);
    EXPECT_FALSE(Socket{meters.port(1)}.is_open());
    first.put(kReadEnergy);
    EXPECT_EQ(first.get(kHonest.size()), kHonest);
  }
  EXPECT_TRUE(eventually([&] { return Socket{meters.port(1)}.is_open(); }));
}

TEST(MetersCommand, WhatIsNoModbusClosesTheConnection) {
  SimulatedMeters meters{RECALD_SIM_PROGRAM, std::string{"[[endpoint]]\n"} + kAbb};
  const Socket socket{meters.port(0)};
  socket.put({'G', 'E', 'T', ' ', '/', '\r', '\n', '\r', '\n'});
  ASSERT_TRUE(eventually([&] { return socket.has_bytes(); }));
  EXPECT_TRUE(socket.get(1).empty());
}

TEST(MetersCommand, TimeRunsAsTheClockSays) {
  using namespace std::chrono;
  // 60 kW, an hour in each second: whatever the machine does, what is read lies between what the
  // clock says before and after.
  const auto anchor = floor<seconds>(system_clock::now());
  SimulatedMeters meters{
      RECALD_SIM_PROGRAM,
      std::string{"[[endpoint]]\n"} + kAbb + "start_kWh = 100\n",
      {},
      {"--clock",
       "2026-01-30T00:00:00Z@" + std::to_string(anchor.time_since_epoch().count()) + "x3600"}};
  Client client{meters.port(0)};
  ASSERT_TRUE(client.connect());
  const auto expected_kWh = [&] {
    const duration<double> elapsed = system_clock::now() - anchor;
    return 100.0 + 60.0 * elapsed.count();
  };
  for (int reads = 0; reads < 20; ++reads) {
    const double before_kWh = expected_kWh();
    const auto words = client.read(1, 3, 0x5000, 4);
    const double after_kWh = expected_kWh();
    ASSERT_EQ(words.size(), 4U);
    const double energy_kWh = (65'536.0 * words[2] + words[3]) / 100.0;
    EXPECT_GE(energy_kWh, before_kWh - 0.1);  // a millisecond is 0.06 kWh, a step 0.01 kWh
    EXPECT_LE(energy_kWh, after_kWh);
  }
}

TEST(MetersCommand, WritesAreRefusedAndCountedAtTheEnd) {
  SimulatedMeters meters{RECALD_SIM_PROGRAM, std::string{"[[endpoint]]\n"} + kAbb};
  Client client{meters.port(0)};
  ASSERT_TRUE(client.connect());
  EXPECT_EQ(client.write(1, 0x5000), -1);
  EXPECT_EQ(errno, EMBXILFUN);
  EXPECT_EQ(client.read(1, 3, 0x5000, 4).size(), 4U);
  EXPECT_EQ(meters.end(), 0);
  EXPECT_THAT(meters.what_was_said(), HasSubstr("ready: 1 endpoints, 1 devices\n"));
  EXPECT_THAT(meters.what_was_said(), HasSubstr("2 requests, 1 writes seen\n"));
}

TEST(MetersCommand, TheLinkGoesWithTheProcess) {
  SimulatedMeters meters{RECALD_SIM_PROGRAM,
                         std::string{"[[endpoint]]\ntype = \"rtu\"\nlink = \"line\"\n"} + kAbb};
  EXPECT_TRUE(std::filesystem::exists(meters.address(0)));
  EXPECT_EQ(meters.end(), 0);
  EXPECT_FALSE(std::filesystem::is_symlink(meters.address(0)));
}

TEST(MetersCommand, WhatCannotBeOpenedIsSaid) {
  SimulatedMeters meters{RECALD_SIM_PROGRAM, std::string{"[[endpoint]]\n"} + kAbb};
  const recald::testing::TemporaryFolder folder;
  const auto said_by = [&](const std::string& plan, const std::vector<std::string>& options,
                           int code) {
    recald::testing::write_text(folder / "plan.toml", plan);
    recald::testing::write_text(folder / "said.txt", "");
    std::vector<std::string> command{RECALD_SIM_PROGRAM, "meters", (folder / "plan.toml").string()};
    command.insert(command.end(), options.begin(), options.end());
    recald::testing::BackgroundProcess process{command, folder / "said.txt"};
    EXPECT_EQ(process.wait(), code);
    return recald::testing::read_text(folder / "said.txt");
  };
  const std::string port = std::to_string(meters.port(0));
  EXPECT_THAT(said_by("[[endpoint]]\nport = " + port + "\n" + kAbb, {}, 1),
              HasSubstr("cannot listen on 127.0.0.1:" + port));
  recald::testing::write_text(folder / "file", "precious");
  EXPECT_THAT(said_by(std::string{"[[endpoint]]\ntype = \"rtu\"\nlink = \"file\"\n"} + kAbb, {}, 1),
              HasSubstr("cannot make the link"));
  EXPECT_EQ(recald::testing::read_text(folder / "file"), "precious");
  EXPECT_THAT(said_by(std::string{"[[endpoint]]\n"} + kAbb, {"--clock", "noon"}, 2),
              HasSubstr("the clock 'noon' is not valid"));
  EXPECT_THAT(said_by(std::string{"[[endpoint]]\n"} + kAbb, {"--faults", "none"}, 1),
              HasSubstr("cannot read the fault script"));
}

}  // namespace
}  // namespace recald::meters_command_test
