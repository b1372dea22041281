/// The registers of one kind of meter, and how well they are confirmed.
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
  std::uint16_t address = 0;  ///< On the wire; the map's base is already subtracted.
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
  int gap_max = 16;  ///< The most unused registers that a read may span between two fields.
  bool one_request_per_field = false;  ///< For devices that refuse any other read.

  bool operator==(const ReadLimits&) const = default;
};

struct RegisterMap {
  std::string name;    ///< "abb-b23"
  std::string title;   ///< "ABB B23 and B24"
  std::string source;  ///< Documents and projects that the map is based on.
  Trust trust = Trust::local;
  Function function = Function::read_holding_registers;
  ReadLimits limits;
  /// SunSpec models, one of which the device must have. The chain is walked first and addresses
  /// count from the model's id register. Empty: addresses are those on the wire.
  std::vector<std::uint16_t> sunspec_models;
  std::vector<RegisterField> fields;
  std::vector<std::string> energy;    ///< Counters whose sum is the meter's energy.
  std::optional<std::string> power;   ///< Field with the momentary or mean power.
  std::vector<std::string> weather;   ///< What a weather sensor measures: "dry_bulb_C".
  std::vector<std::string> identity;  ///< If their contents change, it is another device.

  [[nodiscard]] const RegisterField* find(std::string_view field_name) const;

  bool operator==(const RegisterMap&) const = default;
};

/// The fields that make up the meter: energy, power, weather, identity and their scale factors.
[[nodiscard]] std::vector<RegisterField> metered_fields(const RegisterMap& map);

/// One read, and the fields it covers.
struct PlannedRead {
  Function function;
  std::uint16_t address;
  std::uint16_t count;
  std::vector<std::size_t> fields;  ///< Indices into the list that was planned.
  /// The read of the plan in whose place it is made, once a device has refused that one; nothing of
  /// an ordinary read.
  std::optional<std::size_t> instead_of = {};
  bool may_split = false;  ///< Others can be made instead.
};

/// Plans as few reads as the limits allow, in order of address. A field is never split. Fields with
/// a common scale factor share a read with it, because the factor may change between two reads.
///
/// @param fields  The fields to read, of one map; `PlannedRead::fields` refers to their order.
/// @return the reads, or unsupported if fields that belong together exceed `registers_max`.
[[nodiscard]] Result<std::vector<PlannedRead>> plan_reads(const std::vector<RegisterField>& fields,
                                                          Function function,
                                                          const ReadLimits& limits);

/// Appends to a plan what is read in the place of a read of several fields that a device refuses
/// because it lacks registers between them: one read a field, or a group of fields with one scale
/// factor. Reads of the plan keep their places.
/// @param reads  Planned over `fields`.
void add_single_reads(std::vector<PlannedRead>& reads, const std::vector<RegisterField>& fields);

struct FieldValue {
  std::size_t field;  ///< Index, as in `PlannedRead::fields`.
  tl::expected<DecodedValue, ValueFault> value;
  double power_of_ten = 1.0;  ///< The scale factor applied in this read.
};

/// Decodes all fields of a read, scale factors applied. A value whose factor is absent is absent.
/// @pre words.size() == read.count, and the read was planned over `fields`.
[[nodiscard]] std::vector<FieldValue> decode_read(const std::vector<RegisterField>& fields,
                                                  const PlannedRead& read,
                                                  std::span<const std::uint16_t> words);

}  // namespace recald::modbus
