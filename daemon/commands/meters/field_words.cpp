#include "daemon/commands/meters/field_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace recald::daemon {
namespace {

using modbus::RegisterField;

/// Why a whole field has no value: its own bits, or its power of ten.
std::string why_none(const RegisterField& field, modbus::ValueFault fault,
                     const std::vector<FieldWords>& others) {
  if (field.scale_factor) {
    const auto factor = std::ranges::find_if(
        others, [&](const FieldWords& other) { return other.field->name == *field.scale_factor; });
    if (factor == others.end()) {
      return fmt::format("its power of ten, '{}', is not in these registers", *field.scale_factor);
    }
    if (!factor->value) {
      return fmt::format("its power of ten, '{}', has no value", *field.scale_factor);
    }
  }
  return std::string{describe(fault)};
}

}  // namespace

std::string_view describe(modbus::ValueFault fault) {
  switch (fault) {
    case modbus::ValueFault::absent:
      return "absent: the device reports no value";
    case modbus::ValueFault::not_finite:
      return "not a number (NaN or infinity)";
    case modbus::ValueFault::not_bcd:
      return "not decimal digits (a half byte above 9)";
  }
  assert(false && "every fault has words");
  return "";
}

std::vector<FieldWords> words_of_fields(const std::vector<RegisterField>& fields, int address,
                                        std::span<const std::uint16_t> words) {
  const int end = address + static_cast<int>(words.size());
  modbus::PlannedRead whole{modbus::Function::read_holding_registers,
                            static_cast<std::uint16_t>(address),
                            static_cast<std::uint16_t>(words.size()),
                            {}};
  std::vector<FieldWords> found;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const RegisterField& field = fields[i];
    const int first = std::max<int>(address, field.address);
    const int last = std::min(end, field.end());
    if (first >= last) continue;
    const auto there = words.subspan(static_cast<std::size_t>(first - address),
                                     static_cast<std::size_t>(last - first));
    found.push_back({&field, {there.begin(), there.end()}, {}});
    if (last - first == field.words()) {
      whole.fields.push_back(i);
    } else {
      found.back().value = tl::unexpected(
          fmt::format("only {} of its {} registers are here", last - first, field.words()));
    }
  }
  const auto values = decode_read(fields, whole, words);
  const auto entry_of = [&](std::size_t field) {
    return std::ranges::find(found, &fields[field], &FieldWords::field);
  };
  // Powers of ten first: what they scale refers to them.
  for (const bool scaled : {false, true}) {
    for (const modbus::FieldValue& value : values) {
      if (fields[value.field].scale_factor.has_value() != scaled) continue;
      const auto entry = entry_of(value.field);
      if (value.value) {
        entry->value = *value.value;
      } else {
        entry->value = tl::unexpected(why_none(fields[value.field], value.value.error(), found));
      }
    }
  }
  std::ranges::stable_sort(found, {}, [](const FieldWords& one) { return one.field->address; });
  return found;
}

std::string describe(const FieldWords& found) {
  if (!found.value) return found.value.error();
  const double value = found.value->value;
  const std::string_view unit = found.field->unit;
  return fmt::format("{:.12g}{}{}", value, unit.empty() ? "" : " ", unit);
}

}  // namespace recald::daemon
