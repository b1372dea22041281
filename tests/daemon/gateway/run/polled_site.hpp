/// A folder with a site of one Modbus meter, and the device that it polls every second.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "tests/support/scripted_device.hpp"
#include "tests/support/temporary_folder.hpp"

namespace recald::testing {

/// A counter in Wh that rises by one with every read, as a u32 at address 0.
inline std::vector<Piece> counting(const Bytes& request, int number) {
  const auto wh = static_cast<std::uint32_t>(1'000'000 + number);
  const auto byte = [&](int shift) { return static_cast<std::uint8_t>(wh >> shift & 0xFF); };
  return {{std::chrono::milliseconds{0},
           {request[0], request[1], 0, 0, 0, 7, request[6], 0x03, 4, byte(24), byte(16), byte(8),
            byte(0)}}};
}

class PolledSite : public ::testing::Test {
 protected:
  PolledSite() : server_{counting} {
    recald::testing::write_text(folder_ / "counter.toml", R"(
source = "the test"
base = 0
energy = ["energy"]
register.energy = { at = 0, type = "u32", unit = "Wh" }
)");
    recald::testing::write_text(folder_ / "site.toml", R"([site]
id = "tower"
timezone = "America/Chicago"
interval = "1m"

[bus.plant]
type = "tcp"
host = "127.0.0.1"
port = )" + std::to_string(server_.port()) + R"(

[[meter]]
id = "main"
source = "modbus"
utility = "electricity"
bus = "plant"
unit = 1
map = "counter.toml"
rated_kW = 400
poll = "1s"
)");
  }

  TemporaryFolder folder_;
  ScriptedServer server_;
};

}  // namespace recald::testing
