#include "simulators/devices/device_registers.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace recald::simulators {
namespace {

using What = LayoutValue::What;

int words_of(Encoding encoding) {
  switch (encoding) {
    case Encoding::i16:
      return 1;
    case Encoding::i32:
    case Encoding::u32:
    case Encoding::f32:
      return 2;
    case Encoding::i64:
    case Encoding::u64:
    case Encoding::f64:
      return 4;
  }
  return 1;
}

double value_of(What what, const MeterReadout& readout) {
  switch (what) {
    case What::energy:
      return readout.energy_kWh;
    case What::power:
      return readout.power_kW;
    case What::serial:
      return readout.serial;
    case What::nothing:
      return 0.0;
  }
  return 0.0;
}

/// The value as stored in the device, highest word first.
std::vector<std::uint16_t> words(Encoding encoding, double raw) {
  std::uint64_t bits = 0;
  switch (encoding) {
    case Encoding::f32:
      bits = std::bit_cast<std::uint32_t>(static_cast<float>(raw));
      break;
    case Encoding::f64:
      bits = std::bit_cast<std::uint64_t>(raw);
      break;
    case Encoding::i16:
    case Encoding::i32:
    case Encoding::u32:
    case Encoding::i64:
    case Encoding::u64:
      bits = static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(raw)));
      break;
  }
  std::vector<std::uint16_t> all;
  for (int word = words_of(encoding) - 1; word >= 0; --word) {
    all.push_back(static_cast<std::uint16_t>(bits >> 16 * word & 0xFFFF));
  }
  return all;
}

const std::vector<DeviceLayout>& all_layouts() {
  static const std::vector<DeviceLayout> all{
      {"abb-b23",
       3,
       {{What::energy, 0x5000, Encoding::u64, 100.0},
        {What::nothing, 0x5004, Encoding::u64, 1.0},
        {What::power, 0x5B14, Encoding::i32, 100'000.0}}},
      {"schneider-iem3000",
       3,
       {{What::power, 3059, Encoding::f32, 1.0},
        {What::energy, 3203, Encoding::i64, 1000.0},
        {What::nothing, 3207, Encoding::i64, 1.0}}},
      {"siemens-pac3200",
       3,
       {{What::power, 65, Encoding::f32, 1000.0},
        {What::energy, 801, Encoding::f64, 1000.0},
        {What::nothing, 805, Encoding::f64, 1.0}}},
      {"carlo-gavazzi-em24-din",
       3,
       {{What::power, 0x28, Encoding::i32, 10'000.0, true},
        {What::energy, 0x3E, Encoding::i32, 10.0, true}}},
      {"eastron-sdm630",
       4,
       {{What::power, 0x34, Encoding::f32, 1000.0}, {What::energy, 0x48, Encoding::f32, 1.0}}},
      {"belimo-energy-valve",
       3,
       {{What::power, 27, Encoding::u32, 1000.0, true},
        {What::nothing, 33, Encoding::u32, 1.0, true},
        {What::energy, 65, Encoding::u32, 1.0, true},
        {What::nothing, 71, Encoding::u32, 1.0, true}}},
  };
  return all;
}

}  // namespace

std::span<const DeviceLayout> layouts() { return all_layouts(); }

const DeviceLayout* find_layout(std::string_view name) {
  const auto found = std::ranges::find(all_layouts(), name, &DeviceLayout::name);
  return found == all_layouts().end() ? nullptr : &*found;
}

std::optional<std::vector<std::uint16_t>> registers_of(const DeviceLayout& layout,
                                                       const MeterReadout& readout, int address,
                                                       int count) {
  int first = 0x10000;
  int end = 0;
  for (const LayoutValue& value : layout.values) {
    first = std::min<int>(first, value.address);
    end = std::max(end, value.address + words_of(value.encoding));
  }
  if (address < first || address + count > end) return {};
  std::vector<std::uint16_t> registers(static_cast<std::size_t>(count), 0);
  for (const LayoutValue& value : layout.values) {
    std::vector<std::uint16_t> held =
        words(value.encoding, value_of(value.what, readout) * value.per_unit);
    if (value.low_word_first) std::ranges::reverse(held);
    for (std::size_t i = 0; i < held.size(); ++i) {
      const int at = value.address + static_cast<int>(i) - address;
      if (at >= 0 && at < count) registers[static_cast<std::size_t>(at)] = held[i];
    }
  }
  return registers;
}

}  // namespace recald::simulators
