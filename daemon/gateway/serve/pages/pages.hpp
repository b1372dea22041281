/// The daemon's pages for people, drawn here: all is there without a script and without the
/// network.
#pragma once

#include <string>

#include "daemon/gateway/serve/api/served.hpp"

namespace recald::daemon {

/// /: whether all runs, what meters read now and read in the last week, what has changed, the
/// running job, the newest events.
[[nodiscard]] http::Response now_page(const Served& served);

/// /meters/ID ?from &to (times or dates; without them the last week): the history of a meter or of
/// a weather sensor's quantities, and the meter's months.
[[nodiscard]] http::Response meter_page(const Served& served, const http::Request& request,
                                        const std::string& id);

/// /months: measured months against what was forecast for them.
[[nodiscard]] http::Response months_page(const Served& served);

/// /model: calibrations, diagnoses and what they said; alarms with their causes.
[[nodiscard]] http::Response model_page(const Served& served);

/// /jobs/NUMBER/FILE: a report, or another file that a job wrote.
[[nodiscard]] http::Response job_file(const Served& served, const std::string& number_and_file);

/// /data: how much of each month was measured, and what was noticed about the readings.
[[nodiscard]] http::Response data_page(const Served& served);

/// /events ?severity &subject &text: the log, filtered.
[[nodiscard]] http::Response events_page(const Served& served, const http::Request& request);

[[nodiscard]] http::Response page_style(const Served& served);   ///< /style.css
[[nodiscard]] http::Response page_script(const Served& served);  ///< /page.js
/// /charts.js: what makes the charts of a meter and of the months zoomable.
[[nodiscard]] http::Response charts_script(const Served& served);

}  // namespace recald::daemon
