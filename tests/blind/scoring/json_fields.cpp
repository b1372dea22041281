#include "tests/blind/scoring/json_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

namespace recald::blind {
namespace {

using nlohmann::json;

/// What was found, short enough for a sentence.
std::string shown(const json& value) {
  constexpr std::size_t longest = 40;
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() > longest) text = text.substr(0, longest) + "...";
  return text;
}

}  // namespace

JsonFields::JsonFields(const json& value, std::string where)
    : value_(value), where_(std::move(where)) {
  if (!value_.is_object()) {
    fail("must be a JSON object, not " + shown(value_));
    value_ = json::object();
  }
}

bool JsonFields::has(std::string_view key) const {
  const auto found = value_.find(key);
  return found != value_.end() && !found->is_null();
}

double JsonFields::number(std::string_view key, NumberRange range) {
  const json* value = find(key);
  if (value == nullptr) return 0.0;
  if (!value->is_number()) {
    wrong(key, "a number", *value);
    return 0.0;
  }
  const double number = value->get<double>();
  if (!(number >= range.min && number <= range.max)) {
    constexpr NumberRange open;
    wrong(key,
          range.max < open.max ? fmt::format("from {:g} to {:g}", range.min, range.max)
                               : fmt::format("at least {:g}", range.min),
          *value);
  }
  return number;
}

bool JsonFields::boolean(std::string_view key) {
  const json* value = find(key);
  if (value == nullptr) return false;
  if (value->is_boolean()) return value->get<bool>();
  wrong(key, "true or false", *value);
  return false;
}

std::string JsonFields::text(std::string_view key) {
  const json* value = find(key);
  if (value == nullptr) return "";
  if (value->is_string()) return value->get<std::string>();
  wrong(key, "a text", *value);
  return "";
}

std::string JsonFields::name(std::string_view key) {
  std::string text_found = text(key);
  if (!error_ && !is_plain_name(text_found)) {
    wrong(key, "a name of letters, digits, dots, dashes and underscores", json(text_found));
  }
  return text_found;
}

std::vector<std::string> JsonFields::names(std::string_view key) {
  std::vector<std::string> found;
  const json* value = find(key);
  if (value == nullptr) return found;
  const bool all_names =
      value->is_array() && std::ranges::all_of(*value, [](const json& item) {
        return item.is_string() && is_plain_name(item.get_ref<const std::string&>());
      });
  if (!all_names) {
    wrong(key, "a list of names", *value);
    return found;
  }
  found = value->get<std::vector<std::string>>();
  if (std::set<std::string>(found.begin(), found.end()).size() != found.size()) {
    wrong(key, "a list without repetition", *value);
  }
  return found;
}

std::string JsonFields::word(std::string_view key, std::span<const std::string_view> words) {
  std::string found = text(key);
  if (!error_ && std::ranges::find(words, found) == words.end()) {
    wrong(key, fmt::format("one of {}", fmt::join(words, ", ")), json(found));
  }
  return found;
}

std::map<std::string, double> JsonFields::numbers(std::string_view key, NumberRange range) {
  std::map<std::string, double> found;
  object(key, [&](JsonFields& fields) {
    for (const auto& [name_found, ignored] : fields.value_.items()) {
      found[name_found] = fields.number(name_found, range);
      if (!is_plain_name(name_found)) {
        fields.fail("key '" + name_found +
                    "' must be made of letters, digits, dots, dashes and underscores");
      }
    }
  });
  return found;
}

void JsonFields::object(std::string_view key, const std::function<void(JsonFields&)>& visit) {
  const json* value = find(key);
  if (value == nullptr) return;
  if (!value->is_object()) return wrong(key, "an object", *value);
  nested(*value, std::string(key), visit);
}

void JsonFields::each(std::string_view key, const Visit& visit) {
  const json* value = find(key);
  if (value == nullptr) return;
  if (!value->is_object() && !value->is_array()) return wrong(key, "an object or a list", *value);
  for (const auto& [item_key, item] : value->items()) {
    const std::string path = std::string(key) + "." + item_key;
    if (!item.is_object()) return wrong(path, "an object", item);
    nested(item, path,
           [&, &name_found = item_key](JsonFields& fields) { visit(name_found, fields); });
  }
}

void JsonFields::only(std::span<const std::string_view> known) {
  for (const auto& [key, ignored] : value_.items()) {
    if (std::ranges::find(known, key) == known.end()) {
      return fail(fmt::format("key '{}{}' is not known here; known are {}", path_, key,
                              fmt::join(known, ", ")));
    }
  }
}

void JsonFields::fail(std::string sentence) {
  if (!error_) error_ = Error{ErrorCode::malformed, where_ + ": " + std::move(sentence)};
}

const json* JsonFields::find(std::string_view key) {
  const auto found = value_.find(key);
  if (found != value_.end()) return &*found;
  fail(fmt::format("'{}{}' is missing", path_, key));
  return nullptr;
}

void JsonFields::nested(const json& value, const std::string& path,
                        const std::function<void(JsonFields&)>& visit) {
  JsonFields fields(value, where_);
  fields.path_ = path_ + path + ".";
  visit(fields);
  if (!error_) error_ = fields.error_;
}

void JsonFields::wrong(std::string_view key, std::string_view wanted, const json& found) {
  fail(fmt::format("'{}{}' is {}, must be {}", path_, key, shown(found), wanted));
}

Result<json> parse_json(std::string_view text, const std::string& where) {
  json value = json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (value.is_discarded()) return failure(ErrorCode::malformed, where + ": not valid JSON");
  return value;
}

bool is_plain_name(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '_';
  });
}

}  // namespace recald::blind
