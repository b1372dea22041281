#include "simulators/toml/toml_table.hpp"

#include <fstream>
#include <sstream>

#include "core/text/nearest.hpp"

namespace recald::simulators {

void Complaint::about(const toml::node* node, const std::string& sentence) {
  if (!sentence_.empty()) return;
  sentence_ = node == nullptr
                  ? fmt::format("{}: {}", file_, sentence)
                  : fmt::format("{}:{}: {}", file_, node->source().begin.line, sentence);
}

std::string did_you_mean(std::string_view text, const Names& names) {
  const std::vector<std::string_view> known(names.begin(), names.end());
  const std::string_view meant = nearest_name(text, known);
  return meant.empty() ? "" : fmt::format(" (did you mean {}?)", meant);
}

Result<toml::table> read_toml(const std::filesystem::path& path, std::string_view what) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream || !std::filesystem::is_regular_file(path)) {
    return failure(ErrorCode::not_found,
                   fmt::format("cannot read the {} {}; check its path", what, path.string()));
  }
  std::ostringstream text;
  text << stream.rdbuf();
  try {
    return toml::parse(text.str());
  } catch (const toml::parse_error& error) {
    return failure(ErrorCode::malformed,
                   fmt::format("{}:{}: not TOML: {}", path.string(), error.source().begin.line,
                               error.description()));
  }
}

void TomlTable::number(std::string_view key, double least, double most, double& value) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const auto given = node->value<double>();
  if (!given || !node->is_number() || !(*given >= least && *given <= most)) {
    complaint_.about(
        node, fmt::format("{} in [{}] must be a number from {} to {}", key, name_, least, most));
    return;
  }
  value = *given;
}

void TomlTable::number(std::string_view key, double least, double most,
                       std::optional<double>& value) {
  if (find(key) == nullptr) return;
  double given = least;
  number(key, least, most, given);
  value = given;
}

void TomlTable::whole(std::string_view key, std::int64_t least, std::int64_t most,
                      std::int64_t& value) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  const auto given = node->value<std::int64_t>();
  if (!node->is_integer() || !given || *given < least || *given > most) {
    complaint_.about(node, fmt::format("{} in [{}] must be a whole number from {} to {}", key,
                                       name_, least, most));
    return;
  }
  value = *given;
}

void TomlTable::flag(std::string_view key, bool& value) {
  const toml::node* node = find(key);
  if (node == nullptr) return;
  if (!node->is_boolean()) {
    complaint_.about(node, fmt::format("{} in [{}] must be true or false", key, name_));
    return;
  }
  value = node->value_or(value);
}

std::string TomlTable::text(std::string_view key) {
  const toml::node* node = find(key);
  return node == nullptr ? "" : node->value_or(std::string());
}

std::optional<metering::Day> TomlTable::day(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto day = metering::parse_day(node->value_or(std::string_view()));
  if (!day) {
    complaint_.about(
        node, fmt::format("{} in [{}] must be a date in quotes, \"YYYY-MM-DD\"", key, name_));
    return std::nullopt;
  }
  return *day;
}

std::vector<double> TomlTable::one_or_numbers(std::string_view key, std::size_t count, double least,
                                              double most) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  std::vector<double> numbers;
  const auto add = [&](const toml::node& each) {
    const auto given = each.value<double>();
    if (given && each.is_number() && *given >= least && *given <= most) numbers.push_back(*given);
  };
  if (const toml::array* list = node->as_array()) {
    for (const toml::node& each : *list) add(each);
    if (list->size() == count && numbers.size() == count) return numbers;
  } else {
    add(*node);
    if (numbers.size() == 1) return numbers;
  }
  complaint_.about(node, fmt::format("{} in [{}] must be one number or {} of them, each from {} "
                                     "to {}",
                                     key, name_, count, least, most));
  return {};
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  const toml::array* list = node->as_array();
  if (list == nullptr || !list->is_array_of_tables()) {
    complaint_.about(node, fmt::format("{} must be a list: write [[{}]]", key, key));
    return {};
  }
  std::vector<TomlTable> all;
  for (const toml::node& entry : *list) all.emplace_back(entry.as_table(), key, complaint_);
  return all;
}

void TomlTable::no_other_keys() {
  if (table_ == nullptr) return;
  for (const auto& [key, node] : *table_) {
    if (asked_.contains(key.str())) continue;
    const std::string in = name_.empty() ? "" : fmt::format(" in [{}]", name_);
    complaint_.about(
        &node, fmt::format("unknown key {}{}{}", key.str(), in, did_you_mean(key.str(), asked_)));
  }
}

const toml::node* TomlTable::find(std::string_view key) {
  asked_.emplace(key);
  return table_ == nullptr ? nullptr : table_->get(key);
}

}  // namespace recald::simulators
