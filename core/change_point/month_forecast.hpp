/// Months from a daily regression, with what they may be off by.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/change_point/meter_day.hpp"
#include "core/change_point/regression.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::change_point {

/// Months as jointly normal, so that their sums have the right spread too.
struct MonthlyForecast {
  std::vector<metering::Month> months;  ///< (m) ascending
  Eigen::VectorXd daily_average_kWh;    ///< (m) mean over the given days of the month, kWh/day.
  Eigen::MatrixXd covariance_kWh2;      ///< (m x m) symmetric, positive definite.
  std::vector<int> days;                ///< (m) given days of the month: weights of a sum.
  std::vector<int> days_beyond;         ///< (m) of them colder or warmer than any day fitted.
};

/// Consumption of the months that the days lie in, as the mean over the days given. Days without a
/// temperature count with the mean of their month, and its variance with the spread of the month.
/// Beyond the temperatures of training the fitted curve goes on, with a slope more on either side
/// that is not known: its sd is the mean use over 30 K.
/// @param days  Ascending dates; not empty. Energies are not looked at.
/// @return or not_enough_data where temperature matters and is known on less than half of the days
///         of a month.
[[nodiscard]] Result<MonthlyForecast> forecast_months(const Regression& regression,
                                                      std::span<const MeterDay> days);

/// The training months, each forecast by a regression that has not seen it: form, outliers, noise
/// and all are learnt from the other days.
struct LeftOutMonth {
  metering::Month month;
  double daily_average_kWh;  ///< Mean over the given days of the month, kWh/day.
  double sd_kWh;             ///< kWh/day
};

/// @param months_together  Consecutive months that are left out at once, >= 1, counted from the
///                         first.
/// @return (months of the days) without those that the other days cannot forecast, or the error of
///         the last one if none can be.
[[nodiscard]] Result<std::vector<LeftOutMonth>> forecast_left_out_months(
    std::span<const MeterDay> days, int months_together = 1);

}  // namespace recald::change_point
