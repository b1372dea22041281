#include "adapters/toml/toml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

#include "core/text/nearest.hpp"
#include "core/text/printable.hpp"

namespace recald {

namespace {

/// What a number must be, for people. TOML itself knows inf and nan.
std::string limits_of(NumberRange range) {
  if (std::isfinite(range.max)) return fmt::format("between {} and {}", range.min, range.max);
  if (range.min > 0.0) return "greater than 0";
  return std::isfinite(range.min) ? fmt::format("at least {}", range.min) : "a finite number";
}

/// Where a text or a comment that begins at `at` ends.
std::size_t end_of_quoted(std::string_view text, std::size_t at) {
  const char quote = text[at];
  if (quote == '#') return std::min(text.find('\n', at), text.size());
  const std::string triple(3, quote);
  const bool is_long = text.substr(at).starts_with(triple);
  const std::string_view close =
      is_long ? std::string_view{triple} : std::string_view{triple}.substr(2);
  for (std::size_t i = at + close.size(); i < text.size(); ++i) {
    if (!is_long && text[i] == '\n') return i;
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (text.substr(i).starts_with(close)) {
      return i + close.size();
    }
  }
  return text.size();
}

/// The line of the first key with more parts than are read; 0: none has.
std::size_t line_of_deep_key(std::string_view text) {
  constexpr int kDotsMax = 100;
  std::size_t line = 1;
  int dots = 0;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'' || c == '#') {
      const std::size_t end = end_of_quoted(text, i);
      line += static_cast<std::size_t>(std::count(text.begin() + static_cast<std::ptrdiff_t>(i),
                                                  text.begin() + static_cast<std::ptrdiff_t>(end),
                                                  '\n'));
      i = std::max(end, i + 1);
      continue;
    }
    const bool is_of_key = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' ||
                           c == '-' || c == ' ' || c == '\t';
    if (c == '.' && ++dots > kDotsMax) return line;
    if (c != '.' && !is_of_key) dots = 0;
    if (c == '\n') ++line;
    ++i;
  }
  return 0;
}

}  // namespace

toml::table parse_toml(std::string_view text, std::string_view source) {
  if (const std::size_t line = line_of_deep_key(text); line > 0) {
    const toml::source_position at{static_cast<toml::source_index>(line), 1};
    throw toml::parse_error{"a key has more than 100 parts", toml::source_region{at, at, {}}};
  }
  return toml::parse(text, source);
}

std::string syntax_problem(std::string_view file, const toml::parse_error& error) {
  return printable(fmt::format("{}:{}: not valid TOML: {}", file, error.source().begin.line,
                               error.description()));
}

Result<toml::table> read_toml(const std::filesystem::path& file, std::string_view what) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream || !std::filesystem::is_regular_file(file)) {
    return failure(ErrorCode::not_found,
                   fmt::format("cannot read the {} {}; check its path", what, file.string()));
  }
  std::ostringstream text;
  text << stream.rdbuf();
  try {
    return parse_toml(text.str());
  } catch (const toml::parse_error& error) {
    return failure(ErrorCode::malformed, syntax_problem(file.string(), error));
  }
}

std::optional<std::chrono::seconds> parse_duration(std::string_view text) {
  long long count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  const std::string_view unit{end, static_cast<std::size_t>(text.data() + text.size() - end)};
  if (error != std::errc{} || count < 0 || count > 1'000'000'000 || unit.size() != 1) return {};
  switch (unit.front()) {
    case 's':
      return std::chrono::seconds{count};
    case 'm':
      return std::chrono::minutes{count};
    case 'h':
      return std::chrono::hours{count};
    case 'd':
      return std::chrono::days{count};
    default:
      return {};
  }
}

TomlReader::TomlReader(const toml::table& table, std::string file, std::string where,
                       Problems& problems)
    : table_(&table), file_(std::move(file)), where_(std::move(where)), problems_(&problems) {}

std::string TomlReader::at(const toml::node& node) const {
  const auto line = node.source().begin.line;
  const std::string place = line > 0 ? fmt::format("{}:{}: ", file_, line) : file_ + ": ";
  return where_.empty() ? place : place + where_ + " ";
}

/// Sentences quote keys and texts of the file, whatever these contain.
void TomlReader::add(std::string place, std::string_view sentence) {
  problems_->push_back(printable(std::move(place).append(sentence)));
}

void TomlReader::problem(std::string sentence) { add(at(*table_), sentence); }

void TomlReader::problem_at(std::string_view key, std::string sentence) {
  const toml::node* node = table_->get(key);
  add(at(node != nullptr ? *node : *table_), sentence);
}

const toml::node* TomlReader::find(std::string_view key) {
  asked_.emplace_back(key);
  return table_->get(key);
}

std::optional<std::string> TomlReader::text(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  if (const auto value = node->value_exact<std::string>()) return value;
  problem_at(key, fmt::format("'{}' must be text in quotes", key));
  return {};
}

std::optional<double> TomlReader::number(std::string_view key, NumberRange range) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  const auto value = node->is_number() ? node->value<double>() : std::nullopt;
  if (!value) {
    problem_at(key, fmt::format("'{}' must be a number", key));
    return {};
  }
  if (!std::isfinite(*value) || !(range.min <= *value && *value <= range.max)) {
    problem_at(key, fmt::format("'{}' is {}; it must be {}", key, *value, limits_of(range)));
    return {};
  }
  return value;
}

