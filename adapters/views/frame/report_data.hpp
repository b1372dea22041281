/// Everything that a report shows, as plain values. The caller computes; the report only shows.
///
/// Absent values (an empty vector, an empty optional, a NaN) are left out or shown as a dash, so a
/// site with readings but no calibration yet also gets a report.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/absent.hpp"
#include "core/assessment/output_assessment.hpp"
#include "core/calibration/posterior/summary.hpp"
#include "core/display/unit.hpp"
#include "core/display/warning.hpp"
#include "core/metering/civil_time.hpp"
#include "core/metering/months/data_quality.hpp"
#include "core/metering/months/monthly_figure.hpp"
#include "core/model/prior.hpp"
#include "core/tariff/tariff.hpp"

namespace recald::views {

struct SiteLine {
  std::string id;
  std::string name;
  std::string time_zone;  ///< IANA name; every local time in the report is in this zone.
};

/// What a reader needs to trust and reproduce the numbers.
struct Provenance {
  std::string recald_version;
  std::string data_revision;  ///< Hash of the readings used.
  std::string model_version;
  std::string time_zone_data;  ///< Release of the zone rules, e.g. "2025b".
  std::string weather_values;  ///< How temperatures were interpreted: "instant (inferred)".
  std::string catalogue;       ///< The effects that were tried, in words.
  std::string sampler;
  std::string hyper_prior_profile;
  std::optional<std::uint64_t> seed;
  std::optional<int> iterations;  ///< Per chain, including the dropped ones.
  std::optional<int> burn_in;
  std::optional<int> chains;
  std::optional<double> wall_s;
};

enum class Severity { info, warning, failure };

struct Notice {
  Severity severity;
  std::string sentence;
  std::string details = {};  ///< Stands behind the sentence; empty: nothing.
  double share = 0.0;        ///< Of the months or the energy that it is about: the most first.
};

[[nodiscard]] inline Notice notice_of(Severity severity, const display::Warning& warning) {
  return {severity, warning.sentence, warning.details, warning.share};
}

/// A number that a client takes along, with its sign, and what it is of.
struct KeyNumber {
  std::string number;  ///< "+4.2 %"
  std::string what;
};

/// The first screen: one sentence, and three numbers beside one picture.
struct FirstScreen {
  std::string sentence;
  std::string more;  ///< The consequence; empty: none.
  std::vector<KeyNumber> numbers;
};

/// ASHRAE Guideline 14 for one output.
struct OutputVerdict {
  std::string output;
  assessment::GuidelineVerdict verdict;
};

/// A calibration parameter, prior and posterior.
struct ParameterResult {
  std::string label;  ///< Readable name: "Outdoor airflow rate".
  Prior prior;
  calibration::Summary summary;
  std::vector<double> draws;  ///< Posterior; shown in 30 bins.
};

/// One month of one output, in the output's unit; energies are daily averages in kWh/day.
struct OutputMonth {
  /// Coverage 0 and NaN where the meter has no such month; coverage NaN where nobody knows it.
  metering::MonthlyFigure figure;
  std::string number;  ///< Of a month without a calendar: "7". Empty: the figure's month counts.
  assessment::MonthRole role = assessment::MonthRole::unused;
  std::optional<assessment::BoxPlot> box;             ///< Of the posterior draws.
  std::optional<assessment::MonthForecast> forecast;  ///< What the meter was expected to show.
  bool flagged_different = false;  ///< The measurement differs from what the model expects.
};

/// One meter's monthly consumption, or its monthly peak, measured and modelled.
struct OutputResult {
  std::string label;
  bool is_peak = false;  ///< Of the figures the peaks are meant.
  display::MeterUnits units = {};
  std::vector<OutputMonth> months;
  std::optional<assessment::OutputAssessment> assessment;  ///< Its boxes stand in `months`.

