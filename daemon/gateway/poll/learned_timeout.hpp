/// How long to wait for a device, learned from its earlier response times.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>

namespace recald::daemon {

/// Four times the 99 % quantile of the last 128 answers, between 200 ms and 5 s; 1 s until eight
/// answers are known. Each miss doubles it until the next answer, so that a device that became slow
/// is found again. (A device that answers within 600 ms loses 707 of 1000 reads at 300 ms and none
/// at 600: stephane/libmodbus#776.)
class LearnedTimeout {
 public:
  static constexpr std::chrono::milliseconds kMin{200};
  static constexpr std::chrono::milliseconds kMax{5'000};
  static constexpr std::chrono::milliseconds kUnknown{1'000};

  /// @param fixed  Set by the user, then nothing is learned; zero: learn.
  explicit LearnedTimeout(std::chrono::milliseconds fixed = {}) : fixed_(fixed) {}

  [[nodiscard]] std::chrono::milliseconds timeout() const;
  /// For probing a dead device: twice the learned time-out, however often it was missed.
  [[nodiscard]] std::chrono::milliseconds probe_timeout() const;

  void answered(std::chrono::milliseconds duration);
  void missed();

 private:
  static constexpr std::size_t kAnswers = 128;
  static constexpr std::size_t kEnough = 8;

  [[nodiscard]] std::chrono::milliseconds learned() const;

  std::chrono::milliseconds fixed_;
  std::array<std::uint16_t, kAnswers> durations_ms_{};
  std::size_t answers_ = 0;  ///< So far; the last kAnswers of them are kept.
  int misses_ = 0;           ///< Since the last answer.
};

}  // namespace recald::daemon
