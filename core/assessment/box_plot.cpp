#include "core/assessment/box_plot.hpp"

#include <algorithm>
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

}  // namespace recald::assessment
