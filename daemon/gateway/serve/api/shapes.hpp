/// Values as JSON: snake_case, units in names, times in ISO 8601 with Z, null for unknown values.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "adapters/ports/store.hpp"
#include "daemon/gateway/ingest/gateway_status.hpp"
#include "daemon/gateway/serve/api/history.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

[[nodiscard]] std::string_view name_of(UnitState state);    ///< "up", "degraded", "down"
[[nodiscard]] std::string_view name_of(Severity severity);  ///< "info", "warning", "error"

/// @param status  Null for a recorded meter.
[[nodiscard]] nlohmann::ordered_json meter_json(const MeterConfig& config,
                                                const MeterStatus* status);

/// One object as text. Written by hand for speed: a response may have ten thousand.
[[nodiscard]] std::string interval_json(const StoredInterval& interval,
                                        std::chrono::seconds length);
/// As above for a quantity of a weather sensor, which has a mean in its own unit and no energy.
[[nodiscard]] std::string weather_interval_json(const StoredInterval& interval);

/// One object as text, as above. Values are in kW, or in the unit of a weather sensor's quantity.
[[nodiscard]] std::string history_point_json(const HistoryPoint& point);

[[nodiscard]] nlohmann::ordered_json month_json(const std::string& meter,
                                                const metering::MonthlyFigure& figure);
[[nodiscard]] nlohmann::ordered_json event_json(const StoreEvent& event);
/// The job without its result.
[[nodiscard]] nlohmann::ordered_json job_json(const StoredJob& job);

}  // namespace recald::daemon
