/// What a meter's record shows about its quality, in words for people.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/metering/months/level_change.hpp"
#include "core/metering/months/month_closer.hpp"
#include "core/metering/months/month_slots.hpp"

namespace recald::metering {

/// Consecutive slots that are not plainly measured, all for the same reasons.
struct Episode {
  TimeSpan span;
  int slots;
  bool suspect;  ///< Values came but were rejected; otherwise none came.
  Reason reasons;
  bool operator==(const Episode&) const = default;
};

/// Episodes of one closed month, in order.
[[nodiscard]] std::vector<Episode> find_episodes(const MonthSlots& month);

/// Joins episodes that meet at a month's end.
[[nodiscard]] std::vector<Episode> join_episodes(std::vector<Episode> episodes);

/// Something that people should know about a meter's data.
struct DataFinding {
  enum class Grade { note, warning };
  std::string meter;
  std::string sentence;
  TimeSpan span;  ///< From the first to the last slot concerned.
  int slots;
  Grade grade = Grade::note;
};

/// One finding for each kind of episode (naming the longest one), for conflicts and refused
/// readings, for unusable months, and for each level change.
///
/// A run of zeros that the settings accept as load is also reported if it is longer than three
/// days, because only the owner can know whether it means "no load" or "no data".
/// @param zero_runs  Runs of exact zeros that passed as `ok`, see `find_believed_zero_runs`.
/// @param is_rated   Whether somebody says how much the meter can measure.
[[nodiscard]] std::vector<DataFinding> describe_data(
    std::string_view meter, const std::vector<Episode>& episodes,
    const std::vector<TimeSpan>& zero_runs, const std::vector<MonthlyFigure>& figures,
    const std::vector<LevelChange>& changes, const MeterCounts& counts,
    const LocalCalendar& calendar, bool is_rated = true);

/// Runs of exact zeros within the month that count as measured.
[[nodiscard]] std::vector<TimeSpan> find_believed_zero_runs(const MonthSlots& month);

}  // namespace recald::metering
