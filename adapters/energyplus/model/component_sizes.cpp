#include "adapters/energyplus/model/component_sizes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>

#include "adapters/sqlite/tables/database.hpp"
#include "core/text/ascii.hpp"

namespace recald::energyplus {
namespace {

bool is_autosized(const Json& value) {
  if (!value.is_string()) return false;
  const std::string text = to_lower(value.get<std::string>());
  return text == "autosize" || text == "autocalculate";
}

/// "Design Size Maximum Air Flow Rate" is the field maximum_air_flow_rate. None where the user's
/// own size is meant.
std::optional<std::string> field_of(std::string_view description) {
  constexpr std::string_view kDesign = "Design Size ";
  if (description.starts_with("User-Specified ")) return {};
  if (description.starts_with(kDesign)) description.remove_prefix(kDesign.size());
  std::string field;
  for (const char c : description) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      field += to_lower(c);
    } else if (!field.empty() && field.back() != '_') {
      field += '_';
    }
  }
  while (!field.empty() && field.back() == '_') field.pop_back();
  return field;
}

}  // namespace

Result<std::vector<ComponentSize>> read_component_sizes(const std::filesystem::path& file) {
  auto database =
      TRY(sqlite::Database::open(file, {.access = sqlite::Database::Access::read_only, .vfs = {}}));
  auto statement =
      TRY(database.prepare("SELECT CompType, CompName, Description, Value FROM ComponentSizes"));
  std::vector<ComponentSize> sizes;
  for (;;) {
    const auto has_row = TRY(statement.step());
    if (!has_row) return sizes;
    sizes.push_back({statement.text(0), statement.text(1), statement.text(2), statement.real(3)});
  }
}

FrozenSizes freeze_sizes(const std::vector<ComponentSize>& sizes, Json& objects) {
  using Place = std::tuple<std::string, std::string, std::string>;
  std::map<Place, double> by_field;
  for (const ComponentSize& size : sizes) {
    const auto field = field_of(size.description);
    if (field && size.value > 0.0) {
      by_field[{to_lower(size.type), to_lower(size.name), *field}] = size.value;
    }
  }
  FrozenSizes result;
  for (auto& [type, named] : objects.items()) {
    if (!named.is_object() || type.starts_with("CoolingTower")) continue;
    for (auto& [name, fields] : named.items()) {
      if (!fields.is_object()) continue;
      for (auto& [field, value] : fields.items()) {
        if (!is_autosized(value)) continue;
        const auto size = by_field.find({to_lower(type), to_lower(name), field});
        if (size == by_field.end()) {
          // What EnergyPlus calculates anew in each run (a person's sensible heat) is no size.
          if (to_lower(value.get<std::string>()) == "autocalculate") continue;
          result.left.push_back(fmt::format("{}/{}/{}", type, name, field));
        } else {
          value = size->second;
          ++result.frozen;
        }
      }
    }
  }
  return result;
}

}  // namespace recald::energyplus
