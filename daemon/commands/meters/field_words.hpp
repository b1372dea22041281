/// The fields of a register map that some registers hold, with why one has no value, in words.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "adapters/modbus/register_map.hpp"

namespace recald::daemon {

struct FieldWords {
  const modbus::RegisterField* field;  ///< Of the list that was searched.
  modbus::Words words;                 ///< As read; fewer than the field has, if it is cut.
  tl::expected<modbus::DecodedValue, std::string> value;  ///< Or why there is none.
};

/// Every field of which at least one register is there, in order of address.
/// @param fields   Outlives the result.
/// @param address  Of the first word.
[[nodiscard]] std::vector<FieldWords> words_of_fields(
    const std::vector<modbus::RegisterField>& fields, int address,
    std::span<const std::uint16_t> words);

/// "1000.5 kWh", or why there is no value.
[[nodiscard]] std::string describe(const FieldWords& found);

/// "no value: the device sends the bits that mean 'absent'"
[[nodiscard]] std::string_view describe(modbus::ValueFault fault);

}  // namespace recald::daemon
