/// Strict reading of TOML tables: every mistake is named with file, line and key, and a key that
/// nobody asked for is a mistake too.
#pragma once

// toml++ asserts what a file may well break ("[{" does), which would end a program whose assertions
// are on; without it the same parser answers with an error.
#define TOML_ASSERT(expr) static_assert(true)
#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald {

/// What is wrong with a configuration, one sentence each, in order of discovery.
using Problems = std::vector<std::string>;

struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

inline constexpr NumberRange kPositive{std::numeric_limits<double>::min()};
inline constexpr NumberRange kNotNegative{0.0};
inline constexpr NumberRange kShare{0.0, 1.0};

/// A word of a file and what it stands for.
template <class T>
struct Word {
  std::string_view text;
  T value;
};

/// Reads one table. Keys asked for are the known ones; call `finish` when all have been asked for.
class TomlReader {
 public:
  /// @param where  The table as people write it: "[building.air]"; empty for the whole file.
  TomlReader(const toml::table& table, std::string file, std::string where, Problems& problems);

  [[nodiscard]] std::optional<std::string> text(std::string_view key);
  [[nodiscard]] std::optional<double> number(std::string_view key, NumberRange range = {});
  [[nodiscard]] std::optional<bool> boolean(std::string_view key);
  /// "15m", "72h", "20s", "5d".
  [[nodiscard]] std::optional<std::chrono::seconds> duration(std::string_view key);
  /// "200ms" or as `duration`: for waits that are shorter than a second.
  [[nodiscard]] std::optional<std::chrono::milliseconds> milliseconds(std::string_view key);
  [[nodiscard]] std::optional<metering::Month> month(std::string_view key);
  [[nodiscard]] std::optional<metering::Day> day(std::string_view key);
  [[nodiscard]] std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count,
                                                           NumberRange range = {});
  [[nodiscard]] std::optional<std::vector<std::string>> texts(std::string_view key);
  /// A text alone, or a list of texts; an empty list, or an empty text in it, is a problem.
  [[nodiscard]] std::optional<std::vector<std::string>> one_or_more(std::string_view key);
  /// One of the words; anything else is a problem that lists them.
  [[nodiscard]] std::optional<std::string> word(std::string_view key,
                                                const std::vector<std::string_view>& words);
  template <class T, std::size_t N>
  [[nodiscard]] std::optional<T> word(std::string_view key, const std::array<Word<T>, N>& words) {
    std::vector<std::string_view> texts;
    for (const Word<T>& one : words) texts.push_back(one.text);
    const auto text = word(key, texts);
    const auto found = text ? std::ranges::find(words, *text, &Word<T>::text) : words.end();
    return found == words.end() ? std::nullopt : std::optional{found->value};
  }
  [[nodiscard]] std::optional<TomlReader> table(std::string_view key);
  [[nodiscard]] std::vector<TomlReader> tables(std::string_view key);

  /// The value or, where absent, `fallback`.
  [[nodiscard]] double number_or(std::string_view key, double fallback, NumberRange range = {});
  /// A whole number; 2.5 storeys are a problem.
  [[nodiscard]] int whole_number_or(std::string_view key, int fallback, NumberRange range);
  [[nodiscard]] std::string text_or(std::string_view key, std::string fallback);
  /// The value; absence is a problem, and so is an empty text. A placeholder comes back then, and
  /// the load fails at its end.
  [[nodiscard]] double required_number(std::string_view key, NumberRange range = {});
  [[nodiscard]] std::string required_text(std::string_view key);

  /// Whether the key is there, be its value right or wrong.
  [[nodiscard]] bool has(std::string_view key) const { return table_->contains(key); }
  [[nodiscard]] bool is_list(std::string_view key) const {
    const toml::node* node = table_->get(key);
    return node != nullptr && node->is_array();
  }
  /// Keys of this table, for tables whose keys are names of the user's (weights by meter).
  [[nodiscard]] std::vector<std::string> keys() const;

  /// This table as TOML, its keys in alphabetical order.
  [[nodiscard]] std::string toml() const;

  /// Whether anything of the whole file was wrong so far.
  [[nodiscard]] bool has_problems() const { return !problems_->empty(); }

  /// Records a problem at this table's line, or at the key's.
  void problem(std::string sentence);
  void problem_at(std::string_view key, std::string sentence);

  /// Reports keys that were never asked for, each with the nearest known one.
  void finish();

 private:
  const toml::node* find(std::string_view key);
  void add(std::string place, std::string_view sentence);
  [[nodiscard]] std::string at(const toml::node& node) const;

  const toml::table* table_;
  std::string file_;
  std::string where_;
  Problems* problems_;
  std::vector<std::string> asked_;
};

/// As toml::parse, which recurses over the parts of a key: one of more than a hundred is refused.
/// @param source  The file's name, for messages.
/// @throws toml::parse_error
[[nodiscard]] toml::table parse_toml(std::string_view text, std::string_view source = {});

/// @param what  "scenario": what the file is, for people.
/// @return not_found, or malformed with the line
[[nodiscard]] Result<toml::table> read_toml(const std::filesystem::path& file,
                                            std::string_view what);

/// What a file that is no TOML is answered: the line, and the parser's reason.
[[nodiscard]] std::string syntax_problem(std::string_view file, const toml::parse_error& error);

/// "15m" and the like; nothing for text that is no positive duration.
[[nodiscard]] std::optional<std::chrono::seconds> parse_duration(std::string_view text);

/// "03:15"
[[nodiscard]] std::optional<std::chrono::minutes> parse_time_of_day(std::string_view text);

}  // namespace recald
