/// Equal-width histograms for the figures.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace recald::views {

inline constexpr int kPosteriorBins = 30;  ///< As in figures 2 and 3 of the seed.
inline constexpr int kMetricBins = 24;

/// Bin i covers [start + i width, start + (i+1) width); the last bin includes its upper end.
struct Histogram {
  double start = 0.0;
  double width = 0.0;
  std::vector<int> counts;  ///< Empty when no value is finite.

  [[nodiscard]] double edge(std::size_t i) const { return start + static_cast<double>(i) * width; }

  /// Counts as a probability density (integral 1), in 1/unit of the values.
  [[nodiscard]] std::vector<double> density() const;
};

/// Histogram over the range of the finite values; others are left out. If all values are equal, the
/// bin width is a thousandth of their size (or 1e-9 at zero).
/// @pre bins >= 1
[[nodiscard]] Histogram make_histogram(std::span<const double> values, int bins);

}  // namespace recald::views
