// Whatever stands in the registers, a decoded value is finite or absent, and so is each field of a
// planned read; reads keep to the device's limits and bring each field once.
#include <bit>
#include <cmath>
#include <vector>

#include "adapters/modbus/register_map.hpp"
#include "tests/fuzz/require.hpp"

namespace recald::fuzz {
namespace {

using modbus::DecodedValue;
using modbus::PlannedRead;
using modbus::RegisterField;
using modbus::RegisterType;
using modbus::ValueFormat;

/// A factor as a map may have it: finite and not zero.
double read_scale(Input& input) {
  const double scale = std::bit_cast<double>(input.bits64());
  return std::isfinite(scale) && scale != 0.0 ? scale : 0.01;
}

ValueFormat read_format(Input& input) {
  ValueFormat format;
  format.type = static_cast<RegisterType>(input.below(10));
  format.order = static_cast<modbus::WordOrder>(input.below(4));
  const int has = input.below(16);
  if ((has & 1) != 0) format.scale = read_scale(input);
  if ((has & 2) != 0) format.offset = read_scale(input);
  if ((has & 4) != 0) format.absent = input.bits64();
  if ((has & 8) != 0) format.mask = input.bits64();
  return format;
}

void require_finite(const DecodedValue& decoded) {
  require(std::isfinite(decoded.value), "a value is finite");
  require(std::isfinite(decoded.resolution) && decoded.resolution >= 0.0,
          "a resolution is finite and not negative");
}

std::vector<RegisterField> read_fields(Input& input) {
  std::vector<RegisterField> fields;
  const int count = 1 + input.below(8);
  for (int i = 0; i < count; ++i) {
    RegisterField field;
    field.name = std::string(1, static_cast<char>('a' + i));
    field.format = read_format(input);
    field.address = static_cast<std::uint16_t>(input.word() % (65'536 - 4));
    if (input.below(3) == 0) {
      field.scale_factor = std::string(1, static_cast<char>('a' + input.below(count)));
    }
    fields.push_back(field);
  }
  return fields;
}

void require_plan(const std::vector<RegisterField>& fields, const modbus::ReadLimits& limits,
                  const std::vector<PlannedRead>& reads) {
  std::vector<int> brought(fields.size());
  for (const PlannedRead& read : reads) {
    require(read.count >= 1 && read.count <= limits.registers_max, "a read within the limits");
    require(read.address + read.count <= 65'536, "a read on the map");
    for (const std::size_t i : read.fields) ++brought[i];
  }
  for (const int times : brought) require(times == 1, "each field comes once");
}

}  // namespace
}  // namespace recald::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald::fuzz;
  Input input{data, size};
  const auto fields = read_fields(input);
  const recald::modbus::ReadLimits limits{.registers_max = 4 + input.below(122),
                                          .gap_max = input.below(126),
                                          .one_request_per_field = input.below(2) == 1};
  const auto reads = plan_reads(fields, recald::modbus::Function::read_holding_registers, limits);
  if (!reads) {
    require_sentence(reads.error().message);
    return 0;
  }
  require_plan(fields, limits, *reads);
  for (const PlannedRead& read : *reads) {
    recald::modbus::Words words(read.count);
    for (std::uint16_t& word : words) word = input.word();
    for (const auto& field : decode_read(fields, read, words)) {
      if (field.value) require_finite(*field.value);
    }
  }
  return 0;
}
