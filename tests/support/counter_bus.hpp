/// A bus of meters with cumulative registers, on a virtual loop: what they counted is known
/// exactly.
#pragma once

#include <cmath>
#include <functional>
#include <map>

#include "adapters/ports/bus.hpp"
#include "adapters/ports/loop.hpp"

namespace recald::testing {

/// What happens to a device, by the loop's monotonic time.
struct CounterDevice {
  /// Register contents in 0.1 kWh, as a u32 at address 0 and a load in W as an i32 at address 2.
  std::function<double(std::chrono::milliseconds)> energy_kWh;
  std::function<bool(std::chrono::milliseconds)> is_silent = [](std::chrono::milliseconds) {
    return false;
  };
  /// What stands in its registers from address 0 on, in the place of a counter. Absent: a counter.
  std::function<modbus::Words(std::chrono::milliseconds)> registers = {};
  /// With which Modbus exception it answers; 0: none.
  std::function<int(std::chrono::milliseconds)> exception = [](std::chrono::milliseconds) {
    return 0;
  };
};

class CounterBus final : public Bus {
 public:
  CounterBus(Loop& loop, std::map<std::uint8_t, CounterDevice> devices)
      : loop_(loop), devices_(std::move(devices)) {}

  void read(const modbus::ReadRequest& request, std::chrono::milliseconds timeout,
            Done done) override {
    const auto now = loop_.now().monotonic;
    const auto device = devices_.find(request.unit);
    if (device == devices_.end() || device->second.is_silent(now)) {
      loop_.after(timeout, [=] {
        done(tl::unexpected(modbus::ReadFailure{modbus::ReadFault::timeout}), timeout);
      });
      return;
    }
    if (const int code = device->second.exception(now)) {
      const modbus::ReadFailure refusal{modbus::ReadFault::exception,
                                        static_cast<std::uint8_t>(code)};
      loop_.after(kLatency, [=] { done(tl::unexpected(refusal), kLatency); });
      return;
    }
    if (device->second.registers) {
      const modbus::Words all = device->second.registers(now);
      modbus::Words words(all.begin() + request.address,
                          all.begin() + request.address + request.count);
      loop_.after(kLatency, [done = std::move(done), words] { done(words, kLatency); });
      return;
    }
    const auto raw = static_cast<std::uint32_t>(std::floor(10.0 * device->second.energy_kWh(now)));
    const std::uint16_t registers[] = {static_cast<std::uint16_t>(raw >> 16),
                                       static_cast<std::uint16_t>(raw & 0xFFFF), 0, 0};
    modbus::Words words(registers + request.address, registers + request.address + request.count);
    loop_.after(kLatency, [done = std::move(done), words] { done(words, kLatency); });
  }

  static constexpr std::chrono::milliseconds kLatency{20};
  /// The map that fits the devices.
  static constexpr const char* kMap = R"(
source = "the test"
base = 0
energy = ["energy"]
power = "power"
register.energy = { at = 0, type = "u32", scale = 0.1, unit = "kWh" }
register.power = { at = 2, type = "i32", unit = "W" }
)";

 private:
  Loop& loop_;
  std::map<std::uint8_t, CounterDevice> devices_;
};

}  // namespace recald::testing
