/// How the months of a calibration make a year.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/metering/civil_time.hpp"

namespace recald::savings {

struct YearWeights {
  /// (months) Days that each month's daily average stands for.
  Eigen::VectorXd days;
  /// Every calendar month is there, and they count alike however often they are. False: the sum is
  /// that of the months alone, which are no year.
  bool is_year;
};

/// @param months  At least one, each once.
[[nodiscard]] YearWeights year_weights(std::span<const metering::Month> months);

}  // namespace recald::savings
