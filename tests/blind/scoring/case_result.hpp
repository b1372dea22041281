/// What one method said about one case: a line of a results file.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace recald::blind {

/// The last word on a case. `named`: at least one effect was added to the model, whatever a later
/// pass said; the others: nothing was added.
enum class Outcome { named, confusable, unknown, none };

[[nodiscard]] std::string_view outcome_name(Outcome outcome);

/// Keys of `probabilities` that are not effects.
inline constexpr std::string_view kNone = "none";
inline constexpr std::string_view kUnknown = "unknown";

/// Fit of one meter on the held months.
struct HeldFit {
  double log_score = 0.0;  ///< Mean log predictive density a month; more is better.
  double cvrmse = 0.0;     ///< CV(RMSE), a share of one; less is better.
};

using FitOfMeter = std::map<std::string, HeldFit>;

/// Before and after what the method added; the refit with the true effect comes with the line or
/// from the line of method "oracle", since a blind run cannot know it.
struct Gap {
  FitOfMeter before;
  FitOfMeter after;
  std::optional<FitOfMeter> oracle;
};

/// CV(RMSE) over unseen months of a meter's mean daily energy, shares of one.
struct CalibrationFit {
  double before = 0.0;  ///< The model by its drawings.
  double after = 0.0;   ///< The calibrated model alone.
  double forecast = 0.0;
  double yardstick = 0.0;
};

struct LogScoreChange {
  double mean = 0.0;  ///< After minus before; negative is harm.
  double se = 0.0;    ///< Standard error of the mean.
};

struct Posterior {
  double mean = 0.0;
  double q05 = 0.0;
  double q95 = 0.0;
};

struct EffectInterval {
  double q05 = 0.0;
  double q95 = 0.0;
  std::string unit;  ///< Empty: the answer's.
};

/// An alarm and its likeliest cause.
struct DriftCause {
  std::string month;    ///< "2022-03", in which it was raised.
  std::string kind;     ///< "meter", "parameter", "use", "unknown"; "nothing": nothing is blamed.
  std::string subject;  ///< The meter or parameter; may be empty.
  double probability = 0.0;
};

/// What was said month by month.
struct Drift {
  std::string from;  ///< First and last month that were watched.
  std::string to;
  std::vector<DriftCause> alarms;
};

struct CaseResult {
  std::string case_id;
  std::string method;
  Outcome outcome = Outcome::none;
  std::vector<std::string> named;               ///< Effects added, in order; empty unless named.
  std::vector<std::string> confusable;          ///< The set offered, if the method gave one.
  std::map<std::string, double> probabilities;  ///< Of the first pass; empty: the method has none.
  std::optional<Gap> gap;
  std::map<std::string, LogScoreChange> other_meters;
  std::map<std::string, Posterior> parameters_before;
  std::map<std::string, Posterior> parameters_after;
  std::optional<EffectInterval> effect_parameter;
  std::map<std::string, CalibrationFit> calibration;  ///< By meter; of method "calibrate".
  std::optional<Drift> drift;                         ///< Of method "drift".
  std::optional<std::vector<std::string>> located;    ///< Meters, the one most amiss first.
  std::optional<double> wall_s;
  std::optional<double> peak_rss_MB;
  std::string version;
};

/// Probabilities must sum to one within this: four written digits of forty entries do.
inline constexpr double kProbabilitySumTolerance = 0.002;

/// @param where  "sealed.jsonl line 7"; the messages add the case as soon as it is known.
/// @return malformed with where, case, key and value.
[[nodiscard]] Result<CaseResult> parse_case_result(std::string_view line, const std::string& where);

}  // namespace recald::blind
