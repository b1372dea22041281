/// Limits of what others send, pushed or in messages.
#pragma once

#include <chrono>

namespace recald::daemon {

inline constexpr double kSentValueMax =
    1e18;  ///< Keeps values finite after any unit and multiplier.
/// A sender's clock may be ahead of ours by so much.
inline constexpr std::chrono::seconds kClocksDiffer{300};

}  // namespace recald::daemon
