#include "adapters/views/frame/provenance.hpp"

#include <nlohmann/json.hpp>

#include "adapters/results/job_result_json.hpp"

namespace recald::views {

Provenance provenance_of(const RunFacts& facts) {
  return {.recald_version = facts.recald_version,
          .data_revision = facts.data_revision,
          .model_version = facts.model_version,
          .time_zone_data = facts.time_zone_data,
          .weather_values = facts.weather_values};
}

Provenance sampled_provenance_of(const RunFacts& facts) {
  Provenance from = provenance_of(facts);
  from.sampler = facts.sampler;
  from.hyper_prior_profile = facts.hyper_prior_profile;
  from.seed = facts.seed;
  from.iterations = facts.iterations;
  from.burn_in = facts.burn_in;
  from.chains = facts.chains;
  return from;
}

void add_provenance(const RunFacts& facts, nlohmann::ordered_json& json) {
  json["data_revision"] = facts.data_revision;
  json["model_version"] = facts.model_version;
  json["recald_version"] = facts.recald_version;
  json["tzdata"] = facts.time_zone_data;
  json["weather_values"] = facts.weather_values;
  json["weather"] = results::weather_json(facts.weather);
  json["weather_assumed"] = facts.weather_assumed;
  json["wall_s"] = facts.wall_s;
}

}  // namespace recald::views
