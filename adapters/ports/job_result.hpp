/// The result of a job: what the daemon itself uses, and the document for people and machines.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/absent.hpp"
#include "core/drift/alarm_kinds.hpp"

namespace recald {

/// How close the daily monitoring of an output is to an alarm.
struct DailyEvidence {
  double log_evidence = kAbsent;
  double log_threshold = kAbsent;  ///< Raises an alarm.
  double lag_one = kAbsent;
  double month_factor = kAbsent;
};

/// The newest month of one output compared with its forecast.
struct OutputDrift {
  std::string output;  ///< "steam_daily_kWh"
  std::string month;   ///< Empty: there was no forecast.
  double pvalue = kAbsent;
  double log_evidence = kAbsent;
  double log_threshold = kAbsent;
  double change_within_year = kAbsent;
  std::optional<DailyEvidence> daily = {};
};

/// The days behind an alarm that was raised by days.
struct AlarmedDays {
  std::string raised, since, since_earliest, since_latest;
  double excess = kAbsent;
};

/// A possible cause of an alarm.
struct AlarmCause {
  drift::CauseKind kind = drift::CauseKind::unknown;
  std::optional<std::string> subject;  ///< A parameter, use or output.
  double probability = kAbsent;
  double log_evidence = kAbsent;
  double mean = kAbsent, q05 = kAbsent, q95 = kAbsent;
  std::string words;
};

/// What has changed, since when and why. Months as "2024-03".
struct DriftAlarm {
  std::string month, output, direction;
  double evidence = kAbsent;
  std::string since, since_earliest, since_latest;
  std::optional<AlarmedDays> days = {};
  bool forecasts_are_true = false;
  std::vector<AlarmCause> causes;
  std::string explained_until;
  drift::Consequence consequence = drift::Consequence::none;
  std::string sentence;
};

/// A change that a meter's readings show without a model.
struct ChangedMeter {
  std::string meter;
  drift::MeterChangeKind kind = drift::MeterChangeKind::readings;
  std::string since, seen;
  double factor = kAbsent;
  std::string sentence;
};

/// What the months after a calibration show about it.
struct DriftSummary {
  std::vector<OutputDrift> outputs;
  std::vector<DriftAlarm> alarms;
  std::vector<ChangedMeter> changed_meters;
};

/// The weather of a month that a calibration used.
struct MonthWeather {
  std::string month;   ///< "2024-03"
  double known = 0.0;  ///< Share measured or interpolated, 0…1, of the least known one.
  /// Shares by source: a sensor, a file, "interpolated", "typical", "assumed".
  std::map<std::string, double> from = {};
};

struct JobResult {
  std::string document;                    ///< calibration.json or diagnosis.json; empty: not done.
  double rhat_max = kAbsent;               ///< Of a calibration's parameters and hyper-parameters.
  std::optional<DriftSummary> drift;       ///< Of a calibration whose site could be monitored.
  std::vector<MonthWeather> weather = {};  ///< Of a calibration, by month.
};

}  // namespace recald
