/// Durations counted in classes, from which percentiles can be read later, unlike from a mean
/// or a last value.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>

namespace recald::daemon {

class LatencyHistogram {
 public:
  /// Upper bounds of the classes, inclusive; longer durations are only in `count`. A poll may be
  /// 100 ms late, so that is one of them.
  static constexpr std::array<double, 13> kBounds_s{0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1,
                                                    0.25,  0.5,    1.0,   2.5,  5.0,   10.0};

  /// A negative duration (the clock was set) counts as zero.
  void observe(std::chrono::milliseconds length) {
    const double length_s = std::max(0.0, std::chrono::duration<double>(length).count());
    for (std::size_t i = 0; i < kBounds_s.size(); ++i) {
      if (length_s <= kBounds_s[i]) ++at_most_[i];
    }
    ++count_;
    sum_s_ += length_s;
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] double sum_s() const { return sum_s_; }
  /// The number of durations within each bound.
  [[nodiscard]] const std::array<std::uint64_t, kBounds_s.size()>& at_most() const {
    return at_most_;
  }

 private:
  std::array<std::uint64_t, kBounds_s.size()> at_most_{};
  std::uint64_t count_ = 0;
  double sum_s_ = 0.0;
};

}  // namespace recald::daemon
