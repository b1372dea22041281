/// The map of the registers: one table, which values and documentation both come from.
///
/// A block for the site, then one of a fixed size for each meter, in the order of the site file.
/// What is unused reads 0. A change that moves a register or gives it another meaning needs a new
/// `kMapVersion`; new ones in unused places do not.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/gateway/registers/register_facts.hpp"

namespace recald::daemon {

inline constexpr int kMapVersion = 1;
inline constexpr int kFirstMeterAt = 100;  ///< Base 0, as all addresses here.
inline constexpr int kMeterBlock = 64;
inline constexpr int kMetersMax = (65'536 - kFirstMeterAt) / kMeterBlock;

/// Values of two registers begin with the high one, so floats are ABCD.
enum class RegisterType : std::uint8_t { u16, u32, f32 };
[[nodiscard]] std::string_view name_of(RegisterType type);
[[nodiscard]] int registers_of(RegisterType type);

/// A number that stands for words.
struct RegisterWord {
  int number;
  std::string_view words;
};

/// NaN is "no value" of a float; codes and counts always have one.
template <class Facts>
struct RegisterEntry {
  int at;  ///< Within its block.
  RegisterType type;
  std::string_view name;
  std::string_view unit;  ///< Empty: a count or a code.
  std::string_view meaning;
  double (*value)(const Facts&);
  std::span<const RegisterWord> words = {};  ///< Of a code; empty: none, or those of the alarms.
};

[[nodiscard]] std::span<const RegisterEntry<SiteFacts>> site_registers();
[[nodiscard]] std::span<const RegisterEntry<MeterFacts>> meter_registers();

/// Address of a meter's block. @param meter  Its place in the site file, from 0 on.
[[nodiscard]] constexpr int meter_at(std::size_t meter) {
  return kFirstMeterAt + kMeterBlock * static_cast<int>(meter);
}

/// All registers from 0 to the end of the last meter's block; of more than `kMetersMax` meters the
/// first ones.
[[nodiscard]] std::vector<std::uint16_t> register_values(const SiteFacts& site);

}  // namespace recald::daemon
