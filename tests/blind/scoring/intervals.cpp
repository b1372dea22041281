#include "tests/blind/scoring/intervals.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cassert>
#include <numeric>

#include "core/random/rng.hpp"
#include "core/statistics/quantile.hpp"

namespace recald::blind {
namespace {

constexpr double kTwoSidedTail = 0.025;
constexpr double kOneSidedTail = 0.05;

/// Picks the drawn rows out of the values, so that a statistic of numbers works on rows.
std::vector<double> picked(const std::vector<double>& values, std::span<const std::size_t> rows) {
  std::vector<double> chosen;
  chosen.reserve(rows.size());
  for (const std::size_t row : rows) chosen.push_back(values[row]);
  return chosen;
}

}  // namespace

Interval clopper_pearson(int hits, int cases, double tail) {
  assert(hits >= 0 && hits <= cases && cases > 0 && tail > 0.0 && tail < 0.5);
  const double misses = cases - hits;
  return {.low = hits == 0 ? 0.0 : boost::math::ibeta_inv(hits, misses + 1.0, tail),
          .high = hits == cases ? 1.0 : boost::math::ibetac_inv(hits + 1.0, misses, tail)};
}

std::optional<Score> share_score(int hits, int cases) {
  if (cases == 0) return std::nullopt;
  return Score{.value = static_cast<double>(hits) / cases,
               .cases = cases,
               .hits = hits,
               .interval = clopper_pearson(hits, cases, kTwoSidedTail),
               .one_sided = clopper_pearson(hits, cases, kOneSidedTail)};
}

std::optional<Score> bootstrap_score(std::size_t cases, const Statistic& statistic) {
  if (cases == 0) return std::nullopt;
  std::vector<std::size_t> rows(cases);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  Score score{.value = statistic(rows), .cases = static_cast<int>(cases)};
  if (score.cases < kBootstrapCasesMin) return score;

  Rng rng(kBootstrapSeed);
  std::vector<double> resampled(kBootstrapResamples);
  for (double& value : resampled) {
    for (std::size_t& row : rows) row = static_cast<std::size_t>(rng.below(cases));
    value = statistic(rows);
  }
  std::ranges::sort(resampled);
  score.interval = {quantile_of_sorted(resampled, kTwoSidedTail),
                    quantile_of_sorted(resampled, 1.0 - kTwoSidedTail)};
  score.one_sided = {quantile_of_sorted(resampled, kOneSidedTail),
                     quantile_of_sorted(resampled, 1.0 - kOneSidedTail)};
  return score;
}

std::optional<Score> median_score(std::vector<double> values) {
  const std::size_t cases = values.size();
  return bootstrap_score(cases, [&](std::span<const std::size_t> rows) {
    return quantile_of(picked(values, rows), 0.5);
  });
}

std::optional<Score> mean_score(std::vector<double> values) {
  const std::size_t cases = values.size();
  return bootstrap_score(cases, [&](std::span<const std::size_t> rows) {
    double sum = 0.0;
    for (const std::size_t row : rows) sum += values[row];
    return sum / static_cast<double>(rows.size());
  });
}

double quantile_of(std::vector<double> values, double probability) {
  std::ranges::sort(values);
  return quantile_of_sorted(values, probability);
}

}  // namespace recald::blind
