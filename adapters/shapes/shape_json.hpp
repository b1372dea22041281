/// Listed structs as JSON, and back.
#pragma once

#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "adapters/shapes/shape.hpp"
#include "core/absent.hpp"
#include "core/metering/civil_time.hpp"

namespace recald::shapes {

using Json = nlohmann::ordered_json;

template <class T>
inline constexpr bool is_list = false;
template <class T>
inline constexpr bool is_list<std::vector<T>> = true;
template <class T, std::size_t kSize>
inline constexpr bool is_list<std::array<T, kSize>> = true;
template <class T>
inline constexpr bool is_map = false;
template <class T>
inline constexpr bool is_map<std::map<std::string, T>> = true;

/// How a type is written that is none of these: `static Json json_of(const T&)`, and, where it is
/// read strictly (strict_json.hpp), `static T read(StrictReader&, const nlohmann::json&, const
/// char* key)`.
template <class T>
struct Form;

template <class T>
concept Formed = requires(const T& value) {
  Form<T>::json_of(value);
};

template <>
struct Form<metering::Month> {
  static Json json_of(metering::Month month) { return metering::to_string(month); }
};
template <>
struct Form<metering::Day> {
  static Json json_of(metering::Day day) { return metering::to_string(day); }
};
/// Seconds since 1970.
template <>
struct Form<metering::Instant> {
  static Json json_of(metering::Instant time) { return time.time_since_epoch().count(); }
};
template <>
struct Form<std::chrono::seconds> {
  static Json json_of(std::chrono::seconds span) { return span.count(); }
};

/// An enum that is written as its name.
template <class Enum, Enum... kAll>
struct Words {
  static constexpr std::array kValues{kAll...};
  static Json json_of(Enum value) { return name_of(value); }
  static std::optional<Enum> find(std::string_view name) {
    for (const Enum one : kValues) {
      if (name_of(one) == name) return one;
    }
    return {};
  }
};

template <class T>
concept Worded = requires {
  Form<T>::kValues;
};

/// What reading begins with.
template <class T>
[[nodiscard]] T blank() {
  return T{};
}

/// A number that is not finite, and what is absent, is null.
template <class T>
[[nodiscard]] Json json_of(const T& value) {
  if constexpr (Formed<T>) {
    return Form<T>::json_of(value);
  } else if constexpr (std::is_floating_point_v<T>) {
    return std::isfinite(value) ? Json(value) : Json();
  } else if constexpr (is_optional<T>) {
    return value ? json_of(*value) : Json();
  } else if constexpr (is_list<T>) {
    Json list = Json::array();
    for (const auto& one : value) list.push_back(json_of(one));
    return list;
  } else if constexpr (is_map<T>) {
    Json object = Json::object();
    for (const auto& [name, one] : value) object[name] = json_of(one);
    return object;
  } else if constexpr (Listed<T>) {
    Json object = Json::object();
    std::apply(
        [&](const auto&... field) { ((object[field.name] = json_of(value.*field.value)), ...); },
        fields<T>);
    return object;
  } else {
    return Json(value);
  }
}

/// What is missing or of another type is absent: no value, NaN, an empty text, false, the first
/// name.
/// @return whether it is of the type; of a list or an object, its elements may still be absent.
template <class T>
bool read(const Json& json, T& value) {
  value = T{};
  if constexpr (std::is_same_v<T, bool>) {
    if (json.is_boolean()) value = json.get<bool>();
    return json.is_boolean();
  } else if constexpr (std::is_floating_point_v<T>) {
    value = json.is_number() ? json.get<T>() : kAbsent;
    return json.is_number();
  } else if constexpr (std::is_same_v<T, std::string>) {
    if (json.is_string()) value = json.get<std::string>();
    return json.is_string();
  } else if constexpr (Worded<T>) {
    const auto named = json.is_string() ? Form<T>::find(json.get<std::string>()) : std::nullopt;
    value = named.value_or(Form<T>::kValues.front());
    return named.has_value();
  } else if constexpr (is_optional<T>) {
    if (!read(json, value.emplace())) value.reset();
    return value.has_value() || json.is_null();
  } else if constexpr (is_list<T>) {
    if (!json.is_array()) return false;
    for (const Json& one : json) {
      if (!read(one, value.emplace_back()) && Listed<typename T::value_type>) value.pop_back();
    }
    return true;
  } else if constexpr (is_map<T>) {
    if (!json.is_object()) return false;
    for (const auto& [name, one] : json.items()) {
      if (!read(one, value[name])) value.erase(name);
    }
    return true;
  } else {
    static_assert(Listed<T>);
    static const Json missing;
    const auto member = [&](const char* name) -> const Json& {
      const auto found = json.is_object() ? json.find(name) : json.end();
      return found == json.end() ? missing : *found;
    };
    std::apply([&](const auto&... field) { (read(member(field.name), value.*field.value), ...); },
               fields<T>);
    return json.is_object();
  }
}

}  // namespace recald::shapes
