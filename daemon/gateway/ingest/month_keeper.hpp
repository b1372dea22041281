/// Closes months from the stored readings when they are due, and again after late readings.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "adapters/ports/store.hpp"
#include "core/metering/month_closer.hpp"

namespace recald::daemon {

/// A meter and the number that stands for it in the store.
struct StoredMeter {
  std::uint32_t number;
  metering::Meter meter;
};

struct ClosedFigure {
  std::uint32_t number;
  metering::MonthlyFigure figure;  ///< With the revision that it has in the store.
};

/// A month's figure from the stored readings, by the rules of a replay.
/// @param known_until  Readings that start later are left out, as if they had not come yet.
[[nodiscard]] Result<metering::MonthlyFigure> stored_figure(
    Store& store, const metering::LocalCalendar& calendar, const metering::CloserOptions& options,
    const StoredMeter& meter, metering::Month month,
    metering::Instant known_until = metering::Instant::max());

/// The months whose figures depend on a reading: its own; the next one, which is judged by how its
/// meter behaved before; and the previous one, if the reading starts soon after it.
[[nodiscard]] std::vector<metering::Month> months_that_depend_on(
    metering::Instant start, const metering::LocalCalendar& calendar);

/// Nothing is kept in memory between two calls: a restart in the middle loses nothing and repeats
/// nothing, and a figure is made of what is stored, by the rules of a replay.
class MonthKeeper {
 public:
  MonthKeeper(Store& store, metering::LocalCalendar calendar, metering::CloserOptions options,
              std::string time_zone_release);

  /// Closes the months of each meter that ended a watermark ago, from its first reading on, and
  /// those that were reopened. A meter whose rules have changed since has all its closed months
  /// reopened first, once; an event says so.
  /// @param on_closed  Is told of each as soon as it is stored; may be empty.
  /// @return the new figures in order of meter and month, or the store's failure; what was closed
  ///         before it stays closed.
  /// @param at_most    So many months of all meters together; the others at the next call.
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
