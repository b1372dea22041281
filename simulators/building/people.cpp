#include "simulators/building/people.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace recald::simulators {
namespace {

/// Monday to Sunday; for working days only Monday to Friday matter.
constexpr std::array<double, 7> kWeekdayAttendance{0.95, 1.0, 1.0, 0.97, 0.86, 1.0, 1.0};

/// Some place is always free, even on the best day.
constexpr double kFullest = 0.97;

bool has_visits(const Drawings& drawings) {
  return drawings.perimeter_rooms.visits || drawings.core_rooms.visits;
}

}  // namespace

People::People(const Truth& truth, Rng rng)
    : rng_(rng),
      numbers_(rng.below(std::uint64_t{1} << 62U)),  // from the copy: `rng_` has not moved
      drawings_(truth.drawings),
      assigned_(truth.drawings.zones(), 0),
      present_(truth.drawings.zones() * kSlotsPerDay, 0) {
  const Drawings& drawings = drawings_;
  if (has_visits(drawings)) trade_.emplace(6.0 * kDay_s, kDay_s, rng_);
  const double simulated_m2 =
      static_cast<double>(drawings.storeys_simulated()) * drawings.storey_m2();
  const auto count = static_cast<std::size_t>(
      std::lround(std::max(0.0, truth.occupancy_density_person_m2) * simulated_m2));
  people_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t zone = draw_zone(drawings);
    const RoomUse& use = drawings.rooms(zone % kZonesPerStorey);
    people_.push_back({.zone = zone,
                       .arrival_h = use.arrival_h + 0.8 * rng_.normal(),
                       .stay_h = use.stay_h + 0.7 * rng_.normal(),
                       .weekend_share = rng_.uniform() * use.weekend_share_max,
                       .evening_share = rng_.uniform() * use.evening_share_max,
                       .days_away = 0,
                       .stays = false});
    ++assigned_[zone];
  }
}

std::size_t People::draw_zone(const Drawings& drawings) {
  const double perimeter_m2 = drawings.storey_m2() - drawings.core_and_special_m2();
  const std::size_t first = kZonesPerStorey * rng_.below(drawings.storeys_simulated());
  if (rng_.uniform() >= drawings.perimeter_people_share()) return first + core;
  double place_m2 = rng_.uniform() * perimeter_m2;
  std::size_t side = south;
  while (side < west && place_m2 >= drawings.zone_m2(side)) place_m2 -= drawings.zone_m2(side++);
  return first + side;
}

/// A number in 0…1, the same whatever else was drawn.
double People::number_of(std::size_t person, metering::Day day) const {
  const auto date = std::chrono::sys_days{day}.time_since_epoch().count();
  Rng own{numbers_ + static_cast<std::uint64_t>(date), static_cast<std::uint64_t>(person)};
  return own.uniform();
}

void People::attend(std::size_t zone, double from_h, double to_h, bool kept_away) {
  if (kept_away) return;
  // People who stay past midnight go home at midnight, so no one is counted twice.
  const int first = std::clamp(static_cast<int>(std::lround(from_h * 12.0)), 0, 288);
  const int last = std::clamp(static_cast<int>(std::lround(to_h * 12.0)), 0, 288);
  for (int slot = first; slot < last; ++slot) {
    ++present_[zone * kSlotsPerDay + static_cast<std::size_t>(slot)];
  }
}

void People::plan_day(Person& person, DayKind kind, double attendance, bool kept_away) {
  if (person.days_away > 0) {
    --person.days_away;
    return;
  }
  if (kind != DayKind::workday) {
    if (rng_.uniform() >= person.weekend_share) return;
    const double from_h = 11.0 + 2.0 * rng_.normal();
    attend(person.zone, from_h, from_h + 2.0 + 3.0 * rng_.uniform(), kept_away);
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
    attend(person.zone, from_h, lunch_h, kept_away);
    attend(person.zone, lunch_h + 0.4 + 0.5 * rng_.uniform(), to_h, kept_away);
  } else {
    attend(person.zone, from_h, to_h, kept_away);
  }
  if (rng_.uniform() < person.evening_share) {
    attend(person.zone, std::max(to_h, 19.5), std::max(to_h, 19.5) + 1.0 + 2.5 * rng_.uniform(),
           kept_away);
  }
}

std::optional<VisitDay> People::visit_day(const RoomUse& rooms, std::size_t room_kind, DayKind kind,
                                          double busy) {
  if (!rooms.visits) return std::nullopt;
  const Visits& visits = *rooms.visits;
  SlotShares shares = shares_by_slot(kind == DayKind::workday    ? visits.workday
                                     : kind == DayKind::saturday ? visits.saturday
                                                                 : visits.sunday);
  for (double& share : shares) share = std::min(kFullest, busy * share);
  double& last = last_share_[room_kind];
  if (last < 0.0) {
    last = shares.front();
    for (Person& person : people_) {
      const bool of_core = person.zone % kZonesPerStorey == core;
      if (of_core == (room_kind == 1)) person.stays = rng_.uniform() < last;
    }
  }
  VisitDay day(shares, last, visits.stay_h);
  last = shares.back();
  return day;
}

/// Good and bad days apply to the whole building, and come in weeks.
People::VisitDays People::draw_visit_days(DayKind kind) {
  if (!trade_) return {};
  const double busy =
      std::clamp(1.0 + 0.06 * trade_->advance(rng_) + 0.05 * rng_.normal(), 0.6, 1.4);
  return {visit_day(drawings_.perimeter_rooms, 0, kind, busy),
          visit_day(drawings_.core_rooms, 1, kind, busy)};
}

void People::plan_visits(Person& person, const VisitDay& day, bool kept_away) {
  int* const present = &present_[person.zone * kSlotsPerDay];
  person.stays = day.draw(person.stays, rng_, [&](std::size_t first, std::size_t end) {
    if (kept_away) return;
    for (std::size_t slot = first; slot < end; ++slot) ++present[slot];
  });
}

void People::begin_day(metering::Day day, DayKind kind, double season, double attendance) {
  std::ranges::fill(present_, 0);
  const unsigned weekday = std::chrono::weekday{std::chrono::sys_days{day}}.iso_encoding() - 1;
  // On some days most people are away together (a conference, ice on the roads).
  const double common = 1.0 - 0.04 * std::abs(rng_.normal()) - (rng_.uniform() < 0.01 ? 0.3 : 0.0);
  const double willing = std::clamp(0.95 * kWeekdayAttendance[weekday] * season * common, 0.0, 1.0);
  const VisitDays visits = draw_visit_days(kind);
  for (std::size_t i = 0; i < people_.size(); ++i) {
    const bool kept_away = attendance < 1.0 && number_of(i, day) >= attendance;
    Person& person = people_[i];
    const auto& visit = person.zone % kZonesPerStorey == core ? visits.core : visits.perimeter;
    if (visit) {
      plan_visits(person, *visit, kept_away);
    } else {
      plan_day(person, kind, willing, kept_away);
    }
  }
}

}  // namespace recald::simulators
