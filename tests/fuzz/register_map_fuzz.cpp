// A register map that is accepted can be used: what it names is there, its reads can be planned and
// each field decoded. One that is refused is told where and why.
#include <cmath>

#include "daemon/site/config/register_map_file.hpp"
#include "tests/fuzz/require.hpp"

namespace recald::fuzz {
namespace {

using modbus::RegisterField;
using modbus::RegisterMap;

void require_usable(const RegisterMap& map) {
  require(!map.energy.empty() || map.power.has_value(), "something is metered");
  for (const std::string& name : map.energy) require(map.find(name) != nullptr, "energy is there");
  for (const RegisterField& field : map.fields) {
    require(field.end() <= 65'536, "a field ends on the map");
    require(std::isfinite(field.format.scale) && field.format.scale != 0.0, "a scale that scales");
    require(std::isfinite(field.format.offset), "a finite offset");
  }
  const auto fields = metered_fields(map);
  const auto reads = plan_reads(fields, map.function, map.limits);
  require(reads.has_value(), "the reads of an accepted map can be planned");
  for (const modbus::PlannedRead& read : *reads) {
    const modbus::Words words(read.count, 0x0001);
    require(decode_read(fields, read, words).size() == read.fields.size(), "each field is decoded");
  }
}

}  // namespace
}  // namespace recald::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald::fuzz;
  const auto file = recald::daemon::parse_register_map(text_of(data, size), "ours");
  if (file) {
    require_usable(file->map);
    return 0;
  }
  require(!file.error().empty(), "a refusal has a reason");
  for (const std::string& problem : file.error()) {
    require_sentence(problem);
    require(problem.starts_with("ours.toml:"), "a problem says where");
  }
  return 0;
}
