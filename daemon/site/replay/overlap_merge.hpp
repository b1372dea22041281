/// Readings of several files of the same meters: a portal's monthly downloads overlap, and later
/// ones correct earlier ones.
#pragma once

#include <cstdint>
#include <vector>

#include "adapters/csv/readings_csv.hpp"
#include "core/metering/reading.hpp"

namespace recald::daemon {

/// Where several files have an interval, the later file's value counts; a blank of it corrects
/// nothing. Keeps up to some two years of each meter in memory.
class OverlapMerge {
 public:
  /// @param sink  Outlives this. Receives each meter's readings in order of time.
  OverlapMerge(std::size_t meters, const csv::ReadingsSink& sink) : sink_(sink), meters_(meters) {}

  void take(const metering::Reading& reading) { meters_[reading.meter].of_file.push_back(reading); }
  /// All of a file was taken.
  void end_file();
  /// Passes on what is left.
  void finish();

  [[nodiscard]] std::uint64_t repeated() const { return repeated_; }    ///< In several files.
  [[nodiscard]] std::uint64_t corrected() const { return corrected_; }  ///< Of these, changed.

 private:
  struct OneMeter {
    std::vector<metering::Reading> held;  ///< In order of time, an interval once.
    std::vector<metering::Reading> of_file;
  };
  void merge(OneMeter& meter);
  void hand_on(OneMeter& meter, metering::Instant until);

  const csv::ReadingsSink& sink_;
  std::vector<OneMeter> meters_;
  std::uint64_t repeated_ = 0;
  std::uint64_t corrected_ = 0;
};

}  // namespace recald::daemon
