/// Job results as JSON: the one place that writes and reads what a document says of drift.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "adapters/ports/job_result.hpp"

namespace recald::results {

/// JSON has no NaN: what nobody knows is null.
[[nodiscard]] nlohmann::ordered_json number(double value);

/// An array each, keys in the order that people read them.
[[nodiscard]] nlohmann::ordered_json outputs_json(const DriftSummary& drift);
[[nodiscard]] nlohmann::ordered_json alarms_json(const DriftSummary& drift);
[[nodiscard]] nlohmann::ordered_json changed_meters_json(const DriftSummary& drift);

[[nodiscard]] nlohmann::ordered_json weather_json(const std::vector<MonthWeather>& months);

/// A result from its document, as a store keeps it. What the document does not say, or says in
/// another type, is absent.
[[nodiscard]] JobResult read_job_result(std::string document);

}  // namespace recald::results
