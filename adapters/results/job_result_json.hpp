/// Job results as JSON. Only this file writes and reads the drift part of a document.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "adapters/ports/job_result.hpp"

namespace recald::results {

/// JSON has no NaN, so an unknown value is null.
[[nodiscard]] nlohmann::ordered_json number(double value);

/// One array each, with keys in the order in which people read them.
[[nodiscard]] nlohmann::ordered_json outputs_json(const DriftSummary& drift);
[[nodiscard]] nlohmann::ordered_json alarms_json(const DriftSummary& drift);
[[nodiscard]] nlohmann::ordered_json changed_meters_json(const DriftSummary& drift);

[[nodiscard]] nlohmann::ordered_json weather_json(const std::vector<MonthWeather>& months);

/// Reads a result from its document, as a store keeps it. Values that are missing or of another
/// type are absent.
[[nodiscard]] JobResult read_job_result(std::string document);

}  // namespace recald::results
