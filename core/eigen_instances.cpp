#include "core/eigen_instances.hpp"

RECALD_EIGEN_INSTANCES()
