#include "simulators/energyplus/parts/habits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "simulators/chance/chance.hpp"

namespace recald::simulators::energyplus {
namespace {

HourlyShares following(const HourlyShares& presence, double standing, double span) {
  HourlyShares shares{};
  for (std::size_t hour = 0; hour < shares.size(); ++hour) {
    shares[hour] = standing + span * presence[hour];
  }
  return shares;
}

const HourlyShares& day_of(const WeeklyShares& shares, DayKind kind) {
  if (kind == DayKind::workday) return shares.workday;
  return kind == DayKind::saturday ? shares.saturday : shares.sunday;
}

/// What a day of one year is like for everybody.
struct DayHabit {
  DayKind kind;
  double attendance;  ///< Of the people who come by the drawings.
  double late_h;
  double left_on;  ///< Factor on what stands.
};

std::vector<DayHabit> habits_of(int year, const Calendar& calendar, std::uint64_t seed) {
  constexpr double kFridays = 0.9;
  constexpr double kAttendanceSpread = 0.05;  // Of the days, and of the weeks.
  constexpr double kLateSpread_h = 0.3;
  constexpr double kLeftOnSpread = 0.04;
  constexpr double kWeeks_s = 14.0 * kDay_s;
  Rng rng = stream_of(seed, Stream::people, static_cast<std::uint64_t>(year));
  Persistence weeks(kWeeks_s, kDay_s, rng);
  std::vector<DayHabit> days;
  const std::chrono::sys_days end{std::chrono::year{year + 1} / 1 / 1};
  for (std::chrono::sys_days at{std::chrono::year{year} / 1 / 1}; at < end;
       at += std::chrono::days{1}) {
    const metering::Day day{at};
    const bool is_friday = std::chrono::weekday{at} == std::chrono::Friday;
    const double chance = std::exp(kAttendanceSpread * (weeks.advance(rng) + rng.normal()));
    days.push_back(
        {.kind = calendar.kind_of(day),
         .attendance = calendar.season_attendance(day) * chance * (is_friday ? kFridays : 1.0),
         .late_h = std::clamp(kLateSpread_h * rng.normal(), -1.0, 1.0),
         .left_on = std::exp(kLeftOnSpread * rng.normal())});
  }
  return days;
}

/// The share an hour before or after, in proportion.
double shifted(const HourlyShares& shares, std::size_t hour, double late_h) {
  const std::size_t other =
      late_h > 0.0 ? (hour == 0 ? hour : hour - 1) : std::min(hour + 1, shares.size() - 1);
  return std::lerp(shares[hour], shares[other], std::abs(late_h));
}

double share_at(const PeopleSchedule& schedule, const DayHabit& day, std::size_t hour) {
  const double present =
      day.attendance * shifted(day_of(schedule.presence, day.kind), hour, day.late_h);
  // EnergyPlus takes no share above one.
  return std::min(schedule.standing * day.left_on + schedule.span * present, 1.0);
}

}  // namespace

WeeklyShares PeopleSchedule::weekly() const {
  return {following(presence.workday, standing, span), following(presence.saturday, standing, span),
          following(presence.sunday, standing, span)};
}

Habits with_habits(Json model, const std::vector<PeopleSchedule>& schedules, int year,
                   const Calendar& calendar, std::uint64_t seed, const std::string& file) {
  const std::vector<DayHabit> days = habits_of(year, calendar, seed);
  Habits habits{.model = std::move(model), .csv = {}};
  for (std::size_t column = 0; column < schedules.size(); ++column) {
    const std::string& name = schedules[column].name;
    habits.model["Schedule:File"][name] = {
        {"schedule_type_limits_name",
         habits.model["Schedule:Compact"][name]["schedule_type_limits_name"]},
        {"file_name", file},
        {"column_number", column + 1},
        {"rows_to_skip_at_top", 1},
        {"number_of_hours_of_data", 24 * days.size()},
        {"column_separator", "Comma"},
        {"interpolate_to_timestep", "No"},
        {"minutes_per_item", 60},
        {"adjust_schedule_for_daylight_savings", "Yes"}};
    habits.model["Schedule:Compact"].erase(name);
    habits.csv += (column == 0 ? "" : ",") + name;
  }
  habits.csv += '\n';
  for (const DayHabit& day : days) {
    for (std::size_t hour = 0; hour < 24; ++hour) {
      for (std::size_t column = 0; column < schedules.size(); ++column) {
        habits.csv +=
            fmt::format("{}{:.4f}", column == 0 ? "" : ",", share_at(schedules[column], day, hour));
      }
      habits.csv += '\n';
    }
  }
  return habits;
}

}  // namespace recald::simulators::energyplus
