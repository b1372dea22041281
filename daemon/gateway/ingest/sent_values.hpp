/// Limits of what others send, pushed or in messages.
#pragma once

#include <chrono>

namespace recald::daemon {

inline constexpr double kSentValueMax =
    1e18;  ///< Keeps values finite after any unit and multiplier.
/// A sender's clock may be ahead of ours by so much.
inline constexpr std::chrono::seconds kClocksDiffer{300};
/// What is older was stamped by a clock that was never set, or belongs in a file.
inline constexpr std::chrono::days kSentOldest{400};

}  // namespace recald::daemon
