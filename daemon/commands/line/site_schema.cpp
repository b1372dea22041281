#include "daemon/commands/line/site_schema.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "daemon/commands/every_key.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;

/// The comment behind each line of the example; empty where there is none.
std::vector<std::string> comments_of(std::string_view text) {
  std::vector<std::string> comments;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    // No value of the example has a '#'.
    const auto hash = line.find("# ");
    comments.emplace_back(hash == std::string_view::npos ? "" : line.substr(hash + 2));
  }
  return comments;
}

const char* type_name(const toml::node& node) {
  if (node.is_string()) return "string";
  if (node.is_boolean()) return "boolean";
  if (node.is_array()) return "array";
  return node.is_table() ? "object" : "number";
}

/// Tables whose keys are names that the user chooses.
bool has_names_as_keys(std::string_view key) { return key == "bus" || key == "weights"; }

class Schema {
 public:
  explicit Schema(std::string_view example) : comments_(comments_of(example)) {}

  /// Adds what one table of the example shows to what others of its name have shown.
  void add(const toml::table& table, Json& object) const {
    object["type"] = "object";
    object["additionalProperties"] = false;
    for (const auto& [key, node] : table) {
      Json& property = object["properties"][std::string{key.str()}];
      describe(key.source().begin.line, property);
      add_node(key.str(), node, property);
    }
  }

 private:
  void add_node(std::string_view key, const toml::node& node, Json& property) const {
    if (const toml::table* child = node.as_table()) {
      describe(child->source().begin.line, property);
      if (has_names_as_keys(key)) {
        property["type"] = "object";
        for (const auto& [name, value] : *child) {
          add_node("", value, property["additionalProperties"]);
        }
      } else {
        add(*child, property);
      }
    } else if (node.is_array_of_tables()) {
      property["type"] = "array";
      for (const toml::node& element : *node.as_array()) {
        add(*element.as_table(), property["items"]);
      }
    } else {
      add_type(type_name(node), property);
      const toml::array* array = node.as_array();
      if (array != nullptr && !array->empty())
        add_type(type_name(array->front()), property["items"]);
      if (node.is_string() && may_be_list(property)) {
        property["type"] = Json::array({"string", "array"});
        property["items"]["type"] = "string";
      }
    }
  }

  /// The comment says so, as the one of a file that may be several.
  [[nodiscard]] static bool may_be_list(const Json& property) {
    return property.contains("description") &&
           property["description"].get<std::string>().find(" a list") != std::string::npos;
  }

  /// A port is a number of TCP or the name of a device.
  static void add_type(const char* name, Json& property) {
    if (!property.contains("type")) {
      property["type"] = name;
    } else if (property["type"].is_string() && property["type"] != name) {
      property["type"] = Json::array({property["type"], name});
    }
  }

  /// The first comment that a key has counts.
  void describe(std::size_t line, Json& property) const {
    const std::string& comment = comments_[line - 1];
    if (!comment.empty() && !property.contains("description")) property["description"] = comment;
  }

  std::vector<std::string> comments_;
};

}  // namespace

std::string site_schema() {
  Json root = {{"$schema", "http://json-schema.org/draft-07/schema#"},
               {"title", "Site file of recald"}};
  Schema{kEveryKey}.add(toml::parse(kEveryKey), root);
  return root.dump(2) + "\n";
}

}  // namespace recald::daemon
