/// Counts calls of operator new, for code that promises not to allocate.
#pragma once

namespace recald::testing {

/// Calls so far in this program, from all threads. Link tests/support/allocations.cpp, which
/// replaces the global operators.
[[nodiscard]] long allocation_count();

}  // namespace recald::testing
