#include "adapters/models/version_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>

#include "adapters/shapes/strict_json.hpp"
#include "adapters/system/files/sha256.hpp"

SHAPE(recald::diagnosis::EffectParameterRecord, name, unit, prior, mean, sd, q05, q50, q95, draws);
SHAPE(recald::diagnosis::MeterImpact, meter, monthly_kWh);
SHAPE(recald::diagnosis::Rival, effect, probability);
SHAPE(recald::diagnosis::AddedEffect, effect, title, meter, from, to, physics, parameters,
      log_evidence_gain, probability, rivals, impacts, months_used);
SHAPE(recald::diagnosis::ModelVersion, version, parent, (site_id, "site"), created_at, author,
      status, data_revision, catalogue_version, effects);

namespace recald::shapes {

using diagnosis::VersionAuthor;
using diagnosis::VersionStatus;

template <>
inline diagnosis::EffectParameterRecord blank() {
  return {.prior = UniformPrior{0.0, 1.0}};
}

template <>
struct Form<VersionAuthor> : Named<VersionAuthor, VersionAuthor::automatic, VersionAuthor::human> {
};
template <>
struct Form<VersionStatus> : Named<VersionStatus, VersionStatus::proposed, VersionStatus::accepted,
                                   VersionStatus::retired, VersionStatus::reverted> {};

/// JSON has no infinity: an absent bound means no bound, as in `Prior::named`.
template <>
struct Form<Prior> {
  static Json json_of(const Prior& prior) {
    const PriorNumbers numbers = prior.numbers();
    Json json = {{"distribution", prior.name()}};
    const auto put = [&](const char* key, const std::optional<double>& value) {
      if (value && std::isfinite(*value)) json[key] = *value;
    };
    put("min", numbers.min);
    put("mode", numbers.mode);
    put("max", numbers.max);
    put("sd", numbers.sd);
    return json;
  }
  static Prior read(StrictReader& reader, const Parsed& json, const char* key) {
    const auto number = [&](const char* name) -> std::optional<double> {
      if (!json.contains(name)) return {};
      return reader.member<double>(json, name);
    };
    const auto prior = Prior::named(reader.member<std::string>(json, "distribution"),
                                    {number("min"), number("mode"), number("max"), number("sd")});
    if (prior) return *prior;
    reader.refuse(key, prior.error().message);
    return UniformPrior{0.0, 1.0};
  }
};

}  // namespace recald::shapes

namespace recald::models {
namespace {

using diagnosis::AddedEffect;
using diagnosis::EffectParameterRecord;
using diagnosis::MeterImpact;
using diagnosis::ModelVersion;
using diagnosis::Rival;
using Json = nlohmann::json;

/// With its keys in alphabetical order, as what it is named by was made from the beginning.
Json to_json(const ModelVersion& version) { return shapes::json_of(version); }

std::string content_hash(Json json) {
  for (const char* key : {"version", "status", "created_at"}) json.erase(key);
  system::Sha256 digest;
  digest.add(json.dump());
  return digest.hex();
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
  if (content_hash(json) != file.stem()) return damaged("its content does not match its name");
  shapes::StrictReader reader{"the version"};
  const auto version = reader.result(reader.read<ModelVersion>(json, "version"));
  if (!version) return damaged(version.error().message);
  for (const AddedEffect& added : version->effects) {
    const auto checked = check_numbers(added);
    if (!checked) return damaged(checked.error().message);
  }
  if (version->version != file.stem()) return damaged("it names another version than its file");
  return version;
}

}  // namespace recald::models
