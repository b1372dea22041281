#include "core/diagnosis/evidence/false_discovery.hpp"

#include <algorithm>
#include <numeric>

namespace recald::diagnosis {
namespace {

/// Indices of the values, smallest first.
std::vector<std::size_t> ascending_order(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [values](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  return order;
}

}  // namespace

std::vector<double> benjamini_yekutieli(std::span<const double> p_values) {
  const std::vector<std::size_t> order = ascending_order(p_values);
  const auto tests = static_cast<double>(order.size());
  double harmonic = 0.0;
  for (double i = 1.0; i <= tests; ++i) harmonic += 1.0 / i;

  std::vector<double> adjusted(order.size());
  double least = 1.0;  // of this and all larger p-values
  for (std::size_t rank = order.size(); rank > 0; --rank) {
    const std::size_t test = order[rank - 1];
    least = std::min(least, tests * harmonic * p_values[test] / static_cast<double>(rank));
    adjusted[test] = least;
  }
  return adjusted;
}

std::vector<double> holm(std::span<const double> p_values) {
  std::vector<double> adjusted(p_values.size());
  double largest = 0.0;  // of this and all smaller p-values
  auto tests_left = static_cast<double>(p_values.size());
  for (const std::size_t test : ascending_order(p_values)) {
    largest = std::max(largest, std::min(1.0, tests_left * p_values[test]));
    adjusted[test] = largest;
    tests_left -= 1.0;
  }
  return adjusted;
}

std::vector<std::vector<bool>> findings(std::span<const TestFamily> families, double rate) {
  std::vector<double> omnibus;
  for (const TestFamily& family : families) omnibus.push_back(family.omnibus_p);
  const std::vector<double> opened = holm(omnibus);

  std::vector<std::vector<bool>> found;
  for (std::size_t f = 0; f < families.size(); ++f) {
    std::vector<bool>& flags = found.emplace_back(families[f].bin_p_values.size(), false);
    if (opened[f] > rate) continue;
    const std::vector<double> adjusted = benjamini_yekutieli(families[f].bin_p_values);
    std::transform(adjusted.begin(), adjusted.end(), flags.begin(),
                   [rate](double p) { return p <= rate; });
  }
  return found;
}

}  // namespace recald::diagnosis
