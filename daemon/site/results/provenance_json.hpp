/// What every result says of its making: data, versions, weather, time taken.
#pragma once

#include <nlohmann/json.hpp>

#include "adapters/results/job_result_json.hpp"
#include "daemon/site/model/run_facts.hpp"

namespace recald::daemon {

inline void add_provenance(const RunFacts& facts, nlohmann::ordered_json& json) {
  json["data_revision"] = facts.data_revision;
  json["model_version"] = facts.model_version;
  json["recald_version"] = facts.recald_version;
  json["tzdata"] = facts.time_zone_data;
  json["weather_values"] = facts.weather_values;
  json["weather"] = results::weather_json(facts.weather);
  json["weather_assumed"] = facts.weather_assumed;
  json["wall_s"] = facts.wall_s;
}

}  // namespace recald::daemon
