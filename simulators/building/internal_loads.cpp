#include "simulators/building/internal_loads.hpp"

#include <algorithm>
#include <cmath>

#include "simulators/climate/weather.hpp"

namespace recald::simulators {
namespace {

std::size_t side_of(std::size_t zone) { return zone % drawings::zones_per_storey; }

bool is_office(std::size_t zone) { return side_of(zone) <= drawings::west; }

double area_m2(std::size_t zone) { return drawings::zone_area_m2[side_of(zone)]; }

/// A room's light is on whether one or five people are in it.
double lit_share(double occupied) { return 1.0 - std::exp(-3.4 * occupied); }

}  // namespace

InternalLoads::InternalLoads(const Truth& truth, Rng rng) : truth_(truth), rng_(rng) {
  for (std::size_t zone = 0; zone < drawings::zones; ++zone) {
    day_habit_.emplace_back(6.0 * 86'400.0, 86'400.0, rng_);
    flicker_.emplace_back(1200.0, kStep_s, rng_);
  }
}

void InternalLoads::begin_day() {
  for (std::size_t zone = 0; zone < drawings::zones; ++zone) {
    const double habit = day_habit_[zone].advance(rng_);
    zones_[zone].lights_habit = 1.0 + 0.03 * rng_.normal();
    zones_[zone].equipment_habit = 1.0 + (is_office(zone) ? 0.03 : 0.06) * habit;
  }
}

double InternalLoads::occupied_share(const People& people, std::size_t zone,
                                     int minute_of_day) const {
  // Nobody sits in the equipment rooms: the laboratory's people go in and out.
  if (side_of(zone) == drawings::equipment) --zone;
  const int assigned = people.assigned(zone);
  return assigned > 0 ? static_cast<double>(people.present(zone, minute_of_day)) / assigned : 0.0;
}

double InternalLoads::lights_W(std::size_t zone, double occupied, bool cleaning) {
  ZoneState& state = zones_[zone];
  const double corridor = 0.12;
  const double crew = cleaning ? 0.30 : 0.0;
  const double wanted = corridor + (1.0 - corridor) * std::max(crew, lit_share(occupied));
  const double follow = wanted > state.lights_on ? 0.6 : 0.15;
  state.lights_on += follow * (wanted - state.lights_on);
  const double density_W_m2 =
      is_office(zone) ? drawings::office_lighting_W_m2 : drawings::laboratory_lighting_W_m2;
  return truth_.lighting_scale * density_W_m2 * area_m2(zone) * state.lights_on *
         state.lights_habit;
}

double InternalLoads::equipment_runs_W(std::size_t zone, double installed_W, bool working_hours) {
  // Autoclaves, ovens, centrifuges: started mostly in working hours, some left on overnight.
  std::vector<Run>& runs = zones_[zone].runs;
  const double starts_per_day = working_hours ? 9.0 : 1.2;
  if (rng_.uniform() < starts_per_day * kStep_s / 86'400.0) {
    const double hours = 0.5 + draw_waiting_time(rng_, 3.0);
    runs.push_back({installed_W * rng_.uniform(0.015, 0.07),
                    1 + static_cast<int>(std::min(hours, 48.0) * 3600.0 / kStep_s)});
  }
  double sum_W = 0.0;
  for (Run& run : runs) {
    sum_W += run.power_W;
    --run.steps_left;
  }
  std::erase_if(runs, [](const Run& run) { return run.steps_left <= 0; });
  return sum_W;
}

double InternalLoads::plugs_W(std::size_t zone, double occupied, int minute_of_day, bool workday) {
  const double flicker = 1.0 + 0.02 * flicker_[zone].advance(rng_);
  const double habit = zones_[zone].equipment_habit * flicker;
  if (is_office(zone)) {
    const double installed_W =
        truth_.office_plugs_scale * drawings::office_plugs_W_m2 * area_m2(zone);
    return installed_W * habit * (0.30 + 0.62 * occupied);
  }
  const bool working_hours = workday && minute_of_day >= 8 * 60 && minute_of_day < 18 * 60;
  if (side_of(zone) == drawings::equipment) {
    // Freezers and servers hardly notice the time of day, instruments do.
    const double installed_W =
        truth_.equipment_plugs_scale * drawings::equipment_plugs_W_m2 * area_m2(zone);
    return installed_W * habit * (working_hours ? 0.66 : 0.60) +
           equipment_runs_W(zone, installed_W, working_hours);
  }
  const double installed_W =
      truth_.laboratory_plugs_scale * drawings::laboratory_plugs_W_m2 * area_m2(zone);
  return installed_W * habit * (0.42 + 0.32 * occupied) +
         equipment_runs_W(zone, installed_W, working_hours);
}

const std::array<ZonePower, drawings::zones>& InternalLoads::advance(const People& people,
                                                                     int minute_of_day,
                                                                     bool workday) {
  const bool cleaning = workday && minute_of_day >= 19 * 60 && minute_of_day < 21 * 60 + 30;
  for (std::size_t zone = 0; zone < drawings::zones; ++zone) {
    const double occupied = occupied_share(people, zone, minute_of_day);
    power_[zone] = {lights_W(zone, occupied, cleaning),
                    plugs_W(zone, occupied, minute_of_day, workday)};
  }
  return power_;
}

}  // namespace recald::simulators