std::optional<bool> TomlReader::boolean(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  if (const auto value = node->value_exact<bool>()) return value;
  problem_at(key, fmt::format("'{}' must be true or false", key));
  return {};
}

std::optional<std::chrono::seconds> TomlReader::duration(std::string_view key) {
  const auto value = text(key);
  if (!value) return {};
  if (const auto length = parse_duration(*value)) return length;
  problem_at(
      key, fmt::format("'{}' is \"{}\"; write a duration such as \"15m\" or \"72h\"", key, *value));
  return {};
}

std::optional<std::chrono::milliseconds> TomlReader::milliseconds(std::string_view key) {
  const auto value = text(key);
  if (!value) return {};
  if (const auto length = parse_duration(*value)) return length;
  if (value->ends_with("ms")) {
    // "200ms" is "200s" by a thousand.
    const std::string_view count = std::string_view{*value}.substr(0, value->size() - 2);
    if (const auto length = parse_duration(std::string{count} + "s")) {
      return std::chrono::milliseconds{length->count()};
    }
  }
  problem_at(key, fmt::format("'{}' is \"{}\"; write a duration such as \"200ms\" or \"5s\"", key,
                              *value));
  return {};
}

std::optional<metering::Month> TomlReader::month(std::string_view key) {
  const auto value = text(key);
  if (!value) return {};
  const auto parsed = metering::parse_month(*value);
  if (parsed) return *parsed;
  problem_at(key, fmt::format("'{}': {}", key, parsed.error().message));
  return {};
}

std::optional<metering::Day> TomlReader::day(std::string_view key) {
  const auto value = text(key);
  if (!value) return {};
  const auto parsed = metering::parse_day(*value);
  if (parsed) return *parsed;
  problem_at(key, fmt::format("'{}': {}", key, parsed.error().message));
  return {};
}

std::optional<std::vector<double>> TomlReader::numbers(std::string_view key, std::size_t count,
                                                       NumberRange range) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  std::vector<double> values;
  if (const toml::array* array = node->as_array()) {
    for (const toml::node& element : *array) {
      const auto value = element.is_number() ? element.value<double>() : std::nullopt;
      if (value && range.min <= *value && *value <= range.max) values.push_back(*value);
    }
    if (values.size() == count && array->size() == count) return values;
  }
  problem_at(key, fmt::format("'{}' must be a list of {} numbers between {} and {}", key, count,
                              range.min, range.max));
  return {};
}

std::optional<std::vector<std::string>> TomlReader::texts(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  std::vector<std::string> values;
  if (const toml::array* array = node->as_array()) {
    for (const toml::node& element : *array) {
      if (const auto value = element.value_exact<std::string>()) values.push_back(*value);
    }
    if (values.size() == array->size()) return values;
  }
  problem_at(key, fmt::format("'{}' must be a list of texts in quotes", key));
  return {};
}

std::optional<std::vector<std::string>> TomlReader::one_or_more(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  std::vector<std::string> values;
  if (const auto one = node->value_exact<std::string>()) values.push_back(*one);
  if (const toml::array* array = node->as_array()) {
    for (const toml::node& element : *array) {
      values.push_back(element.value_exact<std::string>().value_or(""));
    }
  }
  if (!values.empty() && std::ranges::find(values, "") == values.end()) return values;
  problem_at(key, fmt::format("'{}' must be a text in quotes, or a list of such texts", key));
  return {};
}

