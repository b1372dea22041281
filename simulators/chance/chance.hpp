/// Random building blocks of the simulation: triangular draws and persistent values.
#pragma once

#include "core/random/rng.hpp"

namespace recald::simulators {

inline constexpr double kDay_s = 86'400.0;

/// One `Rng` stream per purpose, so that a new draw in one does not change the others.
enum class Stream : std::uint64_t {
  weather = 1,
  building = 2,
  people = 3,
  loads = 4,
  hot_water = 5,
  weather_station = 6,
  meter_noise = 16,   ///< + index of the meter
  meter_faults = 32,  ///< + index of the meter
  neighbour = 48,
  decoys = 49,
  effects = 64,  ///< + index of the kind of effect
};

[[nodiscard]] inline Rng stream_of(std::uint64_t seed, Stream stream, std::uint64_t index = 0) {
  return Rng{seed, static_cast<std::uint64_t>(stream) + index};
}

struct Triangular {
  double min;
  double mode;
  double max;

  /// Inverse of the distribution function. @pre 0 < u < 1, min <= mode <= max, min < max
  [[nodiscard]] double quantile(double u) const;
  [[nodiscard]] double draw(Rng& rng) const { return quantile(rng.uniform()); }
};

/// Nominal times Triangular(1 − spread, 1, 1 + spread).
[[nodiscard]] double draw_around(Rng& rng, double nominal, double spread);

/// A standard normal value that persists over a time constant (Ornstein-Uhlenbeck, exact).
class Persistence {
 public:
  Persistence(double time_constant_s, double step_s, Rng& rng);

  double advance(Rng& rng) { return value_ = keep_ * value_ + renew_ * rng.normal(); }
  [[nodiscard]] double value() const { return value_; }

 private:
  double keep_;
  double renew_;
  double value_;
};

/// Exponentially distributed waiting time with this mean.
[[nodiscard]] double draw_waiting_time(Rng& rng, double mean);

}  // namespace recald::simulators
