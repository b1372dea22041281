/// The registers of one kind of meter: what stands where, and how sure we are of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "adapters/modbus/frame.hpp"
#include "adapters/modbus/register_value.hpp"

namespace recald::modbus {

struct RegisterField {
  std::string name;           ///< "energy_import"
  std::uint16_t address = 0;  ///< On the wire: the map's base is taken off already.
  ValueFormat format;
  std::string unit;                         ///< "kWh", "W"; "" for an identity or a power of ten.
  std::optional<double> modulus;            ///< Where a counter wraps, in `unit` before its factor.
  std::optional<std::string> scale_factor;  ///< The field that holds the power of ten.

  [[nodiscard]] int words() const { return word_count(format.type); }
  /// One past its last register.
  [[nodiscard]] int end() const { return address + words(); }

  bool operator==(const RegisterField&) const = default;
};

/// How many sources agree on the map.
enum class Trust : std::uint8_t { two_sources, one_source, local };

/// What a device can take in one read.
struct ReadLimits {
  int registers_max = kRegistersMax;
  int gap_max = 16;  ///< Unused registers that may be read along between two fields.
  bool one_request_per_field = false;  ///< For devices that refuse any other read.

  bool operator==(const ReadLimits&) const = default;
};

struct RegisterMap {
  std::string name;    ///< "abb-b23"
  std::string title;   ///< "ABB B23 and B24"
  std::string source;  ///< Documents and projects that the facts are from.
  Trust trust = Trust::local;
  Function function = Function::read_holding_registers;
  ReadLimits limits;
  /// Models of the SunSpec chain, one of which must be there; then addresses count from its id
  /// register and the chain is walked first. Empty: addresses are those of the wire.
  std::vector<std::uint16_t> sunspec_models;
  std::vector<RegisterField> fields;
  std::vector<std::string> energy;    ///< Counters whose sum is the meter's energy.
  std::optional<std::string> power;   ///< Field with the momentary or mean power.
  std::vector<std::string> weather;   ///< What a weather sensor measures: "dry_bulb_C".
  std::vector<std::string> identity;  ///< Other contents mean another device.

  [[nodiscard]] const RegisterField* find(std::string_view field_name) const;

  bool operator==(const RegisterMap&) const = default;
};

/// The fields that are the meter: its energy, power, weather and identity, with their scale
/// factors.
[[nodiscard]] std::vector<RegisterField> metered_fields(const RegisterMap& map);

/// One read, and which of the fields it brings.
struct PlannedRead {
  Function function;
  std::uint16_t address;
  std::uint16_t count;
  std::vector<std::size_t> fields;  ///< Indices into the list that was planned.
};

/// As few reads as the limits allow, in order of address. A field is never split, and fields with a
/// common scale factor share its read: the factor may change between two reads.
///
/// @param fields  those to read, of one map; their order is what `PlannedRead::fields` refers to.
/// @return the reads, or unsupported where fields that belong together exceed `registers_max`.
[[nodiscard]] Result<std::vector<PlannedRead>> plan_reads(const std::vector<RegisterField>& fields,
                                                          Function function,
                                                          const ReadLimits& limits);

struct FieldValue {
  std::size_t field;  ///< Index, as in `PlannedRead::fields`.
  tl::expected<DecodedValue, ValueFault> value;
  double power_of_ten = 1.0;  ///< By which its scale factor has scaled it, in this read.
};

/// All fields of a read, with their scale factors applied. A value whose factor is absent is
/// absent.
/// @pre words.size() == read.count, and the read was planned over `fields`.
[[nodiscard]] std::vector<FieldValue> decode_read(const std::vector<RegisterField>& fields,
                                                  const PlannedRead& read,
                                                  std::span<const std::uint16_t> words);

}  // namespace recald::modbus
