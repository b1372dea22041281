/// The page at /: whether the daemon runs, whether the data are good, recent events. Plain
/// HTML, no script.
#pragma once

#include <string>

#include "daemon/gateway/serve/served.hpp"

namespace recald::daemon {

[[nodiscard]] http::Response status_page(const Served& served);
[[nodiscard]] http::Response status_style(const Served& served);  ///< /style.css

/// "2026-03-29 03:15 +02:00", in the site's local time.
[[nodiscard]] std::string site_time_text(const metering::LocalCalendar& calendar,
                                         metering::Instant t);

/// "40 s", "3 min", "5 h", "2 days"; "in the future" if negative.
[[nodiscard]] std::string age_text(std::chrono::seconds age);

}  // namespace recald::daemon
