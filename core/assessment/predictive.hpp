/// What a cloud of posterior draws says about one month.
#pragma once

#include <span>
#include <vector>

namespace recald::assessment {

/// Tukey's box plot: box from quartile to quartile, whiskers at the outermost values within 1.5
/// interquartile ranges of it.
struct BoxPlot {
  double low_whisker;
  double q25;
  double q50;
  double q75;
  double high_whisker;
  double mean;
};

/// @param draws  Any order, finite, not empty.
[[nodiscard]] BoxPlot box_plot(std::span<const double> draws);

/// Continuous ranked probability score of an ensemble, in the unit of the draws; 0 is perfect, and
/// for one draw it is the absolute error.
/// @param sorted  Ascending, not empty.
/// @see Gneiting, Raftery (2007), J. Am. Stat. Assoc. 102(477), eq. (21).
[[nodiscard]] double crps(std::span<const double> sorted, double measured);

}  // namespace recald::assessment
