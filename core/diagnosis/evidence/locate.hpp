/// Where simulation and meters disagree: hours, days, weather, dates, meter by meter.
///
/// A bin is a set of day parts. Its statistic is the score of a common offset of the meter there,
/// with all freedom of the base parameters and of the anonymous terms in the null: t = b'Mr /
/// sqrt(b'Mb). Families of bins are opened by their largest |t| (Holm), and their bins tested by
/// Benjamini-Yekutieli, both at 5 %.
/// @see Holm (1979), Scand. J. Stat. 6(2); Benjamini, Yekutieli (2001), Ann. Statist. 29(4).
#pragma once

#include <string>
#include <vector>

#include "core/diagnosis/evidence/joint_fit.hpp"
#include "core/random/rng.hpp"

namespace recald::diagnosis {

/// A place where simulation and meter disagree: some of one meter's hours, days or months.
struct Misfit {
  std::size_t meter;
  std::string family;  ///< "part of the week", "outdoor temperature", ...
  std::string words;   ///< "weekday nights above 20 degC"
  double share;        ///< Measured minus modelled, relative to modelled, in the bin.
  double share_se;
  double kWh_month;  ///< Measured minus modelled, divided by the months of the fit.
  double statistic;  ///< t
  double adjusted_p;
};

struct LocateOptions {
  int null_draws = 999;
  double rate = 0.05;
};

/// @param none  The base model at its mode.
/// @return findings, largest |t| first.
[[nodiscard]] Result<std::vector<Misfit>> locate(const FitContext& context, const JointFit& none,
                                                 Rng& rng, const LocateOptions& options = {});

}  // namespace recald::diagnosis
