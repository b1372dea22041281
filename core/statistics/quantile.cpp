#include "core/statistics/quantile.hpp"

#include <algorithm>
#include <cassert>

namespace recald {

double quantile_of_sorted(std::span<const double> sorted, double probability) {
  assert(!sorted.empty() && probability >= 0.0 && probability <= 1.0);
  const double position = probability * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double weight = position - static_cast<double>(below);
  return (1.0 - weight) * sorted[below] + weight * sorted[above];
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return quantile_of_sorted(values, 0.5);
}

}  // namespace recald
