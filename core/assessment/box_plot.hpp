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

}  // namespace recald::assessment
