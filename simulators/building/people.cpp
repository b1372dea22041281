#include "simulators/building/people.hpp"

#include <algorithm>
#include <cmath>

#include "simulators/building/campus_calendar.hpp"

namespace recald::simulators {
namespace {

/// People per area relative to the building's mean; laboratories are emptier than offices.
constexpr double kOfficeCrowding = 1.35;

std::size_t draw_zone(Rng& rng) {
  using namespace drawings;
  constexpr double office_share = kOfficeCrowding * office_area_m2 / floor_area_m2;
  const std::size_t storey = rng.below(storeys);
  if (rng.uniform() >= office_share) return storey * zones_per_storey + laboratory;
  double place_m2 = rng.uniform() * (storey_area_m2 - core_area_m2);
  std::size_t side = south;
  while (side < west && place_m2 >= zone_area_m2[side]) place_m2 -= zone_area_m2[side++];
  return storey * zones_per_storey + side;
}

/// Monday to Sunday; working days only matter from Monday to Friday.
constexpr std::array<double, 7> kWeekdayAttendance{0.95, 1.0, 1.0, 0.97, 0.86, 1.0, 1.0};

}  // namespace

People::People(double density_person_m2, Rng rng) : rng_(rng) {
  const auto count = static_cast<std::size_t>(
      std::lround(std::max(0.0, density_person_m2) * drawings::floor_area_m2));
  people_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t zone = draw_zone(rng_);
    const bool researcher = zone % drawings::zones_per_storey == drawings::laboratory;
    people_.push_back({.zone = zone,
                       .arrival_h = (researcher ? 9.0 : 8.5) + 0.8 * rng_.normal(),
                       .stay_h = (researcher ? 9.2 : 8.7) + 0.7 * rng_.normal(),
                       .weekend_share = rng_.uniform() * (researcher ? 0.25 : 0.08),
                       .evening_share = rng_.uniform() * (researcher ? 0.16 : 0.04),
                       .days_away = 0});
    ++assigned_[zone];
  }
}

void People::attend(std::size_t zone, double from_h, double to_h) {
  // Whoever stays past midnight goes home at midnight: no one is counted twice.
  const int first = std::clamp(static_cast<int>(std::lround(from_h * 12.0)), 0, 288);
  const int last = std::clamp(static_cast<int>(std::lround(to_h * 12.0)), 0, 288);
  for (int slot = first; slot < last; ++slot) ++present_[zone][static_cast<std::size_t>(slot)];
}

void People::plan_day(Person& person, metering::Day day, double attendance) {
  if (person.days_away > 0) {
    --person.days_away;
    return;
  }
  if (day_kind(day) != DayKind::workday) {
    if (rng_.uniform() >= person.weekend_share) return;
    const double from_h = 11.0 + 2.0 * rng_.normal();
    attend(person.zone, from_h, from_h + 2.0 + 3.0 * rng_.uniform());
    return;
  }
  if (rng_.uniform() < 0.009) {
    person.days_away = 2 + static_cast<int>(rng_.below(12));
    return;
  }
  if (rng_.uniform() >= attendance) return;
  const double from_h = person.arrival_h + 0.45 * rng_.normal();
  const double to_h = from_h + std::max(1.0, person.stay_h + 0.8 * rng_.normal());
  const double lunch_h = 12.2 + 0.5 * rng_.normal();
  const bool lunches_out = rng_.uniform() < 0.6 && lunch_h > from_h && lunch_h + 0.8 < to_h;
  if (lunches_out) {
    attend(person.zone, from_h, lunch_h);
    attend(person.zone, lunch_h + 0.4 + 0.5 * rng_.uniform(), to_h);
  } else {
    attend(person.zone, from_h, to_h);
  }
  if (rng_.uniform() < person.evening_share) {
    attend(person.zone, std::max(to_h, 19.5), std::max(to_h, 19.5) + 1.0 + 2.5 * rng_.uniform());
  }
}

void People::begin_day(metering::Day day) {
  for (auto& slots : present_) slots.fill(0);
  const unsigned weekday = std::chrono::weekday{std::chrono::sys_days{day}}.iso_encoding() - 1;
  // Some days most people are elsewhere together (a conference, ice on the roads).
  const double common = 1.0 - 0.04 * std::abs(rng_.normal()) - (rng_.uniform() < 0.01 ? 0.3 : 0.0);
  const double attendance =
      std::clamp(0.95 * kWeekdayAttendance[weekday] * season_attendance(day) * common, 0.0, 1.0);
  for (Person& person : people_) plan_day(person, day, attendance);
}

}  // namespace recald::simulators
