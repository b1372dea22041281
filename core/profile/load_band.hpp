/// What a meter is likely to read in an hour of which a model says something.
///
/// No regression: the hours that are most like it, and how far the meter was from the model in
/// them. So the band has the model's habitual error at that hour in it, and its width is that of
/// what was measured. A k-nearest-neighbours estimate of conditional quantiles (Stone, Annals of
/// Statistics 5, 1977).
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/model/schedule.hpp"

namespace recald::profile {

struct ModelledHour {
  model::DayType day;
  int local_hour;  ///< 0…23
  double modelled_kW;
  double measured_kW;  ///< NaN: not measured.
};

/// Of the measured load, given what the model says.
struct ExpectedLoad {
  double q05_kW;
  double q50_kW;
  double q95_kW;
};

class LoadBand {
 public:
  /// Workdays are like workdays, Saturdays and Sundays like each other.
  explicit LoadBand(std::span<const ModelledHour> hours);

  /// Quantiles over the hours of such days, at this time of day or an hour off, of which the model
  /// said about as much. @return nothing if there are fewer than forty.
  [[nodiscard]] std::optional<ExpectedLoad> at(model::DayType day, int local_hour,
                                               double modelled_kW) const;

 private:
  struct Hour {
    double modelled_kW;
    double residual_kW;  ///< Measured less modelled.
  };
  [[nodiscard]] ExpectedLoad not_below_what_was_measured(ExpectedLoad load) const;
  [[nodiscard]] const std::vector<Hour>& cell(model::DayType day, int local_hour) const;

  double least_kW_ = std::numeric_limits<double>::infinity();  ///< Ever measured.
  std::array<std::vector<Hour>, 48> cells_;  ///< Workdays, then others; by modelled load.
};

}  // namespace recald::profile