  /// Of its months' figures; without a name where nobody knows it.
  [[nodiscard]] const display::Unit& unit() const { return is_peak ? units.power : units.daily; }
};

/// Whether anybody knows which share of the output's months was measured: not of a design, which
/// has figures and no readings.
[[nodiscard]] inline bool has_known_coverage(const OutputResult& output) {
  return std::ranges::any_of(
      output.months, [](const OutputMonth& month) { return !std::isnan(month.figure.coverage); });
}

/// What was measured in a month, in kWh/day or kW; NaN where nothing was.
[[nodiscard]] inline double measured_of(const OutputResult& output, const OutputMonth& month) {
  const metering::MonthlyFigure& figure = month.figure;
  if (!output.is_peak) return figure.daily_average_kWh;
  return figure.peak ? figure.peak->kW : kAbsent;
}

struct PeakSeries {
  std::string meter;
  display::MeterUnits units = {};
  std::vector<metering::MonthlyFigure> months;
};

/// One local hour of measured load.
enum class HourStatus : unsigned char { ok, partly_filled, missing, suspect };

/// Measured load by local day and hour; entry [24 * day + hour].
struct LoadGrid {
  std::string meter;
  display::MeterUnits units = {};
  metering::Day first_day;
  std::vector<float> mean_kW;      ///< NaN if there is nothing to show. @pre a multiple of 24
  std::vector<HourStatus> status;  ///< @pre same size as mean_kW
};

/// Mean power in each hour of the local day, kW; entry 0 is 00:00 to 01:00.
using HourlyProfile = std::array<double, 24>;

struct ProfilePart {
  std::string label;  ///< "Base", "Lights", "Plug loads", "Fans and pumps".
  HourlyProfile mean_kW;
};

struct DayTypeProfile {
  std::string label;  ///< "Working day", "Saturday", "Sunday and holiday".
  std::vector<ProfilePart>
      parts;  ///< Stacked in this order from the bottom; the same for each day type.
  HourlyProfile measured_mean_kW;
};

/// How the electricity meter was split into schedules, which are then fixed inputs.
struct ElectricityProfile {
  std::vector<DayTypeProfile> day_types;
  std::string check_sentence;  ///< How well the profile reproduces the meter month by month.
};

/// One month of a meter's bill.
struct MonthCost {
  metering::Month month;
  tariff::MonthBill bill;
};

/// What a meter's months cost and emitted.
struct MeterCosts {
  std::string meter;
  std::vector<MonthCost> months;
};

/// A sum with its 90 % band, beside what was measured.
struct ForecastSum {
  double mean;
  double q05;
  double q95;
  double measured;
};

/// What a meter's unseen months cost and emit, demand charges apart.
struct ForecastCost {
  std::string meter;
  metering::Month first;
  metering::Month last;
  int months;
  std::optional<ForecastSum> money;
  std::optional<ForecastSum> emissions_t;  ///< CO2.
};

/// What one model makes of one meter.
struct ComparedFit {
  assessment::PeriodMetrics before;    ///< The model at its prior modes.
  assessment::PeriodMetrics after;     ///< The calibrated model.
  assessment::PeriodMetrics forecast;  ///< With what is known of its errors.
};

/// Another model of the same site, or this one, beside the others.
struct ComparedModel {
  std::string name;  ///< "EnergyPlus"
  std::string note;  ///< Why it has no figures; empty: it has.
  std::vector<std::pair<std::string, ComparedFit>> outputs;  ///< By label.
  /// By label: "0.042 (0.031 to 0.055) person/m2".
  std::vector<std::pair<std::string, std::string>> parameters;
};

struct ReportData {
  std::string title;
  std::string generated_at;  ///< Set by the caller; the report has no clock.
  SiteLine site;
  std::optional<metering::LocalCalendar> calendar;  ///< Of the site; absent: times are in UTC.
  Provenance provenance;
  /// Of temperatures and parameters; meters say theirs. Numbers below are in SI whatever it is.
  display::UnitSystem units = display::UnitSystem::si;

  FirstScreen first;
  std::string most_likely;             ///< From a diagnosis of the same data; empty: there is none.
  bool asks_for_diagnosis = false;     ///< Something is missing, whether or not it is known yet.
  std::vector<std::string> headlines;  ///< The details behind the first sentence.
  std::vector<OutputVerdict> verdicts;
  std::vector<Notice> notices;
  /// `meter` holds the readable name.
  std::vector<metering::DataFinding> findings;

  std::vector<OutputResult> outputs;
  std::vector<ParameterResult> parameters;
  std::vector<PeakSeries> peaks;
  std::string currency;                      ///< Of costs; empty: the site has no prices.
  std::vector<MeterCosts> costs;             ///< Empty: neither prices nor emissions are known.
  std::vector<ForecastCost> forecast_costs;  ///< Likewise, or nothing is forecast.
  ElectricityProfile profile;
  std::vector<LoadGrid> loads;
  std::vector<ComparedModel> compared;  ///< Empty: the site has one model.

  std::vector<std::string> not_known;  ///< What this report cannot show.
};

}  // namespace recald::views
