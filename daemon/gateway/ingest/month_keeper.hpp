/// Closes months from the stored readings when they are due, and again after late readings.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adapters/ports/store.hpp"
#include "core/metering/months/month_closer.hpp"

namespace recald::daemon {

/// A meter and its number in the store.
struct StoredMeter {
  std::uint32_t number;
  metering::Meter meter;
};

struct ClosedFigure {
  std::uint32_t number;
  metering::MonthlyFigure figure;  ///< With its revision in the store.
};

/// A month's figure from the stored readings, computed as in a replay.
/// @param known_until  Readings that start later are ignored, as if they had not arrived yet.
[[nodiscard]] Result<metering::MonthlyFigure> stored_figure(
    Store& store, const metering::LocalCalendar& calendar, const metering::CloserOptions& options,
    const StoredMeter& meter, metering::Month month,
    metering::Instant known_until = metering::Instant::max());

/// The months whose figures depend on a reading: its own; the next one, whose checks use the
/// meter's earlier behaviour; and the previous one, if the reading starts soon after it.
[[nodiscard]] std::vector<metering::Month> months_that_depend_on(
    metering::Instant start, const metering::LocalCalendar& calendar);

/// Keeps nothing in memory between two calls, so a restart loses and repeats nothing. A figure is
/// computed from the stored readings, as in a replay.
class MonthKeeper {
 public:
  MonthKeeper(Store& store, metering::LocalCalendar calendar, metering::CloserOptions options,
              std::string time_zone_release);

  /// Closes the months of each meter that ended a watermark ago, from its first reading on, and
  /// those that were reopened. If a meter's rules have changed, all its closed months are reopened
  /// first, once, and an event reports it.
  /// @param on_closed  Called for each month as soon as it is stored; may be empty.
  /// @param at_most    Most months to close in this call, of all meters together; the
  ///                   next call continues.
  /// @return the new figures in order of meter and month, or the store's failure; months closed
  ///         before the failure stay closed.
  [[nodiscard]] Result<std::vector<ClosedFigure>> close_due(
      std::span<const StoredMeter> meters, metering::Instant now,
      const std::function<void(const ClosedFigure&)>& on_closed = {},
      std::size_t at_most = std::numeric_limits<std::size_t>::max());

  /// Months close by these rules from now on; those closed by other rules are closed again.
  void set_options(metering::CloserOptions options) { options_ = std::move(options); }

 private:
  [[nodiscard]] Result<void> take_rules(const StoredMeter& meter, metering::Instant now);
  [[nodiscard]] Result<std::vector<metering::Month>> due(const StoredMeter& meter,
                                                         std::span<const MeterMonth> reopened,
                                                         metering::Instant now) const;

  Store& store_;
  metering::LocalCalendar calendar_;
  metering::CloserOptions options_;
  std::string time_zone_release_;
};

}  // namespace recald::daemon
