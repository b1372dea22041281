/// Counts calls of operator new, for code that promises not to allocate.
#pragma once

#include <Eigen/Core>

namespace recald::testing {

/// Calls so far in this program, from all threads. Link tests/support/allocations.cpp, which
/// replaces the global operators.
[[nodiscard]] long allocation_count();

/// Eigen allocates through malloc, which a counting operator new does not see. Where it may not and
/// assertions are on, an allocation of its own ends the program.
inline void let_eigen_allocate([[maybe_unused]] bool allowed) {
#ifdef EIGEN_RUNTIME_NO_MALLOC
  Eigen::internal::set_is_malloc_allowed(allowed);
#endif
}

}  // namespace recald::testing