std::optional<std::string> TomlReader::word(std::string_view key,
                                            const std::vector<std::string_view>& words) {
  const auto value = text(key);
  if (!value || std::ranges::find(words, *value) != words.end()) return value;
  problem_at(key, fmt::format("'{}' is \"{}\"; it must be one of {}", key, *value,
                              fmt::join(words, ", ")));
  return {};
}

std::optional<TomlReader> TomlReader::table(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  const std::string path = where_.empty()
                               ? fmt::format("[{}]", key)
                               : fmt::format("{}.{}]", where_.substr(0, where_.size() - 1), key);
  if (const toml::table* child = node->as_table()) {
    return TomlReader{*child, file_, path, *problems_};
  }
  problem_at(key, fmt::format("'{}' must be a table, written {}", key, path));
  return {};
}

std::vector<TomlReader> TomlReader::tables(std::string_view key) {
  const toml::node* node = find(key);
  std::vector<TomlReader> readers;
  if (node == nullptr) return readers;
  const std::string inner = where_.empty()
                                ? std::string{key}
                                : fmt::format("{}.{}", where_.substr(1, where_.size() - 2), key);
  const toml::array* array = node->as_array();
  if (array == nullptr || !std::ranges::all_of(*array, &toml::node::is_table)) {
    problem_at(key, fmt::format("'{}' must be a list of tables, each headed [[{}]]", key, inner));
    return readers;
  }
  for (const toml::node& element : *array) {
    readers.emplace_back(*element.as_table(), file_, fmt::format("[{}]", inner), *problems_);
  }
  return readers;
}

double TomlReader::number_or(std::string_view key, double fallback, NumberRange range) {
  return number(key, range).value_or(fallback);
}

int TomlReader::whole_number_or(std::string_view key, int fallback, NumberRange range) {
  const double value = number(key, range).value_or(fallback);
  if (value == std::floor(value)) return static_cast<int>(value);
  problem_at(key, fmt::format("'{}' is {}; it must be a whole number", key, value));
  return fallback;
}

std::string TomlReader::text_or(std::string_view key, std::string fallback) {
  return text(key).value_or(std::move(fallback));
}

double TomlReader::required_number(std::string_view key, NumberRange range) {
  if (!has(key)) problem(fmt::format("'{}' is missing", key));
  return number(key, range).value_or(0.0);
}

std::string TomlReader::required_text(std::string_view key) {
  if (!has(key)) problem(fmt::format("'{}' is missing", key));
  const auto value = text(key);
  if (value && value->empty()) problem_at(key, fmt::format("'{}' is empty", key));
  return value.value_or("");
}

std::vector<std::string> TomlReader::keys() const {
  std::vector<std::string> names;
  for (const auto& [key, node] : *table_) names.emplace_back(key.str());
  return names;
}

std::string TomlReader::toml() const {
  std::ostringstream text;
  text << *table_;
  return text.str();
}

void TomlReader::finish() {
  const std::vector<std::string_view> known{asked_.begin(), asked_.end()};
  for (const auto& [key, node] : *table_) {
    if (std::ranges::find(asked_, key.str()) != asked_.end()) continue;
    const std::string_view nearest = nearest_name(key.str(), known);
    const std::string line = fmt::format("{}:{}: {}", file_, key.source().begin.line,
                                         where_.empty() ? "" : where_ + " ");
    add(line, nearest.empty()
                  ? fmt::format("unknown key '{}'", key.str())
                  : fmt::format("unknown key '{}'; did you mean '{}'?", key.str(), nearest));
  }
}

std::optional<std::chrono::minutes> parse_time_of_day(std::string_view text) {
  if (text.size() != 5 || text[2] != ':') return {};
  const auto number = [&](std::size_t at) {
    int value = -1;
    const auto read = std::from_chars(text.data() + at, text.data() + at + 2, value);
    return read.ptr == text.data() + at + 2 ? value : -1;
  };
  const int hour = number(0);
  const int minute = number(3);
  if (hour < 0 || hour > 23 || minute < 0 || minute > 59) return {};
  return std::chrono::hours{hour} + std::chrono::minutes{minute};
}

}  // namespace recald
