#include "adapters/models/version_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <stdexcept>
#include <variant>

#include "adapters/system/sha256.hpp"

namespace recald::models {
namespace {

using diagnosis::AddedEffect;
using diagnosis::EffectParameterRecord;
using diagnosis::MeterImpact;
using diagnosis::ModelVersion;
using diagnosis::Rival;
using Json = nlohmann::json;

struct NumbersOf {
  PriorNumbers operator()(const TriangularPrior& p) const { return {p.min, p.mode, p.max, {}}; }
  PriorNumbers operator()(const UniformPrior& p) const { return {p.min, {}, p.max, {}}; }
  PriorNumbers operator()(const TruncatedNormalPrior& p) const {
    return {p.min, p.location, p.max, p.sd};
  }
  PriorNumbers operator()(const LogNormalPrior& p) const {
    return {p.min, p.median, p.max, p.log_sd};
  }
};

Json prior_json(const Prior& prior) {
  const PriorNumbers numbers = std::visit(NumbersOf{}, prior.distribution());
  Json json = {{"distribution", prior.name()}};
  // JSON has no infinity: an absent bound means no bound, as in `Prior::named`.
  const auto put = [&](const char* key, const std::optional<double>& value) {
    if (value && std::isfinite(*value)) json[key] = *value;
  };
  put("min", numbers.min);
  put("mode", numbers.mode);
  put("max", numbers.max);
  put("sd", numbers.sd);
  return json;
}

Json parameter_json(const EffectParameterRecord& p) {
  return {{"name", p.name}, {"unit", p.unit}, {"prior", prior_json(p.prior)},
          {"mean", p.mean}, {"sd", p.sd},     {"q05", p.q05},
          {"q50", p.q50},   {"q95", p.q95},   {"draws", p.draws}};
}

Json day_json(const std::optional<metering::Day>& day) {
  return day ? Json(metering::to_string(*day)) : Json(nullptr);
}

Json effect_json(const AddedEffect& added) {
  Json json = {{"effect", added.effect},
               {"title", added.title},
               {"meter", added.meter},
               {"from", day_json(added.from)},
               {"to", day_json(added.to)},
               {"physics", added.physics},
               {"log_evidence_gain", added.log_evidence_gain},
               {"probability", added.probability}};
  json["parameters"] = Json::array();
  for (const auto& p : added.parameters) json["parameters"].push_back(parameter_json(p));
  json["rivals"] = Json::array();
  for (const Rival& rival : added.rivals) {
    json["rivals"].push_back({{"effect", rival.effect}, {"probability", rival.probability}});
  }
  json["impacts"] = Json::array();
  for (const MeterImpact& impact : added.impacts) {
    json["impacts"].push_back({{"meter", impact.meter}, {"monthly_kWh", impact.monthly_kWh}});
  }
  json["months_used"] = Json::array();
  for (const auto month : added.months_used) {
    json["months_used"].push_back(metering::to_string(month));
  }
  return json;
}

Json to_json(const ModelVersion& version) {
  Json json = {{"version", version.version},
               {"parent", version.parent},
               {"site", version.site_id},
               {"created_at", version.created_at},
               {"author", to_string(version.author)},
               {"status", to_string(version.status)},
               {"data_revision", version.data_revision},
               {"catalogue_version", version.catalogue_version},
               {"effects", Json::array()}};
  for (const AddedEffect& added : version.effects) json["effects"].push_back(effect_json(added));
  return json;
}

std::string content_hash(Json json) {
  for (const char* key : {"version", "status", "created_at"}) json.erase(key);
  system::Sha256 digest;
  digest.add(json.dump());
  return digest.hex();
}

// The readers below throw, and `read_version_file` turns it into a sentence: nlohmann's exceptions
// for a field that is absent or of another type, `Senseless` for a value that makes no sense.
struct Senseless : std::runtime_error {
  using std::runtime_error::runtime_error;
};

template <class T>
T sensible(Result<T> result) {
  if (!result) throw Senseless(result.error().message);
  return std::move(*result);
}

/// Index of the text among the words of an enumeration.
template <class Enum>
Enum word(const Json& json, const char* key, std::span<const std::string_view> words) {
  const auto text = json.at(key).get<std::string>();
  const auto found = std::ranges::find(words, text);
  if (found == words.end()) {
    throw Senseless(fmt::format("{} '{}' is none of {}", key, text, fmt::join(words, ", ")));
  }
  return static_cast<Enum>(found - words.begin());
}

Prior read_prior(const Json& json) {
  const auto number = [&](const char* key) -> std::optional<double> {
    if (!json.contains(key)) return {};
    return json.at(key).get<double>();
  };
  const PriorNumbers numbers{number("min"), number("mode"), number("max"), number("sd")};
  return sensible(Prior::named(json.at("distribution").get<std::string>(), numbers));
}

EffectParameterRecord read_parameter(const Json& json) {
  const auto number = [&](const char* key) { return json.at(key).get<double>(); };
  return {.name = json.at("name"),
          .unit = json.at("unit"),
          .prior = read_prior(json.at("prior")),
          .mean = number("mean"),
          .sd = number("sd"),
          .q05 = number("q05"),
          .q50 = number("q50"),
          .q95 = number("q95"),
          .draws = json.at("draws").get<std::vector<double>>()};
}

std::optional<metering::Day> read_day(const Json& json) {
  if (json.is_null()) return {};
  return sensible(metering::parse_day(json.get<std::string>()));
}

AddedEffect read_effect(const Json& json) {
  AddedEffect added{.effect = json.at("effect"),
                    .title = json.at("title"),
                    .meter = json.at("meter"),
                    .from = read_day(json.at("from")),
                    .to = read_day(json.at("to")),
                    .physics = json.at("physics"),
                    .parameters = {},
                    .log_evidence_gain = json.at("log_evidence_gain").get<double>(),
                    .probability = json.at("probability").get<double>()};
  for (const Json& p : json.at("parameters")) added.parameters.push_back(read_parameter(p));
  for (const Json& rival : json.at("rivals")) {
    added.rivals.push_back({rival.at("effect"), rival.at("probability").get<double>()});
  }
  for (const Json& impact : json.at("impacts")) {
    added.impacts.push_back({impact.at("meter"), impact.at("monthly_kWh").get<double>()});
  }
  for (const Json& month : json.at("months_used")) {
    added.months_used.push_back(sensible(metering::parse_month(month.get<std::string>())));
  }
  return added;
}

ModelVersion read_version(const Json& json) {
  ModelVersion version;
  version.version = json.at("version");
  version.parent = json.at("parent");
  version.site_id = json.at("site");
  version.created_at = json.at("created_at");
  version.author = word<diagnosis::VersionAuthor>(json, "author", diagnosis::kVersionAuthors);
  version.status = word<diagnosis::VersionStatus>(json, "status", diagnosis::kVersionStatuses);
  version.data_revision = json.at("data_revision");
  version.catalogue_version = json.at("catalogue_version");
  for (const Json& effect : json.at("effects")) version.effects.push_back(read_effect(effect));
  return version;
}

bool all_finite(const EffectParameterRecord& p) {
  const auto finite = [](double value) { return std::isfinite(value); };
  return std::ranges::all_of(std::array{p.mean, p.sd, p.q05, p.q50, p.q95}, finite) &&
         std::ranges::all_of(p.draws, finite);
}

Result<void> check_numbers(const AddedEffect& added) {
  bool finite = std::isfinite(added.log_evidence_gain) && std::isfinite(added.probability);
  for (const Rival& rival : added.rivals) finite = finite && std::isfinite(rival.probability);
  for (const MeterImpact& impact : added.impacts) {
    finite = finite && std::isfinite(impact.monthly_kWh);
  }
  for (const auto& p : added.parameters) {
    finite = finite && all_finite(p);
    if (p.draws.size() == added.parameters.front().draws.size()) continue;
    return failure(ErrorCode::invalid_value,
                   fmt::format("effect {}: parameter {} has {} draws where {} has {}", added.effect,
                               p.name, p.draws.size(), added.parameters.front().name,
                               added.parameters.front().draws.size()));
  }
  if (finite) return {};
  return failure(ErrorCode::not_finite,
                 fmt::format("effect {}: one of its numbers is not finite", added.effect));
}

}  // namespace

Result<ModelVersion> named_by_content(ModelVersion version) {
  for (const AddedEffect& added : version.effects) {
    TRY(check_numbers(added));
  }
  try {
    version.version = content_hash(to_json(version));
  } catch (const Json::exception&) {
    return failure(ErrorCode::invalid_value, "a text of the model version is not UTF-8");
  }
  return version;
}

std::string version_json(const ModelVersion& version) { return to_json(version).dump(2) + "\n"; }

Result<ModelVersion> read_version_file(const std::filesystem::path& file) {
  const auto damaged = [&](const std::string& why) {
    return failure(ErrorCode::malformed, fmt::format("'{}' is damaged: {}", file.string(), why));
  };
  std::ifstream in{file, std::ios::binary};
  if (!in) {
    return failure(ErrorCode::not_found, fmt::format("cannot open '{}'", file.string()));
  }
  std::ostringstream text;
  text << in.rdbuf();
  const Json json = Json::parse(text.str(), nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return damaged("it is no JSON object, or ends too early");
  try {
    if (content_hash(json) != file.stem()) return damaged("its content does not match its name");
    ModelVersion version = read_version(json);
    if (version.version != file.stem()) return damaged("it names another version than its file");
    return version;
  } catch (const Senseless& error) {
    return damaged(error.what());
  } catch (const Json::exception& error) {
    return damaged(error.what());
  }
}

}  // namespace recald::models
