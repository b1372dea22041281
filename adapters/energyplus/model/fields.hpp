/// Small reads from epJSON objects.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adapters/energyplus/model/model_document.hpp"

namespace recald::energyplus {

/// The objects of a type with their names, in the document's order.
[[nodiscard]] inline std::vector<std::pair<std::string, const Json*>> objects_of(
    const Json& objects, std::string_view type) {
  std::vector<std::pair<std::string, const Json*>> found;
  const auto named = objects.find(std::string{type});
  if (named == objects.end() || !named->is_object()) return found;
  for (const auto& [name, object] : named->items()) {
    if (object.is_object()) found.emplace_back(name, &object);
  }
  return found;
}

/// The field's text, or `otherwise` where it has none.
[[nodiscard]] inline std::string text_of(const Json& object, std::string_view field,
                                         std::string_view otherwise = "") {
  const auto value = object.find(std::string{field});
  const bool has = value != object.end() && value->is_string();
  return has && !value->get<std::string>().empty() ? value->get<std::string>()
                                                   : std::string{otherwise};
}

/// The field's number, or `otherwise` where it has none ("Autosize").
[[nodiscard]] inline double number_of(const Json& object, std::string_view field,
                                      double otherwise = 0.0) {
  const auto value = object.find(std::string{field});
  return value != object.end() && value->is_number() ? value->get<double>() : otherwise;
}

}  // namespace recald::energyplus
