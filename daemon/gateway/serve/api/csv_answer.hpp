/// Lists of the API as CSV.
#pragma once

#include <span>

#include "daemon/gateway/serve/api/parameters.hpp"

namespace recald::daemon {

/// A column of a list, and where its entries have it.
struct CsvColumn {
  const char* name;
  const char* pointer;  ///< RFC 6901: "/peak/start"
};

inline constexpr CsvColumn kIntervalColumns[] = {
    {"start", "/start"},     {"mean_kW", "/mean_kW"},   {"energy_kWh", "/energy_kWh"},
    {"mean", "/mean"},       {"validity", "/validity"}, {"late", "/late"},
    {"reasons", "/reasons"}, {"revision", "/revision"}};
inline constexpr CsvColumn kHistoryColumns[] = {{"start", "/start"},
                                                {"least", "/least"},
                                                {"mean", "/mean"},
                                                {"most", "/most"},
                                                {"valid_share", "/valid_share"}};
inline constexpr CsvColumn kMonthColumns[] = {
    {"meter", "/meter"},
    {"month", "/month"},
    {"daily_average_kWh", "/daily_average_kWh"},
    {"daily_average_variance_kWh2", "/daily_average_variance_kWh2"},
    {"peak_kW", "/peak/peak_kW"},
    {"peak_start", "/peak/start"},
    {"peak_window_s", "/peak/window_s"},
    {"peak_could_be_exceeded", "/peak/could_be_exceeded"},
    {"coverage", "/coverage"},
    {"filled_share", "/filled_share"},
    {"usable", "/usable"},
    {"unusable_because", "/unusable_because"},
    {"reasons", "/reasons"},
    {"revision", "/revision"}};
inline constexpr CsvColumn kEventColumns[] = {{"time", "/time"},          {"severity", "/severity"},
                                              {"kind", "/kind"},          {"subject", "/subject"},
                                              {"text", "/text"},          {"count", "/count"},
                                              {"last_time", "/last_time"}};
inline constexpr CsvColumn kForecastColumns[] = {{"output", "/output"},
                                                 {"month", "/month"},
                                                 {"revision", "/revision"},
                                                 {"model_version", "/model_version"},
                                                 {"data_revision", "/data_revision"},
                                                 {"made", "/made"},
                                                 {"mean", "/mean"},
                                                 {"sd", "/sd"},
                                                 {"q05", "/q05"},
                                                 {"q50", "/q50"},
                                                 {"q95", "/q95"},
                                                 {"measured", "/measured"},
                                                 {"pit", "/pit"},
                                                 {"standardised", "/standardised"},
                                                 {"log_score", "/log_score"},
                                                 {"crps", "/crps"}};

/// Whether a list is asked for as CSV: by `format=csv`, or by an Accept header that names text/csv
/// before JSON. @return or the response that refuses another format.
[[nodiscard]] Checked<bool> wants_csv(const http::Request& request);

/// The list of a JSON response (the first of its members that is one), an entry a line (RFC 4180,
/// lines end with CR LF). What is unknown is empty; lists are joined by "|". If there are more
/// entries, a Link header has the address of the next.
/// @param request  As it was sent. @param json  A 200 of a list with `next`.
[[nodiscard]] http::Response as_csv(const http::Request& request, const http::Response& json,
                                    std::span<const CsvColumn> columns);

}  // namespace recald::daemon
