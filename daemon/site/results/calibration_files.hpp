/// The files of a calibration: calibration.json, draws_<chain>.csv, points.json, months.csv.
#pragma once

#include <filesystem>
#include <string>

#include "adapters/ports/job_result.hpp"
#include "core/result.hpp"
#include "daemon/site/calibrate/design_calibration.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"
#include "daemon/site/model/run_facts.hpp"

namespace recald::daemon {

/// What the months after a calibration have said, or why the site could not be followed.
using FollowUp = tl::expected<DriftSummary, std::string>;

/// One JSON object as text, indented; absent numbers are null. Where no model was calibrated it has
/// months, forecasts, why, and nothing that only a calibration has.
/// @param follow_up  Null: nobody has followed the site.
[[nodiscard]] std::string calibration_json(const assessment::AssessedCalibration& result,
                                           const RunFacts& facts,
                                           const FollowUp* follow_up = nullptr);

/// The same as the result of a job.
[[nodiscard]] JobResult calibration_result(const assessment::AssessedCalibration& result,
                                           const RunFacts& facts,
                                           const FollowUp* follow_up = nullptr);

/// Draws of one chain as CmdStan writes them, so that ArviZ and R's posterior read them. With
/// predictions also `y_rep.1` … in the units of the outputs, and `log_lik.1` …, for the points in
/// the order of `points_json`: see calibration/predictive.hpp.
[[nodiscard]] std::string draws_csv(const assessment::AssessedCalibration& result,
                                    std::size_t chain, const RunFacts& facts);

/// The points of the predictions in arrays of one length: `y`, what was measured; `output`, `unit`,
/// `month`. @pre the result has predictions
[[nodiscard]] std::string points_json(const assessment::AssessedCalibration& result);

/// `month,meter,value,unit,coverage,filled_share,peak_kW,peak_at,method,usable,different,revision,
/// tzdata,estimated_share,value_sd`, one row a meter and month; `different` when any meter says
/// that the month is not like the same months before, `value_sd` by what was filled.
[[nodiscard]] std::string months_csv(const Recording& recording, const std::string& tzdata);

/// The same of a design's measurements. What only readings can tell is blank; a month without a
/// calendar is its number; outputs are put together by `regression::group_by_meter`.
[[nodiscard]] std::string months_csv(const DesignCalibration& result);

/// The profile as JSON: schedules in kW by kind of day and hour.
[[nodiscard]] std::string profile_json(const model::ElectricityProfile& profile);

}  // namespace recald::daemon
