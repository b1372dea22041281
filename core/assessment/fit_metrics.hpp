/// How well simulated months meet measured ones, in the words of ASHRAE Guideline 14.
#pragma once

#include <span>
#include <string>

#include "core/result.hpp"

namespace recald::assessment {

/// Eq. (8) of the seed with p = 1, on un-normalised figures of one meter and output type.
///
///     CV(RMSE) = sqrt( sum (m_i - s_i)^2 / (n - 1) ) / mean(m)
///     NMBE     = sum (.) / ((n - 1) mean(m))
///
/// The sign of an NMBE is a matter of convention, so it is never given without its name.
struct FitMetrics {
  double
      nmbe_sim_minus_meas;  ///< Positive: the model is too high. Share of the mean, not per cent.
  double nmbe_g14;          ///< Measured minus simulated, as Guideline 14 writes it.
  double cvrmse;            ///< Share of the mean, not per cent.
  int n;                    ///< Points compared.
};

/// @param measured   (n) any unit; NaN marks a point that was not measured and is left out.
/// @param simulated  (n) same unit, finite wherever `measured` is.
/// @pre    equal lengths.
/// @return the metrics, or
///         not_enough_data  fewer than two measured points;
///         not_finite       a simulated value that is needed is not finite;
///         invalid_value    the measured mean is not positive, so nothing can be relative to it.
[[nodiscard]] Result<FitMetrics> fit_metrics(std::span<const double> measured,
                                             std::span<const double> simulated);

/// What |NMBE| and CV(RMSE) may reach, as shares of the mean.
struct GuidelineLimits {
  double nmbe;
  double cvrmse;
  const char* grain;  ///< "monthly", "hourly": for the sentence.
};

/// ASHRAE Guideline 14-2014, 4.3.2.4: calibration tolerances by grain of the data.
inline constexpr GuidelineLimits kMonthlyLimits{0.05, 0.15, "monthly"};
inline constexpr GuidelineLimits kHourlyLimits{0.10, 0.30, "hourly"};

struct GuidelineVerdict {
  bool pass;
  std::string why;  ///< One sentence with the figures and the limits they were held against.
};

[[nodiscard]] GuidelineVerdict guideline14_verdict(const FitMetrics& metrics,
                                                   const GuidelineLimits& limits = kMonthlyLimits);

}  // namespace recald::assessment
