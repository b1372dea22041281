/// The months of a design continued into weather that was not simulated.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "adapters/doe/days_file.hpp"
#include "adapters/doe/design_folder.hpp"
#include "core/metering/civil_time.hpp"
#include "core/model/schedule.hpp"
#include "core/result.hpp"
#include "core/weather/weather_series.hpp"

namespace recald::daemon {

struct DesignExtension {
  doe::DesignFolder design;            ///< With the months added to its outputs and inputs.
  std::vector<metering::Month> added;  ///< Ascending; the other months are as simulated.
  Eigen::VectorXd error_sd;            ///< (outputs) of a figure of an added month, output unit.
  Eigen::MatrixXd month_error_sd;      ///< (outputs x added) the same, by the time of year.
  std::vector<std::string> notes;      ///< Months left out, weather that no run has seen.
};

/// Predicts the figures of every run in the wanted months that the design lacks, from the runs'
/// days and the weather (`regression::fit_weather_response`). To all that reads a design they are
/// as simulated months, but for the error that comes with them: that of simulated months when left
/// out, common to all runs of a month rather than independent.
///
/// An output whose name has `peak` in it is the month's highest power, any other a daily average.
///
/// @param weather  Of the design's days and of the wanted months; days without it do not count, and
///                 a month that lacks more than a tenth of them is left out with a note.
/// @param wanted   In any order; those in the design already are passed over.
/// @return the design; unsupported: it has no calendar months, or a model input that
///         `weather::monthly_inputs` does not give; not_enough_data: the weather covers less than
///         three of its months.
[[nodiscard]] Result<DesignExtension> extend_design(doe::DesignFolder design,
                                                    const doe::DesignDays& days,
                                                    const weather::WeatherSeries& weather,
                                                    const metering::LocalCalendar& calendar,
                                                    const model::Holidays& holidays,
                                                    std::vector<metering::Month> wanted);

}  // namespace recald::daemon
