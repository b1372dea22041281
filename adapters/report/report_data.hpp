/// All that a report shows, as plain values. The caller computes; the report only says it.
///
/// Whatever is absent (an empty vector, an empty optional, a NaN) is left out or shown as a dash,
/// so a site that has readings but no calibration yet gets a report too.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "core/model/parameter.hpp"

namespace recald::report {

struct SiteLine {
  std::string id;
  std::string name;
  std::string time_zone;  ///< IANA name; every local time in the report is in this zone.
};

/// What a number needs to be believed and repeated.
struct Provenance {
  std::string recald_version;
  std::string data_revision;  ///< Hash of the readings that were used.
  std::string model_version;
  std::string time_zone_data;  ///< Release of the zone rules, e.g. "2025b".
  std::string catalogue;       ///< Which effects were tried, in words.
  std::string sampler;
  std::string hyper_prior_profile;
  std::optional<std::uint64_t> seed;
  std::optional<int> iterations;  ///< A chain, the dropped ones included.
  std::optional<int> burn_in;
  std::optional<int> chains;
  std::optional<double> wall_s;
};

enum class Severity { info, warning, failure };

struct Notice {
  Severity severity;
  std::string sentence;
};

/// Something that the readings showed, e.g. a run of zeros that means no data.
struct Finding {
  std::string meter;
  std::string sentence;
  std::string from;  ///< Local time, as it shall be read.
  std::string to;
  std::int64_t count;  ///< Slots concerned.
};

/// ASHRAE Guideline 14 on one output.
struct OutputVerdict {
  std::string output;
  bool pass;
  std::string sentence;  ///< Why, in one sentence.
};

/// A calibration parameter, prior against posterior; all values in `unit`.
struct ParameterResult {
  std::string name;   ///< As in files: "outdoor_air".
  std::string label;  ///< As people say it: "Outdoor airflow rate".
  std::string unit;
  Prior prior;
  std::vector<double> draws;  ///< Posterior; 30 bins are made of them.
  double mean;
  double sd;
  double q05;
  double q50;
  double q95;
  double contraction;  ///< 1 − posterior variance / prior variance.
  double rhat;
  double ess_bulk;
  double ess_tail;
};

enum class MonthRole { calibration, validation, unused };

/// The posterior draws' outputs, kWh/day: box 25–75 %, whiskers 1.5 interquartile ranges.
struct ModelBox {
  double low_whisker_kWh;
  double q25_kWh;
  double q50_kWh;
  double q75_kWh;
  double high_whisker_kWh;
  double mean_kWh;
};

/// One month of one output; energies are daily averages in kWh/day.
struct OutputMonth {
  metering::Month month;
  MonthRole role = MonthRole::unused;
  std::optional<double> measured_kWh;
  bool measured_usable = false;
  double coverage = 0.0;      ///< Measured and valid share of the month's slots, 0…1.
  double filled_share = 0.0;  ///< Estimated share of the slots, 0…1.
  std::string unusable_because;
  std::optional<ModelBox> box;
  bool flagged_different = false;  ///< Measured apart from what the model expects.
};

/// Fit of one period. Signs as named; Guideline 14 writes measured − simulated.
struct FitMetrics {
  double nmbe_sim_minus_meas;
  double nmbe_g14;
  double cvrmse;
};

struct MetricsRow {
  std::string stage;  ///< "Before (prior mode)", "Prior mean", "After".
  std::optional<FitMetrics> calibration;
  std::optional<FitMetrics> validation;
};

/// Share of measured months inside the predictive intervals, and the score that rewards both.
struct PredictiveScores {
  double share_inside_50;
  double share_inside_90;
  double crps_kWh;  ///< Mean continuous ranked probability score, kWh/day.
};

/// One meter's monthly consumption, measured and modelled.
struct OutputResult {
  std::string label;
  std::vector<OutputMonth> months;
  std::vector<MetricsRow> metrics;
  std::vector<double> draw_cvrmse_calibration;  ///< One a draw, 0.1 = 10 %.
  std::vector<double> draw_cvrmse_validation;
  std::optional<PredictiveScores> scores_calibration;
  std::optional<PredictiveScores> scores_validation;
};

struct PeakMonth {
  metering::Month month;
  std::optional<double> peak_kW;
  std::string start;  ///< Local time of the peak interval.
  double coverage = 0.0;
  bool could_be_exceeded = false;  ///< Slots are missing: the true peak may be higher.
};

struct PeakSeries {
  std::string meter;
  std::string window;  ///< How a peak is defined: "highest 15-minute mean".
  std::vector<PeakMonth> months;
};

/// One local hour of measured load.
enum class HourStatus : unsigned char { ok, partly_filled, missing, suspect };

/// Measured load by local day and hour; entry [24 * day + hour].
struct LoadGrid {
  std::string meter;
  metering::Day first_day;
  std::vector<float> mean_kW;      ///< NaN where there is nothing to show. @pre a multiple of 24
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
      parts;  ///< Stacked in this order from the bottom; the same in each day type.
  HourlyProfile measured_mean_kW;
};

/// How the electricity meter was split into schedules that are then fixed inputs.
struct ElectricityProfile {
  std::vector<DayTypeProfile> day_types;
  std::string check_sentence;  ///< How well the profile repeats the meter month by month.
};

struct ReportData {
  std::string title;
  std::string generated_at;  ///< Given by the caller; the report has no clock.
  SiteLine site;
  Provenance provenance;

  std::vector<std::string> headlines;  ///< The first is the answer; the others explain it.
  std::vector<OutputVerdict> verdicts;
  std::vector<Notice> notices;
  std::vector<Finding> findings;

  std::vector<OutputResult> outputs;
  std::vector<ParameterResult> parameters;
  std::vector<PeakSeries> peaks;
  bool model_has_peaks = false;
  ElectricityProfile profile;
  std::vector<LoadGrid> loads;

  std::vector<std::string> not_known;  ///< What this report cannot say.
};

}  // namespace recald::report
