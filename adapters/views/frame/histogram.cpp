#include "adapters/views/frame/histogram.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace recald::views {

std::vector<double> Histogram::density() const {
  const int total = std::accumulate(counts.begin(), counts.end(), 0);
  std::vector<double> result;
  result.reserve(counts.size());
  for (const int count : counts) result.push_back(count / (total * width));
  return result;
}

Histogram make_histogram(std::span<const double> values, int bins) {
  assert(bins >= 1);
  std::vector<double> finite;
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](double value) { return std::isfinite(value); });
  if (finite.empty()) return {};

  const auto [low, high] = std::minmax_element(finite.begin(), finite.end());
  const double range = *high - *low;
  const double width = range > 0.0 ? range / bins : std::max(std::abs(*low) * 1e-3, 1e-9) / bins;
  Histogram histogram{*low, width, std::vector<int>(static_cast<std::size_t>(bins), 0)};
  for (const double value : finite) {
    const int bin = static_cast<int>((value - *low) / width);
    ++histogram.counts[static_cast<std::size_t>(std::clamp(bin, 0, bins - 1))];
  }
  return histogram;
}

}  // namespace recald::views
