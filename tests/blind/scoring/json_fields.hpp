/// Reading of JSON objects in which every mistake is one sentence: where, which key, which value.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace recald::blind {

struct NumberRange {
  double min = std::numeric_limits<double>::lowest();
  double max = std::numeric_limits<double>::max();
};

/// Reads one object. The first mistake sticks and ends up in `error`; what is read after it are
/// placeholders, so that a caller reads all fields and asks once.
class JsonFields {
 public:
  /// @param where  How people name the object: "sealed.jsonl line 7", "answer sealed-017".
  JsonFields(const nlohmann::json& value, std::string where);

  [[nodiscard]] bool has(std::string_view key) const;  ///< There and not null.

  [[nodiscard]] double number(std::string_view key, NumberRange range = {});
  [[nodiscard]] bool boolean(std::string_view key);
  [[nodiscard]] std::string text(std::string_view key);
  /// Letters, digits, dot, dash and underscore: goes into tables and file names as it is.
  [[nodiscard]] std::string name(std::string_view key);
  [[nodiscard]] std::vector<std::string> names(std::string_view key);
  /// One of the words.
  [[nodiscard]] std::string word(std::string_view key, std::span<const std::string_view> words);
  [[nodiscard]] std::map<std::string, double> numbers(std::string_view key, NumberRange range = {});

  using Visit = std::function<void(const std::string& key, JsonFields& fields)>;
  /// Calls `visit` with the object under `key`.
  void object(std::string_view key, const std::function<void(JsonFields&)>& visit);
  /// With each object of the object or list under `key`; the key of a list's item is its index.
  void each(std::string_view key, const Visit& visit);

  /// A key outside `known` is a mistake: a misspelt optional one would be lost without a word.
  void only(std::span<const std::string_view> known);

  void fail(std::string sentence);  ///< Kept only if nothing failed before.
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }
  [[nodiscard]] const std::string& where() const { return where_; }

 private:
  const nlohmann::json* find(std::string_view key);
  void nested(const nlohmann::json& value, const std::string& path,
              const std::function<void(JsonFields&)>& visit);
  void wrong(std::string_view key, std::string_view wanted, const nlohmann::json& found);

  nlohmann::json value_;
  std::string where_;
  std::string path_;
  std::optional<Error> error_;
};

/// Parses text; what JSON itself forbids (and a number too large for a double) is malformed.
[[nodiscard]] Result<nlohmann::json> parse_json(std::string_view text, const std::string& where);

/// Letters, digits, dot, dash and underscore, at least one.
[[nodiscard]] bool is_plain_name(std::string_view text);

}  // namespace recald::blind
