/// Runs core's loops on threads.
#pragma once

#include "core/executor.hpp"

namespace recald::system {

/// Runs the iterations of a loop on up to `threads` threads; 0 means one per core. An exception of
/// an iteration reaches the caller once all threads have ended.
[[nodiscard]] ForEachIndex parallel_for(unsigned threads = 0);

}  // namespace recald::system
