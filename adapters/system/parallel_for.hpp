/// Threads for core's loops.
#pragma once

#include "core/executor.hpp"

namespace recald::system {

/// Runs the turns of a loop on up to `threads` threads, 0 meaning one a core. An exception of a
/// turn reaches the caller once all threads have ended.
[[nodiscard]] ForEachIndex parallel_for(unsigned threads = 0);

}  // namespace recald::system
