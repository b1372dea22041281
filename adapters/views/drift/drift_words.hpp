/// What a followed site shows, in sentences and in a table.
#pragma once

#include <string>

#include "core/drift/site_drift.hpp"

namespace recald::views {

/// "steam uses more than forecast since 2020-04 (90 %: 2020-03 to 2020-05), …".
[[nodiscard]] std::string alarm_sentence(const drift::SiteDrift& drift, const drift::Alarm& alarm);

/// What an alarm's change has cost and emitted, and will in a year if it goes on: "It costs about
/// 410 EUR so far. If it goes on, it costs about 1,240 EUR and 2.1 t of CO2 a year." Empty where
/// the site has no prices. Alarms of one change have one cost, that of the whole change.
[[nodiscard]] std::string alarm_cost_words(const drift::SiteDrift& drift,
                                           const drift::ExplainedAlarm& explained);

/// "outdoor_airflow: 5.0 before, 6.9 m3/s since (90 %: 6.2 to 7.6)".
[[nodiscard]] std::string cause_words(const drift::SiteDrift& drift, const drift::Cause& cause);

/// What to look at; of an alarm that is still open also what would tell its causes apart, and
/// whether to wait. @pre it has causes
[[nodiscard]] std::string advice_words(const drift::SiteDrift& drift,
                                       const drift::ExplainedAlarm& alarm);

/// How true an output's forecasts were so far.
[[nodiscard]] std::string trust_words(const drift::SiteDrift& drift, std::size_t output);

[[nodiscard]] std::string meter_change_words(const drift::MeterChange& change);

/// The alarm, what it likely comes from, and what to look at.
[[nodiscard]] std::string explained_sentence(const drift::SiteDrift& drift,
                                             const drift::ExplainedAlarm& alarm);

/// Of all outputs and months, and every alarm.
[[nodiscard]] std::string drift_words(const drift::SiteDrift& drift);

}  // namespace recald::views
