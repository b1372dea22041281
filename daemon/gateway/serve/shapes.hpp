/// How values look in JSON: snake_case, units in names, times ISO 8601 with Z, null for what is not
/// known.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "adapters/ports/store.hpp"
#include "daemon/gateway/ingest/gateway_status.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

[[nodiscard]] std::string_view name_of(UnitState state);    ///< "up", "degraded", "down"
[[nodiscard]] std::string_view name_of(Severity severity);  ///< "info", "warning", "error"

/// @param status  Null for a recorded meter.
[[nodiscard]] nlohmann::ordered_json meter_json(const MeterConfig& config,
                                                const MeterStatus* status);

/// One object as text. Written by hand: ten thousand of them are one answer.
[[nodiscard]] std::string interval_json(const StoredInterval& interval,
                                        std::chrono::seconds length);
/// The same of a quantity of a weather sensor, which has a mean in its own unit and no energy.
[[nodiscard]] std::string weather_interval_json(const StoredInterval& interval);

[[nodiscard]] nlohmann::ordered_json month_json(const std::string& meter,
                                                const metering::MonthlyFigure& figure);
[[nodiscard]] nlohmann::ordered_json event_json(const StoreEvent& event);
/// Without its result.
[[nodiscard]] nlohmann::ordered_json job_json(const StoredJob& job);

}  // namespace recald::daemon
