#include "daemon/gateway/poll/learned_timeout.hpp"

#include <algorithm>

namespace recald::daemon {

using std::chrono::milliseconds;

milliseconds LearnedTimeout::learned() const {
  if (answers_ < kEnough) return kUnknown;
  const std::size_t kept = std::min(answers_, kAnswers);
  auto sorted = durations_ms_;
  // The 99 % quantile: the second largest of 128.
  const auto quantile = sorted.begin() + static_cast<std::ptrdiff_t>((99 * kept + 99) / 100 - 1);
  std::nth_element(sorted.begin(), quantile, sorted.begin() + static_cast<std::ptrdiff_t>(kept));
  return std::clamp(4 * milliseconds{*quantile}, kMin, kMax);
}

milliseconds LearnedTimeout::timeout() const {
  if (fixed_ > milliseconds{0}) return fixed_;
  milliseconds wait = learned();
  for (int miss = 0; miss < misses_ && wait < kMax; ++miss) wait = std::min(2 * wait, kMax);
  return wait;
}

milliseconds LearnedTimeout::probe_timeout() const {
  return fixed_ > milliseconds{0} ? fixed_ : std::min(2 * learned(), kMax);
}

void LearnedTimeout::answered(milliseconds duration) {
  durations_ms_[answers_ % kAnswers] =
      static_cast<std::uint16_t>(std::clamp<std::int64_t>(duration.count(), 0, 65'535));
  ++answers_;
  misses_ = 0;
}

void LearnedTimeout::missed() { misses_ = std::min(misses_ + 1, 8); }

}  // namespace recald::daemon
