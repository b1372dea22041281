/// Whether an effect that the hourly model was given also helps the monthly model that the site is
/// calibrated with: fitted on the months to fit and to choose by, judged on the months kept back.
/// @see discrepancy.md, 3.4.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/diagnosis/diagnose.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"
#include "daemon/config/site_config.hpp"
#include "daemon/diagnose/diagnosis_files.hpp"
#include "daemon/replay/recording.hpp"
#include "daemon/replay/site_weather.hpp"

namespace recald::daemon {

struct EpcGap {
  /// Log scores are mean log densities of a month's daily average in kWh, under the errors that the
  /// fit before left: a change of noise is no better model. A monthly model has no discrepancy
  /// share of its own: NaN.
  ModelGap gap;
  diagnosis::ScoreGain total;  ///< Of all outputs, month by month.
  int months_shown;
  int figures_shown;  ///< Measured monthly figures in them, of all outputs.
  /// Whether there is anything to judge by.
  [[nodiscard]] bool has_vote() const { return figures_shown > 0; }
  /// The months kept back do not speak against the effect in this model either: not by more than a
  /// nat beyond two standard errors. What leaves monthly figures as they are, a clock, must not
  /// fall for their noise. @pre has_vote()
  [[nodiscard]] bool agrees() const { return total.sum >= -2.0 * total.se - 1.0; }
};

/// @param problem  Of the site, as the diagnosis had it: months and their roles are taken from it.
/// @param added    With η at their modes, one on top of the other.
/// @return the gap; or
///         unsupported      the monthly model cannot be made of this site (a chiller of its own);
///         not_enough_data  fewer than two months shown, or too few to fit; no electricity meter.
/// @note   Maximum a posteriori, Gauss-Newton: well under a second. Same input, same bytes.
[[nodiscard]] Result<EpcGap> epc_gap(const SiteConfig& site,
                                     const metering::LocalCalendar& calendar,
                                     const Recording& recording, const SiteWeather& weather,
                                     const diagnosis::SiteProblem& problem,
                                     std::span<const diagnosis::Addition> added,
                                     std::uint64_t seed = 1);

}  // namespace recald::daemon
