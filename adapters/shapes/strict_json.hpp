/// Listed structs out of JSON that must be whole: every field there, of its type, within its range.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "adapters/shapes/shape_json.hpp"
#include "core/result.hpp"
#include "core/text/limited.hpp"

namespace recald::shapes {

using Parsed = nlohmann::json;  ///< Looks keys up without going through all of them.

/// Takes values out of JSON and remembers the first that is not as it must be.
class StrictReader {
 public:
  static constexpr std::int64_t kInt_max = std::numeric_limits<int>::max();
  static constexpr std::int64_t kNumber_max = std::numeric_limits<std::int64_t>::max();
  /// Of what is sent: sums of some of them are numbers too.
  static constexpr std::int64_t kSent_max = std::int64_t{1} << 60;
  /// Of a text, in bytes; what is longer is shortened, since a refused batch would hold up those
  /// behind it.
  static constexpr std::size_t kText_max = 16'000;
  // A sender whose clock is wrong is read too: anything that a database can hold, year 1 to 9999.
  static constexpr std::int64_t kFirst_s = -62'135'596'800;
  static constexpr std::int64_t kLast_s = 253'402'300'799;

  /// @param what  For sentences: "the batch".
  explicit StrictReader(std::string_view what) : what_(what) {}

  /// @param key  For sentences: what the value is called.
  template <class T>
  T read(const Parsed& json, const char* key) {
    using metering::Instant;
    if constexpr (Listed<T>) {
      T value = blank<T>();
      std::apply(
          [&](const auto&... field) {
            ((value.*field.value =
                  member<std::remove_reference_t<decltype(value.*field.value)>>(json, field.name)),
             ...);
          },
          fields<T>);
      return value;
    } else if constexpr (std::is_same_v<T, bool>) {
      if (json.is_boolean()) return json.get<bool>();
      refuse(key, "is neither true nor false");
      return false;
    } else if constexpr (std::is_same_v<T, double>) {  // null: not a number
      if (json.is_number()) return json.get<double>();
      if (!json.is_null()) refuse(key, "is no number");
      return kAbsent;
    } else if constexpr (std::is_same_v<T, int>) {
      return static_cast<int>(integer(json, key, 0, kInt_max));
    } else if constexpr (std::is_same_v<T, std::int64_t>) {
      return integer(json, key, 0, kSent_max);
    } else if constexpr (std::is_same_v<T, std::chrono::seconds>) {
      return std::chrono::seconds{integer(json, key, 0, kInt_max)};
    } else if constexpr (std::is_same_v<T, Instant>) {
      return Instant{std::chrono::seconds{integer(json, key, kFirst_s, kLast_s)}};
    } else if constexpr (std::is_same_v<T, std::string>) {
      if (json.is_string()) return limited(json.get_ref<const std::string&>(), kText_max);
      refuse(key, "is no text");
      return {};
    } else if constexpr (std::is_same_v<T, metering::Month>) {
      const auto parsed = metering::parse_month(read<std::string>(json, key));
      if (!parsed) refuse(key, "is no month such as \"2026-03\"");
      return parsed.value_or(std::chrono::year{1970} / 1);
    } else if constexpr (std::is_same_v<T, metering::Day>) {
      const auto parsed = metering::parse_day(read<std::string>(json, key));
      if (!parsed) refuse(key, "is no day such as \"2026-03-01\"");
      return parsed.value_or(std::chrono::year{1970} / 1 / 1);
    } else if constexpr (is_optional<T>) {
      if (json.is_null()) return {};
      return read<typename T::value_type>(json, key);
    } else if constexpr (is_list<T>) {
      return list<T>(json, key);
    } else {
      return Form<T>::read(*this, json, key);
    }
  }

  template <class T>
  T member(const Parsed& object, const char* key) {
    return read<T>(at(object, key), key);
  }
  /// A text of any length: a document in itself.
  std::string document(const Parsed& json, const char* key) {
    if (json.is_string()) return json.get<std::string>();
    refuse(key, "is no text");
    return {};
  }
  /// @return null, which hardly any type takes, if it is missing.
  const Parsed& at(const Parsed& object, const char* key) {
    static const Parsed missing;
    const auto found = object.is_object() ? object.find(key) : object.end();
    if (found != object.end()) return *found;
    refuse(key, "is missing");
    return missing;
  }

  std::int64_t integer(const Parsed& value, const char* key, std::int64_t min, std::int64_t max) {
    if (!value.is_number_integer()) {
      refuse(key, "is no whole number");
      return min;
    }
    const bool is_large = value.is_number_unsigned() &&
                          value.get<std::uint64_t>() > static_cast<std::uint64_t>(kNumber_max);
    const std::int64_t number = is_large ? kNumber_max : value.get<std::int64_t>();
    if (is_large || number < min || number > max) {
      refuse(key, fmt::format("is {}; it must lie between {} and {}", value.dump(), min, max));
      return min;
    }
    return number;
  }

  /// Calls each(element) for the elements of a list; sentences say which.
  template <class Each>
  void each_of(const Parsed& list, const char* key, Each each) {
    if (!list.is_array()) return refuse(key, "is no list");
    const std::string outer = std::exchange(where_, {});
    for (std::size_t i = 0; i < list.size() && problem_.empty(); ++i) {
      where_ = fmt::format("{}{}{}[{}]", outer, outer.empty() ? "" : ".", key, i);
      each(list[i]);
    }
    where_ = outer;
  }

  void refuse(const char* key, std::string_view why) {
    if (!problem_.empty()) return;
    problem_ = fmt::format("{}{}'{}' {}", where_, where_.empty() ? "" : ": ", key, why);
  }
  /// @return the value, or malformed with the first that was not as it must be.
  template <class T>
  Result<T> result(T value) const {
    if (problem_.empty()) return value;
    return failure(ErrorCode::malformed, fmt::format("{}: {}", what_, problem_));
  }

 private:
  template <class T>
  T list(const Parsed& json, const char* key) {
    using Element = typename T::value_type;
    T all{};
    if constexpr (requires { all.push_back(std::declval<Element>()); }) {
      each_of(json, key, [&](const Parsed& one) { all.push_back(read<Element>(one, key)); });
    } else if (json.is_array() && json.size() == all.size()) {
      for (std::size_t i = 0; i < all.size(); ++i) all[i] = read<Element>(json[i], key);
    } else {
      refuse(key, fmt::format("is no list of {} numbers", all.size()));
    }
    return all;
  }

  std::string_view what_;
  std::string where_;
  std::string problem_;
};

/// An enum that is written as its number.
template <class Enum, std::int64_t kMost>
struct Numbered {
  static Json json_of(Enum value) { return static_cast<std::int64_t>(value); }
  static Enum read(StrictReader& reader, const Parsed& json, const char* key) {
    return static_cast<Enum>(reader.integer(json, key, 0, kMost));
  }
};

/// An enum that is written as its name; of others than `kAll` nothing is read.
template <class Enum, Enum... kAll>
struct Named : Words<Enum, kAll...> {
  static constexpr std::size_t kShown_max = 40;
  static Enum read(StrictReader& reader, const Parsed& json, const char* key) {
    const auto named = Named::find(reader.read<std::string>(json, key));
    if (named) return *named;
    std::vector<std::string_view> known;
    for (const Enum one : Named::kValues) known.push_back(name_of(one));
    const std::string shown = json.dump();
    reader.refuse(
        key, fmt::format("is {}; it must be one of {}",
                         shown.size() > kShown_max ? "another" : shown, fmt::join(known, ", ")));
    return Named::kValues.front();
  }
};

}  // namespace recald::shapes
