/// Seeded random numbers that are the same on every platform and standard library.
///
/// `std::` distributions differ between libraries, so the few we need are here.
#pragma once

#include <cstdint>

namespace recald {

/// xoshiro256++ seeded through splitmix64.
///
/// A stream is (seed, stream): streams of one seed are independent for our purposes, so chain k of
/// a calibration draws from `Rng{seed, k}` and does not depend on how many chains run beside it.
/// @see Blackman, Vigna (2021), ACM Trans. Math. Softw. 47(4), scrambled linear generators.
class Rng {
 public:
  explicit Rng(std::uint64_t seed, std::uint64_t stream = 0);

  std::uint64_t next();

  /// Uniform on the open interval (0, 1): never 0 and never 1, so logs and quantiles are finite.
  double uniform();

  /// Uniform on (low, high).
  double uniform(double low, double high);

  /// Uniform on {0, …, bound − 1}, without modulo bias. @pre bound > 0
  std::uint64_t below(std::uint64_t bound);

  /// Standard normal, polar method (Marsaglia), one spare kept.
  double normal();

 private:
  std::uint64_t state_[4];
  double spare_normal_ = 0.0;
  bool has_spare_normal_ = false;
};

}  // namespace recald
