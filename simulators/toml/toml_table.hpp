/// Strict reader for the simulators' TOML files: wrong values and unknown keys are reported
/// with file and line.
#pragma once

#include <fmt/format.h>

// toml++ has assertions that a bad file can break ("[{" does), which would abort a program with
// assertions on. Without them the same parser returns an error.
#define TOML_ASSERT(expr) static_assert(true)
#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::simulators {

/// Keeps the first mistake, so that reading need not stop at every key.
class Complaint {
 public:
  explicit Complaint(std::string file) : file_(std::move(file)) {}

  void about(const toml::node* node, const std::string& sentence);
  [[nodiscard]] bool empty() const { return sentence_.empty(); }
  [[nodiscard]] const std::string& sentence() const { return sentence_; }

 private:
  std::string file_;
  std::string sentence_;
};

template <class T>
struct Word {
  std::string_view text;
  T value;
};

using Names = std::set<std::string, std::less<>>;

/// " (did you mean storeys?)", or nothing if no name is close.
[[nodiscard]] std::string did_you_mean(std::string_view text, const Names& names);

/// @param what  "scenario": the reader's word for the file.
/// @return the file's tables; not_found, or malformed with file and line.
[[nodiscard]] Result<toml::table> read_toml(const std::filesystem::path& path,
                                            std::string_view what);

/// One table. It remembers which keys were read, so that the others are unknown. A value stays
/// unchanged if its key is absent or wrong.
class TomlTable {
 public:
  /// @param table  Null: an absent table without keys.
  TomlTable(const toml::table* table, std::string_view name, Complaint& complaint)
      : table_(table), name_(name), complaint_(complaint) {}

  void number(std::string_view key, double least, double most, double& value);
  void number(std::string_view key, double least, double most, std::optional<double>& value);
  void whole(std::string_view key, std::int64_t least, std::int64_t most, std::int64_t& value);
  void flag(std::string_view key, bool& value);
  template <class T, std::size_t N>
  void word(std::string_view key, const std::array<Word<T>, N>& words, T& value);
  /// Empty if absent.
  [[nodiscard]] std::string text(std::string_view key);
  [[nodiscard]] std::optional<metering::Day> day(std::string_view key);
  /// `count` numbers, or one; empty if the key is absent.
  [[nodiscard]] std::vector<double> one_or_numbers(std::string_view key, std::size_t count,
                                                   double least, double most);
  /// [[NAME]]: all tables of that name.
  [[nodiscard]] std::vector<TomlTable> tables(std::string_view key);

  void no_other_keys();

  [[nodiscard]] bool has(std::string_view key) const {
    return table_ != nullptr && table_->contains(key);
  }
  [[nodiscard]] const toml::node* node() const { return table_; }

 private:
  const toml::node* find(std::string_view key);

  const toml::table* table_;
  std::string_view name_;
  Complaint& complaint_;
  Names asked_;
};

template <class T, std::size_t N>
void TomlTable::word(std::string_view key, const std::array<Word<T>, N>& words, T& value) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const auto given = node->value<std::string_view>().value_or("");
  const auto found = std::ranges::find(words, given, &Word<T>::text);
  if (found != words.end()) {
    value = found->value;
    return;
  }
  std::string list;
  for (const Word<T>& word : words) list += (list.empty() ? "" : ", ") + std::string(word.text);
  complaint_.about(node, fmt::format("{} in [{}] is one of {}", key, name_, list));
}

}  // namespace recald::simulators
