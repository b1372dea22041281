/// Scores with what their number of cases allows to say about them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace recald::blind {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// An estimate, its 95 % interval, and the two bounds that each hold with 95 % taken alone.
struct Score {
  double value = 0.0;
  int cases = 0;                      ///< What the value is made from.
  std::optional<int> hits;            ///< For a share: value = hits / cases.
  std::optional<Interval> interval;   ///< Two-sided 95 %; absent: too few cases, or none exists.
  std::optional<Interval> one_sided;  ///< Lower 95 % bound, upper 95 % bound.
};

/// Exact (Clopper-Pearson) interval of a share: `tail` is left out on either side.
/// @pre 0 <= hits <= cases, cases > 0, 0 < tail < 0.5
/// @see Clopper, Pearson (1934), Biometrika 26(4); quantiles of the beta distribution.
[[nodiscard]] Interval clopper_pearson(int hits, int cases, double tail);

/// A share with its Clopper-Pearson interval and bounds; empty without cases.
[[nodiscard]] std::optional<Score> share_score(int hits, int cases);

/// Of rows 0 … cases − 1, drawn with replacement (or the cases themselves), the statistic.
using Statistic = std::function<double(std::span<const std::size_t> rows)>;

inline constexpr std::uint64_t kBootstrapSeed = 2026;
inline constexpr int kBootstrapResamples = 2000;
/// Below this many cases a resampled interval is far too narrow; none is given.
inline constexpr int kBootstrapCasesMin = 6;

/// The statistic with its percentile bootstrap interval: `kBootstrapResamples` resamples of the
/// cases, always from `kBootstrapSeed`, so that every score can be computed again by itself.
/// @see Efron, Tibshirani (1993), An Introduction to the Bootstrap, ch. 13.
[[nodiscard]] std::optional<Score> bootstrap_score(std::size_t cases, const Statistic& statistic);

[[nodiscard]] std::optional<Score> median_score(std::vector<double> values);
[[nodiscard]] std::optional<Score> mean_score(std::vector<double> values);

/// The quantile of unsorted values (type 7 of Hyndman and Fan, 1996). @pre not empty
[[nodiscard]] double quantile_of(std::vector<double> values, double probability);

}  // namespace recald::blind
