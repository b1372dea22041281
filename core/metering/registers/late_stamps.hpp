/// Registers whose stamps lie some seconds beside their grid: read then, or read on the grid and
/// stamped when somebody wrote them down?
#pragma once

#include <chrono>
#include <span>
#include <vector>

#include "core/metering/registers/counter.hpp"

namespace recald::metering {

/// Stamps may lie beside the start of an interval by one in so many parts of it, or nobody knows
/// which one they mean.
inline constexpr int kToleranceShare = 5;

enum class StampsBeside {
  none,     ///< All on the grid, or beside it by the same.
  as_read,  ///< Energy rises with the stamps: they are when the register was read.
  as_grid,  ///< It rises with the grid.
  unclear,
};

/// Compares the energy between two samples with the time between their stamps, relative to the load
/// around them. Of samples that were read when they say, a stamp 30 s late brings 30 s of energy;
/// of others it brings none. The slope of one on the other is near 1 or near 0, and decides if it
/// lies by two of its standard errors on one side of a half.
/// @param samples  In order of time, mostly one for each interval.
[[nodiscard]] StampsBeside judge_stamps(std::span<const RegisterSample> samples,
                                        std::chrono::seconds interval);

/// Puts samples that lie up to a fifth of an interval and two minutes beside it on the grid.
void put_on_grid(std::vector<RegisterSample>& samples, std::chrono::seconds interval);

}  // namespace recald::metering
