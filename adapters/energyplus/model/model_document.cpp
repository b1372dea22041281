#include "adapters/energyplus/model/model_document.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>

#include "adapters/system/files/regular_file.hpp"
#include "core/text/ascii.hpp"
#include "core/text/nearest.hpp"

namespace recald::energyplus {
namespace {

constexpr std::size_t kNamesShown = 8;
constexpr double kLeastDivisor = 1e-9;  // nobody is a very large area per person

/// Whether a text is what a pattern with '*' and '?' describes, whatever the case.
bool matches(std::string_view text, std::string_view pattern) {
  std::size_t t = 0;
  std::size_t p = 0;
  std::optional<std::size_t> star;  // the last one, to go back to
  std::size_t after_star = 0;
  while (t < text.size()) {
    if (p < pattern.size() && (pattern[p] == '?' || to_lower(pattern[p]) == to_lower(text[t]))) {
      ++t;
      ++p;
    } else if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      after_star = t;
    } else if (star) {
      p = *star + 1;
      t = ++after_star;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

std::vector<std::string> parts_of(std::string_view pattern) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= pattern.size();) {
    const std::size_t end = std::min(pattern.find('/', begin), pattern.size());
    parts.emplace_back(pattern.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

/// The keys of an object, or the places of a list.
std::vector<std::string> keys_of(const Json& node) {
  std::vector<std::string> keys;
  if (node.is_array()) {
    for (std::size_t i = 0; i < node.size(); ++i) keys.push_back(std::to_string(i));
  } else if (node.is_object()) {
    for (const auto& [key, value] : node.items()) keys.push_back(key);
  }
  return keys;
}

std::string names_text(const std::vector<std::string>& names) {
  const std::size_t shown = std::min(names.size(), kNamesShown);
  std::string text = fmt::format("{}", fmt::join(std::span{names}.first(shown), ", "));
  if (names.size() > shown) text += fmt::format(" and {} more", names.size() - shown);
  return text;
}

/// "; did you mean 'Lights'?", or all names that there are.
std::string advice(std::string_view part, const std::vector<std::string>& names) {
  const std::vector<std::string_view> views{names.begin(), names.end()};
  if (const std::string_view nearest = nearest_name(part, views); !nearest.empty()) {
    return fmt::format("; did you mean '{}'?", nearest);
  }
  return names.empty() ? "" : fmt::format("; there are {}", names_text(names));
}

/// Follows the parts of a pattern through a document.
class Search {
 public:
  explicit Search(std::vector<std::string> parts) : parts_{std::move(parts)} {}

  void run(const Json& objects) { follow(objects, Json::json_pointer{}, 0); }

  [[nodiscard]] const std::vector<Json::json_pointer>& found() const { return found_; }

  /// How many parts of the pattern something matches, and the names at the first that nothing does.
  [[nodiscard]] std::size_t depth() const { return depth_; }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

 private:
  void follow(const Json& node, const Json::json_pointer& here, std::size_t depth) {
    if (depth == parts_.size()) {
      found_.push_back(here);
      return;
    }
    const std::vector<std::string> keys = keys_of(node);
    if (depth > depth_) {
      depth_ = depth;
      names_.clear();
    }
    if (depth == depth_) {
      for (const std::string& key : keys) {
        if (std::ranges::find(names_, key) == names_.end()) names_.push_back(key);
      }
    }
    for (const std::string& key : keys) {
      if (!matches(key, parts_[depth])) continue;
      if (node.is_array()) {
        const std::size_t index = std::stoul(key);
        follow(node[index], here / index, depth + 1);
      } else {
        follow(node.at(key), here / key, depth + 1);
      }
    }
  }

  std::vector<std::string> parts_;
  std::vector<Json::json_pointer> found_;
  std::size_t depth_ = 0;
  std::vector<std::string> names_;
};

}  // namespace

Result<ModelDocument> read_epjson(const std::filesystem::path& file) {
  TRY(system::require_file(file, "EnergyPlus model"));
  std::ifstream in{file, std::ios::binary};
  const std::string text{std::istreambuf_iterator<char>{in}, {}};
  if (in.bad()) return failure(ErrorCode::io_failed, fmt::format("cannot read {}", file.string()));
  return parse_epjson(text, file.string());
}

Result<ModelDocument> parse_epjson(std::string_view text, std::string_view name) {
  ModelDocument model{Json::parse(text, nullptr, /*allow_exceptions=*/false), ""};
  if (!model.objects.is_object()) {
    return failure(
        ErrorCode::malformed,
        fmt::format("{} is not epJSON; EnergyPlus's ConvertInputFormat makes it from IDF", name));
  }
  const auto version = model.objects.find("Version");
  if (version != model.objects.end() && version->is_object() && !version->empty()) {
    model.version = version->front().value("version_identifier", "");
  }
  if (model.version.empty()) {
    return failure(ErrorCode::malformed,
                   fmt::format("{} has no Version object, so it is no model of EnergyPlus", name));
  }
  return model;
}

Result<Target> find_target(const ModelDocument& model, std::string_view pattern) {
  const std::vector<std::string> parts = parts_of(pattern);
  if (parts.size() < 3 || std::ranges::any_of(parts, &std::string::empty)) {
    return failure(ErrorCode::malformed,
                   fmt::format("target '{}' must have the form Type/Object/field, such as "
                               "Lights/*/watts_per_floor_area",
                               pattern));
  }
  Search search{parts};
  search.run(model.objects);
  if (search.found().empty()) {
    const std::size_t depth = search.depth();
    const std::string what = depth == 0   ? "has no object of type"
                             : depth == 1 ? fmt::format("has no {} called", parts[0])
                                          : fmt::format("has no field of {} called", parts[0]);
    return failure(ErrorCode::not_found,
                   fmt::format("target '{}': the model {} '{}'{}", pattern, what, parts[depth],
                               advice(parts[depth], search.names())));
  }
  Target target{std::string{pattern}, search.found()};
  // A Schedule:Compact has its times and its numbers in one list; "data/*/field" means the numbers.
  const auto is_number = [&](const Json::json_pointer& f) {
    return model.objects.at(f).is_number();
  };
  if (std::ranges::any_of(target.fields, is_number)) {
    std::erase_if(target.fields, [&](const Json::json_pointer& field) {
      const auto list = field.parent_pointer().parent_pointer();
      return !is_number(field) && model.objects.at(list).is_array();
    });
  }
  for (const Json::json_pointer& field : target.fields) {
    const Json& value = model.objects.at(field);
    if (value.is_number()) continue;
    return failure(ErrorCode::invalid_value,
                   fmt::format("target '{}': {} is {}, not a number{}", pattern, field.to_string(),
                               value.dump(),
                               value.is_string() ? "; write the number that it stands for" : ""));
  }
  return target;
}

std::vector<Json::json_pointer> find_fields(const Json& objects, std::string_view pattern) {
  Search search{parts_of(pattern)};
  search.run(objects);
  return search.found();
}

void apply(const Target& target, ChangeKind change, double value, Json& objects) {
  const auto changed = [&](double before) {
    switch (change) {
      case ChangeKind::set:
        return value;
      case ChangeKind::scale:
        return before * value;
      case ChangeKind::add:
        break;
    }
    return before + value;
  };
  for (const Json::json_pointer& field : target.fields) {
    Json& node = objects.at(field);
    const double before = node.get<double>();
    double after = 0.0;
    switch (target.sense) {
      case Sense::direct:
        after = changed(before);
        break;
      case Sense::reciprocal:
        after = 1.0 / std::max(changed(1.0 / std::max(before, kLeastDivisor)), kLeastDivisor);
        break;
      case Sense::complement:
        after = 1.0 - changed(1.0 - before);
        break;
    }
    node = std::min(after, target.most);
  }
}

}  // namespace recald::energyplus
