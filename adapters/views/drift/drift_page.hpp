/// The page of a monitored site: forecasts, measurements, and what has changed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/views/frame/report_data.hpp"

namespace recald::views {

/// One month of one output, in its unit.
struct ForecastMonth {
  metering::Month month;
  std::optional<double> q05;  ///< Absent: there was no forecast, as for the training months.
  std::optional<double> q50;
  std::optional<double> q95;
  std::optional<double> measured;
};

/// The months that an alarm covers: from its earliest month until it was raised.
struct AlarmSpan {
  metering::Month first;
  metering::Month last;
};

struct ForecastSeries {
  std::string label;  ///< "Chilled water, daily average"
  std::string unit;
  std::string trust;  ///< How well its forecasts have done, as a sentence.
  std::vector<ForecastMonth> months;
  std::vector<AlarmSpan> alarms;
};

struct LikelyCause {
  std::string words;
  double probability;
};

struct AlarmCard {
  std::string title;                ///< "Chilled water is more than forecast since Jul 2021"
  std::string sentence;             ///< How sure, by how much, when raised.
  std::string cost = {};            ///< What the change costs a year; empty: not known.
  std::vector<LikelyCause> causes;  ///< The likeliest first; empty: too little was known before.
  std::string consequence;          ///< What was done about it; empty: nothing.
  std::string advice;
};

/// A window's estimate of a parameter after each month.
struct BelievedMonth {
  metering::Month month;
  double mean, q05, q95;  ///< NaN before there is a posterior.
};

struct BelievedParameter {
  std::string label;
  std::string unit;
  std::vector<BelievedMonth> months;   ///< All months so far.
  std::vector<double> last_year_mean;  ///< (months) From the window of twelve months.
};

struct WindowRow {
  std::string name;
  double log_score;  ///< Of all months forecast; larger is better.
  int sampled_anew;
};

/// A version of the estimates: from when it applies, and why it replaced the last.
struct HistoryRow {
  metering::Month since;
  std::string what;
};

struct DriftData {
  std::string title;
  SiteLine site;
  std::string generated_at;
  std::string headline;
  std::vector<AlarmCard> alarms;
  std::vector<std::string> meter_changes;  ///< Sentences.
  std::vector<Notice> notices;
  std::vector<ForecastSeries> outputs;
  std::vector<BelievedParameter> parameters;
  std::vector<WindowRow> windows;
  std::vector<HistoryRow> history;
  Provenance provenance;
};

/// Renders the page under the rules of `render_report`: self-contained, every text escaped, the
/// same data give the same bytes.
[[nodiscard]] std::string render_drift(const DriftData& data);

/// The numbers that the page's script draws.
[[nodiscard]] std::string drift_figure_json(const DriftData& data);

}  // namespace recald::views
