#include "core/assessment/predictive.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "core/statistics/quantile.hpp"

namespace recald::assessment {

BoxPlot box_plot(std::span<const double> draws) {
  std::vector<double> sorted{draws.begin(), draws.end()};
  std::ranges::sort(sorted);
  BoxPlot box{};
  box.q25 = quantile_of_sorted(sorted, 0.25);
  box.q50 = quantile_of_sorted(sorted, 0.50);
  box.q75 = quantile_of_sorted(sorted, 0.75);
  const double reach = 1.5 * (box.q75 - box.q25);
  box.low_whisker = *std::ranges::lower_bound(sorted, box.q25 - reach);
  box.high_whisker = *std::prev(std::ranges::upper_bound(sorted, box.q75 + reach));
  box.mean =
      std::accumulate(sorted.begin(), sorted.end(), 0.0) / static_cast<double>(sorted.size());
  return box;
}

double crps(std::span<const double> sorted, double measured) {
  assert(!sorted.empty());
  const double n = static_cast<double>(sorted.size());
  double to_measured = 0.0;
  double between = 0.0;  // Σ_i Σ_j |x_i − x_j| / 2 from ranks: one pass over sorted draws
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    to_measured += std::abs(sorted[i] - measured);
    between += (2.0 * static_cast<double>(i) + 1.0 - n) * sorted[i];
  }
  return to_measured / n - between / (n * n);
}

}  // namespace recald::assessment
