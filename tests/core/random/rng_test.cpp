#include "core/random/rng.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace recald {
namespace {

TEST(Rng, SameSeedSameNumbersOtherSeedOrStreamOthers) {
  Rng a(42, 3);
  Rng b(42, 3);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(a.next(), b.next());
  std::set<std::uint64_t> firsts;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    for (std::uint64_t stream = 0; stream < 40; ++stream) firsts.insert(Rng(seed, stream).next());
  }
  EXPECT_EQ(firsts.size(), 1600u);
}

// Computed with a second implementation, in Python's integers, of xoshiro256++ and splitmix64: a
// seed stored with a result has to mean the same numbers on every machine.
TEST(Rng, NumbersOfASeedAreFixed) {
  Rng rng(1);
  EXPECT_EQ(rng.next(), 5226295891941712017ULL);
  EXPECT_EQ(rng.next(), 5547022123706608281ULL);
  EXPECT_EQ(rng.next(), 18144476329041699521ULL);
  EXPECT_EQ(Rng(2026, 7).next(), 12735541502660354759ULL);
}

// Kolmogorov-Smirnov: sqrt(n) D stays below 1.95 with probability 0.999.
TEST(Rng, UniformIsUniformAndOpen) {
  Rng rng(1);
  constexpr int n = 100'000;
  std::vector<double> values(n);
  for (double& value : values) value = rng.uniform();
  std::sort(values.begin(), values.end());
  EXPECT_GT(values.front(), 0.0);
  EXPECT_LT(values.back(), 1.0);
  double largest = 0.0;
  for (int i = 0; i < n; ++i) {
    largest = std::max(largest, std::abs(values[static_cast<std::size_t>(i)] - (i + 0.5) / n));
  }
  EXPECT_LT(std::sqrt(static_cast<double>(n)) * largest, 1.95);
}

TEST(Rng, NormalHasTheMomentsAndTailsOfANormal) {
  Rng rng(2);
  constexpr int n = 400'000;
  double sum = 0.0;
  double squares = 0.0;
  double fourths = 0.0;
  int beyond_two = 0;
  for (int i = 0; i < n; ++i) {
    const double z = rng.normal();
    sum += z;
    squares += z * z;
    fourths += z * z * z * z;
    beyond_two += std::abs(z) > 2.0;
  }
  // Standard errors: 1, sqrt(2), sqrt(96), sqrt(p (1 - p)) over sqrt(n); four of each.
  const double root = std::sqrt(static_cast<double>(n));
  EXPECT_NEAR(sum / n, 0.0, 4.0 / root);
  EXPECT_NEAR(squares / n, 1.0, 4.0 * std::sqrt(2.0) / root);
  EXPECT_NEAR(fourths / n, 3.0, 4.0 * std::sqrt(96.0) / root);
  EXPECT_NEAR(beyond_two / static_cast<double>(n), 0.0455003, 4.0 * 0.2084 / root);
}

TEST(Rng, BelowHitsEveryValueEquallyOften) {
  Rng rng(3);
  constexpr int n = 70'000;
  std::vector<int> counts(7, 0);
  for (int i = 0; i < n; ++i) ++counts[static_cast<std::size_t>(rng.below(7))];
  double chi_squared = 0.0;
  for (const int count : counts) chi_squared += std::pow(count - n / 7.0, 2) / (n / 7.0);
  EXPECT_LT(chi_squared, 22.5);  // 99.9 % quantile with 6 degrees of freedom
  EXPECT_EQ(rng.below(1), 0u);
}

TEST(Rng, UniformOnAnInterval) {
  Rng rng(4);
  for (int i = 0; i < 10'000; ++i) {
    const double value = rng.uniform(-3.0, 5.0);
    EXPECT_GT(value, -3.0);
    EXPECT_LT(value, 5.0);
  }
}

// Streams of one seed as chains use them: no correlation beyond chance.
TEST(Rng, StreamsOfOneSeedAreUncorrelated) {
  constexpr int n = 20'000;
  for (std::uint64_t stream = 0; stream < 5; ++stream) {
    Rng a(7, stream);
    Rng b(7, stream + 1);
    double product = 0.0;
    for (int i = 0; i < n; ++i) product += a.normal() * b.normal();
    EXPECT_LT(std::abs(product) / std::sqrt(static_cast<double>(n)), 4.0);
  }
}

}  // namespace
}  // namespace recald
