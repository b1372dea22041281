#include "daemon/site/calibrate/design_origin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "adapters/system/files/write_file.hpp"
#include "daemon/site/model/active_effects.hpp"

namespace recald::daemon {
namespace {

using diagnosis::AddedEffect;
using Json = nlohmann::ordered_json;

constexpr const char* kSiteFile = "site.json";

struct Note {
  std::filesystem::path site;
  std::vector<std::string> effects;
};

Result<Note> read_note(const std::filesystem::path& file) {
  std::ifstream stream{file};
  const Json json = Json::parse(stream, nullptr, false);
  const bool fits = json.is_object() && json.contains("site") && json["site"].is_string() &&
                    json.contains("effects") && json["effects"].is_array() &&
                    std::ranges::all_of(json["effects"], &Json::is_string);
  if (!fits) {
    return failure(ErrorCode::malformed,
                   fmt::format("'{}' is damaged: it should say the site file and its effects; run "
                               "`recald doe` again",
                               file.string()));
  }
  return Note{json["site"].get<std::string>(), json["effects"].get<std::vector<std::string>>()};
}

std::vector<std::string> parameter_names(const std::vector<AddedEffect>& effects) {
  std::vector<std::string> names;
  for (const AddedEffect& effect : effects) {
    for (const auto& parameter : effect.parameters) {
      names.push_back(effect_parameter_name(effect, parameter));
    }
  }
  return names;
}

bool teaches(const AddedEffect& effect, const doe::DesignFolder& design) {
  return std::ranges::all_of(design.months, [&](const doe::DesignMonth& month) {
    const auto calendar_month = metering::parse_month(month.text());
    return calendar_month && may_learn_from(effect, *calendar_month);
  });
}

}  // namespace

Result<void> note_site(const std::filesystem::path& folder, const std::filesystem::path& site_file,
                       const std::vector<AddedEffect>& effects) {
  std::error_code ignored;
  const auto from_folder = std::filesystem::proximate(site_file, folder, ignored);
  const Json json = {{"site", (from_folder.empty() ? site_file : from_folder).generic_string()},
                     {"effects", parameter_names(effects)}};
  return system::write_file(folder / kSiteFile, json.dump(2) + "\n");
}

Result<DesignOrigin> check_origin(const doe::DesignFolder& design) {
  const std::filesystem::path file = design.folder / kSiteFile;
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return DesignOrigin{};
  const auto note = TRY(read_note(file));
  const std::filesystem::path site_file = (design.folder / note.site).lexically_normal();
  const auto site = load_site(site_file);
  if (!site) {
    return DesignOrigin{note.effects,
                        {fmt::format("The design's site file '{}' cannot be read, so nobody knows "
                                     "whether its model has effects that the design lacks.",
                                     site_file.string())},
                        site_file};
  }
  const auto effects = TRY(active_effects(*site));
  TRY(require_in_design(effects, design.parameters));
  const auto in_force = parameter_names(effects);
  for (const std::string& name : note.effects) {
    if (std::ranges::find(in_force, name) != in_force.end()) continue;
    return failure(ErrorCode::unsupported,
                   fmt::format("metamodel: the design varies {}, of an effect that the model no "
                               "longer has; run `recald doe` without it.",
                               name));
  }
  DesignOrigin result;
  result.site_file = site_file;
  for (const AddedEffect& effect : effects) {
    if (teaches(effect, design)) continue;
    const auto names = parameter_names({effect});
    result.held.insert(result.held.end(), names.begin(), names.end());
    result.notes.push_back(
        fmt::format("The effect '{}' was learnt from months of the design, so its parameters are "
                    "held at what was learnt, and what is not known of them counts as error.",
                    effect.title));
  }
  return result;
}

}  // namespace recald::daemon
