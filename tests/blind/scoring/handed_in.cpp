#include "tests/blind/scoring/handed_in.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "adapters/system/write_file.hpp"
#include "tests/blind/scoring/files.hpp"
#include "tests/blind/scoring/json_fields.hpp"

namespace recald::blind {
namespace {

using Json = nlohmann::ordered_json;

Json effect_json(const std::string& name, JsonFields& fields, const EffectClasses& catalogue) {
  const auto found = catalogue.find(name);
  Json effect{{"effect", name},
              {"class", found == catalogue.end() ? "outside_catalogue" : found->second},
              {"in_catalogue", found != catalogue.end()},
              {"strength", fields.number("strength")},
              {"unit", fields.text("unit")},
              {"from", nullptr},
              {"to", nullptr},
              {"share_of_meter", Json::object()}};
  for (const char* day : {"from", "to"}) {
    if (fields.has(day)) effect[day] = fields.text(day);
  }
  for (const char* shares : {"share_of_meter", "moved_share"}) {
    if (fields.has(shares)) effect[shares] = fields.numbers(shares);
  }
  return effect;
}

std::string_view block_of(const Json& effects) {
  const auto known = std::ranges::count_if(
      effects, [](const Json& effect) { return effect["in_catalogue"].get<bool>(); });
  if (effects.empty()) return "no_effect";
  if (known == 0) return "out_of_catalogue";
  return effects.size() == 1 ? "single" : "pair";
}

}  // namespace

Result<std::size_t> write_handed_in(const std::filesystem::path& truth, const std::string& world,
                                    const EffectClasses& catalogue,
                                    const std::filesystem::path& answers) {
  const auto text = read_file(truth);
  if (!text) return tl::unexpected(text.error());
  const auto parsed = parse_json(*text, truth.string());
  if (!parsed) return tl::unexpected(parsed.error());
  if (!parsed->is_object() || parsed->empty()) {
    return failure(ErrorCode::malformed, truth.string() + " names no case");
  }
  if (const auto made = system::make_folder(answers); !made) return tl::unexpected(made.error());
  for (const auto& [name, value] : parsed->items()) {
    JsonFields fields(value, fmt::format("{}, case {}", truth.string(), name));
    Json effects = Json::array();
    fields.each("effects", [&](const std::string& effect, JsonFields& of) {
      effects.push_back(effect_json(effect, of, catalogue));
    });
    const std::string climate = fields.name("weather");
    const std::string use = fields.name("archetype");
    if (fields.error()) return tl::unexpected(*fields.error());
    const Json answer{{"case", name},
                      {"world", world},
                      {"block", block_of(effects)},
                      {"effects", effects},
                      {"decoys", Json::array()},
                      {"climate", climate},
                      {"use", use},
                      {"gaps", false},
                      {"true_parameters", Json::object()},
                      {"prior_sd", Json::object()}};
    // What the scorer would not read is not written.
    if (const auto read = parse_answer(answer.dump(), name); !read) {
      return tl::unexpected(read.error());
    }
    const auto written = system::write_file(answers / (name + ".json"), answer.dump(1) + "\n");
    if (!written) return tl::unexpected(written.error());
  }
  return parsed->size();
}

}  // namespace recald::blind
