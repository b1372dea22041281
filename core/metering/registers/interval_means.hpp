/// Forms intervals on the grid from values over spans of any other length.
#pragma once

#include <chrono>
#include <functional>
#include <optional>

#include "core/metering/reading.hpp"

namespace recald::metering {

/// Adds up spans of mean power, such as values of ten seconds, or of seven minutes, and passes on
/// the mean of each interval. A span that lies in two intervals counts in each for its part, so
/// energy is neither lost nor gained.
class IntervalMeans {
 public:
  using Sink = std::function<void(const Reading&)>;

  /// @param phase  By which interval starts lie after multiples of the interval since 1970.
  IntervalMeans(std::uint32_t meter, std::chrono::seconds interval, std::chrono::seconds phase)
      : meter_{meter}, interval_{interval}, phase_{phase} {}

  /// Takes a value over a span, and passes on the intervals that end before it. What begins before
  /// the last span ended is cut off. An interval is the mean over what of it has values, if these
  /// cover four fifths of it, else it is missing, reason `partial`. It is `scaled` if a value is.
  /// @param value  Its `start` is not looked at; without a value if it is missing, filled or
  /// suspect.
  void take(const TimeSpan& span, const Reading& value, const Sink& sink);

  /// Passes on the last interval.
  void finish(const Sink& sink);

 private:
  void add(const TimeSpan& part, const Reading& value);

  std::uint32_t meter_;
  std::chrono::seconds interval_;
  std::chrono::seconds phase_;
  std::optional<Instant> open_;     ///< Start of the interval that is added up.
  Instant until_ = Instant::min();  ///< End of the last span.
  std::chrono::seconds covered_{0};
  double energy_kWh_ = 0.0;
  Validity validity_ = Validity::ok;
  Reason reasons_ = Reason::none;
};

}  // namespace recald::metering
