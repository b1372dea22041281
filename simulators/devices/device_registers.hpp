/// The contents of a device's registers: the manufacturers' layouts, written down a second time.
///
/// The daemon's maps and decoders are not used here, so that a wrong address or a swapped word is
/// not repeated on both sides.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace recald::simulators {

/// What a meter has counted and measures at one moment.
struct MeterReadout {
  double energy_kWh;
  double power_kW;
  std::uint32_t serial;
};

enum class Encoding : std::uint8_t { i16, i32, u32, i64, u64, f32, f64 };

/// One value of a layout.
struct LayoutValue {
  enum class What : std::uint8_t { energy, power, serial, nothing };
  What what;
  std::uint16_t address;  ///< On the wire.
  Encoding encoding;
  double per_unit;  ///< Raw steps per kWh or kW; rounded down for an integer.
  bool low_word_first = false;
};

/// A kind of device that can be simulated.
struct DeviceLayout {
  std::string_view name;
  std::uint8_t function;  ///< 3 or 4: the function it answers.
  std::vector<LayoutValue> values;
};

/// "abb-b23", "schneider-iem3000", "siemens-pac3200", "carlo-gavazzi-em24-din", "eastron-sdm630",
/// "belimo-energy-valve"; nothing for another name.
[[nodiscard]] const DeviceLayout* find_layout(std::string_view name);
[[nodiscard]] std::span<const DeviceLayout> layouts();

/// The contents of `count` registers from `address` on; registers between values are 0.
/// @return nothing if some of them are outside the device's layout, which is exception 2.
[[nodiscard]] std::optional<std::vector<std::uint16_t>> registers_of(const DeviceLayout& layout,
                                                                     const MeterReadout& readout,
                                                                     int address, int count);

}  // namespace recald::simulators
