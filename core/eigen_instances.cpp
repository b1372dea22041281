#include "core/eigen_instances.hpp"

RECALD_EIGEN_INSTANCES()

/// What the linker is told to look for first (core/CMakeLists.txt).
extern "C" {
extern const int recald_fast_eigen;
const int recald_fast_eigen = 1;
}
