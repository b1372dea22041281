#include "adapters/modbus/register_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace recald::modbus {
namespace {

/// Fields that must come in one read, and the registers they span.
struct Group {
  std::vector<std::size_t> fields;
  int begin;
  int end;
};

void take_in(Group& group, const Group& other) {
  group.fields.insert(group.fields.end(), other.fields.begin(), other.fields.end());
  group.begin = std::min(group.begin, other.begin);
  group.end = std::max(group.end, other.end);
}

/// The key of a field is its scale factor's name, so both land in one group.
std::vector<Group> group_by_scale_factor(const std::vector<RegisterField>& fields) {
  std::vector<Group> groups;
  std::vector<std::string> keys;  // of each group
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const RegisterField& field = fields[i];
    const std::string& key = field.scale_factor ? *field.scale_factor : field.name;
    const Group alone{{i}, field.address, field.end()};
    const auto known = std::ranges::find(keys, key);
    if (known == keys.end()) {
      groups.push_back(alone);
      keys.push_back(key);
    } else {
      take_in(groups[static_cast<std::size_t>(known - keys.begin())], alone);
    }
  }
  return groups;
}

/// The words of one field in a read that covers it.
std::span<const std::uint16_t> field_words(const RegisterField& field, const PlannedRead& read,
                                           std::span<const std::uint16_t> words) {
  assert(field.address >= read.address && field.end() <= read.address + read.count);
  assert(words.size() == read.count);
  return words.subspan(static_cast<std::size_t>(field.address - read.address),
                       static_cast<std::size_t>(field.words()));
}

PlannedRead read_of(Group group, Function function, const std::vector<RegisterField>& fields) {
  std::ranges::sort(group.fields, {}, [&](std::size_t i) { return fields[i].address; });
  return {function, static_cast<std::uint16_t>(group.begin),
          static_cast<std::uint16_t>(group.end - group.begin), std::move(group.fields)};
}

}  // namespace

const RegisterField* RegisterMap::find(std::string_view field_name) const {
  const auto found = std::ranges::find(fields, field_name, &RegisterField::name);
  return found == fields.end() ? nullptr : &*found;
}

std::vector<RegisterField> metered_fields(const RegisterMap& map) {
  std::vector<RegisterField> fields;
  const auto add = [&](const std::string& name) {
    const RegisterField* field = map.find(name);
    assert(field != nullptr && "a checked map has the fields it names");
    const auto known = std::ranges::find(fields, name, &RegisterField::name);
    if (known == fields.end()) fields.push_back(*field);
    return field->scale_factor;
  };
  std::vector<std::string> names = map.energy;
  if (map.power) names.push_back(*map.power);
  names.insert(names.end(), map.weather.begin(), map.weather.end());
  names.insert(names.end(), map.identity.begin(), map.identity.end());
  for (const std::string& name : names) {
    if (const auto factor = add(name)) (void)add(*factor);
  }
  return fields;
}

Result<std::vector<PlannedRead>> plan_reads(const std::vector<RegisterField>& fields,
                                            Function function, const ReadLimits& limits) {
  assert(limits.registers_max >= 1 && limits.registers_max <= kRegistersMax);
  std::vector<Group> groups = group_by_scale_factor(fields);
  std::ranges::stable_sort(groups, {}, &Group::begin);

  std::vector<PlannedRead> reads;
  std::optional<Group> open;
  for (const Group& group : groups) {
    if (group.end - group.begin > limits.registers_max) {
      return failure(
          ErrorCode::unsupported,
          fmt::format("fields '{}' to '{}' must be read together and span {} registers; "
                      "the device gives {} a read",
                      fields[group.fields.front()].name, fields[group.fields.back()].name,
                      group.end - group.begin, limits.registers_max));
    }
    const bool joins = open && !limits.one_request_per_field &&
                       group.begin - open->end <= limits.gap_max &&
                       std::max(group.end, open->end) - open->begin <= limits.registers_max;
    if (joins) {
      take_in(*open, group);
      continue;
    }
    if (open) reads.push_back(read_of(std::move(*open), function, fields));
    open = group;
  }
  if (open) reads.push_back(read_of(std::move(*open), function, fields));
  return reads;
}

void add_single_reads(std::vector<PlannedRead>& reads, const std::vector<RegisterField>& fields) {
  const std::size_t planned = reads.size();
  for (std::size_t i = 0; i < planned; ++i) {
    std::vector<RegisterField> some;
    for (const std::size_t field : reads[i].fields) some.push_back(fields[field]);
    const auto single = plan_reads(some, reads[i].function, {.one_request_per_field = true});
    if (!single || single->size() < 2) continue;
    reads[i].may_split = true;
    for (PlannedRead read : *single) {
      for (std::size_t& field : read.fields) field = reads[i].fields[field];
      read.instead_of = i;
      reads.push_back(std::move(read));
    }
  }
}

std::vector<FieldValue> decode_read(const std::vector<RegisterField>& fields,
                                    const PlannedRead& read, std::span<const std::uint16_t> words) {
  std::vector<FieldValue> values;
  for (const std::size_t i : read.fields) {
    values.push_back(
        {.field = i, .value = decode(field_words(fields[i], read, words), fields[i].format)});
  }
  for (FieldValue& scaled : values) {
    const std::optional<std::string>& name = fields[scaled.field].scale_factor;
    if (!name || !scaled.value) continue;
    const auto factor = std::ranges::find_if(
        values, [&](const FieldValue& other) { return fields[other.field].name == *name; });
    if (factor == values.end() || !factor->value) {
      scaled.value = tl::unexpected(ValueFault::absent);
      continue;
    }
    const double power_of_ten = std::pow(10.0, factor->value->value);
    scaled.value->value *= power_of_ten;
    scaled.value->resolution *= power_of_ten;
    if (!std::isfinite(scaled.value->value) || !std::isfinite(scaled.value->resolution)) {
      scaled.value = tl::unexpected(ValueFault::not_finite);
    }
    scaled.power_of_ten = power_of_ten;
  }
  return values;
}

}  // namespace recald::modbus
