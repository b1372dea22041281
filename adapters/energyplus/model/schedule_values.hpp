/// What a schedule of a model says, day by day, in whatever way the model writes it down.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/energyplus/model/model_document.hpp"

namespace recald::energyplus {

/// EnergyPlus's kinds of days: Sunday first, then holidays, days for sizing, and two of the user's.
enum DayKind : std::size_t {
  kSunday,
  kMonday,
  kTuesday,
  kWednesday,
  kThursday,
  kFriday,
  kSaturday,
  kHoliday,
  kSummerDesignDay,
  kWinterDesignDay,
  kCustomDay1,
  kCustomDay2,
  kDayKinds
};

inline constexpr int kMinutesADay = 1440;

/// A value up to a minute of the day.
struct UntilValue {
  int minute;  ///< Up to `kMinutesADay`.
  double value;
  bool operator==(const UntilValue&) const = default;
};
using DayValues = std::vector<UntilValue>;  ///< In order of time; the last one ends the day.

/// A part of the year.
struct ScheduleSpan {
  int month;  ///< Of the last day …
  int day;    ///< … and the day itself.
  std::array<DayValues, kDayKinds> days;
};

struct ScheduleValues {
  std::string type_limits;          ///< Of the schedule, or empty.
  std::vector<ScheduleSpan> spans;  ///< In order of time; the last one ends the year.
};

/// @param name  Of a compact, constant or yearly schedule; letter case does not matter.
/// @return nothing: no such schedule, a file's, or one that interpolates.
[[nodiscard]] std::optional<ScheduleValues> read_schedule(const Json& objects,
                                                          std::string_view name);

/// As an object of type Schedule:Compact.
[[nodiscard]] Json compact_schedule(const ScheduleValues& schedule);

}  // namespace recald::energyplus
