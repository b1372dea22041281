/// What each simulated layout must show at 1 234 kWh and 87.5 kW, as the makers' documents say it:
/// words worked out by hand, apart from any encoder.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace recald::testing {

struct LayoutWords {
  std::string_view layout;
  int function;
  std::uint16_t energy_at;
  std::vector<std::uint16_t> energy;
  std::uint16_t power_at;
  std::vector<std::uint16_t> power;
};

inline const std::vector<LayoutWords>& layout_words() {
  static const std::vector<LayoutWords> all{
      // 123 400 steps of 0.01 kWh; 8 750 000 steps of 0.01 W
      {"abb-b23", 3, 0x5000, {0, 0, 1, 0xE208}, 0x5B14, {0x0085, 0x83B0}},
      // 1 234 000 Wh; 87.5 as float32
      {"schneider-iem3000", 3, 3203, {0, 0, 0x0012, 0xD450}, 3059, {0x42AF, 0}},
      // 1 234 000 as float64; 87 500 as float32
      {"siemens-pac3200", 3, 801, {0x4132, 0xD450, 0, 0}, 65, {0x47AA, 0xE600}},
      // 12 340 steps of 0.1 kWh; 875 000 steps of 0.1 W; low word first
      {"carlo-gavazzi-em24-din", 3, 0x3E, {0x3034, 0}, 0x28, {0x59F8, 0x000D}},
      // 1 234 and 87 500 as float32
      {"eastron-sdm630", 4, 0x48, {0x449A, 0x4000}, 0x34, {0x47AA, 0xE600}},
      // 1 234 kWh; 87 500 W; low word first
      {"belimo-energy-valve", 3, 65, {0x04D2, 0}, 27, {0x55CC, 0x0001}},
  };
  return all;
}

/// A device for each of them, units 1, 2, …, of one endpoint; the script holds their counters.
inline std::string devices_of_all_layouts() {
  std::string text;
  int unit = 0;
  for (const LayoutWords& each : layout_words()) {
    text += "[[endpoint.device]]\nunit = " + std::to_string(++unit) + "\nlayout = \"" +
            std::string{each.layout} + "\"\nload_kW = 87.5\n";
  }
  return text;
}
inline constexpr const char* kHoldCounters = "0s..10000h all register 1234\n";

}  // namespace recald::testing
