/// Forecasts each month of a site from those before, looks at it, scores it and takes it in.
#pragma once

#include <string_view>
#include <vector>

#include "core/calibration/calibration.hpp"
#include "core/drift/followed_data.hpp"
#include "core/drift/inquiries.hpp"
#include "core/drift/sequential.hpp"
#include "core/drift/site_drift.hpp"
#include "core/drift/watch/daily_watches.hpp"
#include "core/drift/watch/watch.hpp"
#include "core/result.hpp"

namespace recald::drift {

/// The window that shares no month with the same one a year before.
inline constexpr std::string_view kLastYearWindow = "12 months";

struct FollowOptions {
  int learning_months = 12;  ///< That the model is made from; the first test is the month after.
  int design_runs = 200;     ///< That fix the normalisation, as a calibration's.
  SequentialOptions sequential;
  /// Of all meters, by months and by days together.
  WatchOptions watch;
  InquiryOptions inquiries;
};

/// What is seen beside the months.
struct SeenBeside {
  std::vector<MeterChange> meter_changes;
  std::vector<Direction> directions;
  std::vector<DailyWatches::Output> days;  ///< Of the meters whose days are watched.
  AskHours ask_hours = {};                 ///< Empty: months alone say what a change comes from.
};

/// Follows a site in four windows side by side.
/// @param learning  The problem of the learning months, and `design` its runs.
/// @return or not_enough_data for a design without response, an error of the model, cancelled.
[[nodiscard]] Result<SiteDrift> follow(const FollowedSite& followed,
                                       const calibration::CalibrationProblem& learning,
                                       const calibration::DesignRuns& design, SeenBeside beside,
                                       const FollowOptions& options,
                                       const calibration::RunContext& context);

}  // namespace recald::drift
