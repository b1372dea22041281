/// What a result says of its making: data, versions, weather, how it was sampled.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "adapters/results/run_facts.hpp"
#include "adapters/views/frame/report_data.hpp"

namespace recald::views {

/// Data and versions alone. Without the computing time: the same data and seed give the same page.
[[nodiscard]] Provenance provenance_of(const RunFacts& facts);

/// With the seed and the sampling, where draws were made.
[[nodiscard]] Provenance sampled_provenance_of(const RunFacts& facts);

void add_provenance(const RunFacts& facts, nlohmann::ordered_json& json);

}  // namespace recald::views
