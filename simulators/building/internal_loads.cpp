#include "simulators/building/internal_loads.hpp"

#include <algorithm>
#include <cmath>

namespace recald::simulators {
namespace {

std::size_t side_of(std::size_t zone) { return zone % kZonesPerStorey; }

/// A room's light is on whether one person or five are in it.
double lit_share(double occupied) { return 1.0 - std::exp(-3.4 * occupied); }

/// Share of the way to a new value in one step, given the share in five minutes.
double follow(double share_in_5_min, double step_s) {
  return 1.0 - std::pow(1.0 - share_in_5_min, step_s / 300.0);
}

}  // namespace

InternalLoads::InternalLoads(const Truth& truth, double step_s, Rng rng)
    : truth_(truth),
      step_s_(step_s),
      lights_on_follow_(follow(0.6, step_s)),
      lights_off_follow_(follow(0.15, step_s)),
      rng_(rng),
      zones_(truth.drawings.zones()),
      power_(truth.drawings.zones()) {
  for (std::size_t zone = 0; zone < zones_.size(); ++zone) {
    day_habit_.emplace_back(6.0 * 86'400.0, 86'400.0, rng_);
    flicker_.emplace_back(1200.0, step_s, rng_);
  }
}

const RoomUse& InternalLoads::use_of(std::size_t zone) const {
  return truth_.drawings.rooms(side_of(zone));
}

void InternalLoads::begin_day() {
  for (std::size_t zone = 0; zone < zones_.size(); ++zone) {
    const double habit = day_habit_[zone].advance(rng_);
    zones_[zone].lights_habit = 1.0 + 0.03 * rng_.normal();
    zones_[zone].equipment_habit = 1.0 + use_of(zone).plugs_habit * habit;
  }
}

double InternalLoads::occupied_share(const People& people, std::size_t zone,
                                     int minute_of_day) const {
  // Nobody sits in the special rooms; people from the core go in and out.
  if (side_of(zone) == special) --zone;
  const int assigned = people.assigned(zone);
  if (assigned <= 0) return 0.0;
  return use_of(zone).awake_share(minute_of_day) * people.present(zone, minute_of_day) / assigned;
}

double InternalLoads::lights_W(std::size_t zone, double occupied, bool working_hours,
                               bool cleaning) {
  ZoneState& state = zones_[zone];
  const double corridor = 0.12;
  const double crew = cleaning ? 0.30 : 0.0;
  const bool all = working_hours && use_of(zone).lit_while_open;
  const double wanted =
      all ? 1.0 : corridor + (1.0 - corridor) * std::max(crew, lit_share(occupied));
  const double follow = wanted > state.lights_on ? lights_on_follow_ : lights_off_follow_;
  state.lights_on += follow * (wanted - state.lights_on);
  return truth_.lighting_scale * use_of(zone).lighting_W_m2 *
         truth_.drawings.zone_m2(side_of(zone)) * state.lights_on * state.lights_habit;
}

double InternalLoads::appliance_runs_W(std::size_t zone, double installed_W, bool working_hours) {
  // Autoclaves, ovens, centrifuges: started mostly in working hours, some left on overnight.
  std::vector<Run>& runs = zones_[zone].runs;
  const double starts_per_day = working_hours ? 9.0 : 1.2;
  if (rng_.uniform() < starts_per_day * step_s_ / 86'400.0) {
    const double hours = 0.5 + draw_waiting_time(rng_, 3.0);
    runs.push_back({installed_W * rng_.uniform(0.015, 0.07),
                    1 + static_cast<int>(std::min(hours, 48.0) * 3600.0 / step_s_)});
  }
  double sum_W = 0.0;
  for (Run& run : runs) {
    sum_W += run.power_W;
    --run.steps_left;
  }
  std::erase_if(runs, [](const Run& run) { return run.steps_left <= 0; });
  return sum_W;
}

double InternalLoads::plugs_W(std::size_t zone, double occupied, bool working_hours) {
  const RoomUse& use = use_of(zone);
  const double flicker = 1.0 + 0.02 * flicker_[zone].advance(rng_);
  const double habit = zones_[zone].equipment_habit * flicker;
  const std::size_t side = side_of(zone);
  const double scale = side == special ? truth_.special_plugs_scale
                       : side == core  ? truth_.core_plugs_scale
                                       : truth_.perimeter_plugs_scale;
  const double installed_W = scale * use.plugs_W_m2 * truth_.drawings.zone_m2(side);
  const double share = use.plugs_standing_share + use.plugs_people_share * occupied +
                       (working_hours ? use.plugs_working_share : 0.0);
  const double steady_W = installed_W * habit * share;
  return use.appliance_runs ? steady_W + appliance_runs_W(zone, installed_W, working_hours)
                            : steady_W;
}

const std::vector<ZonePower>& InternalLoads::advance(const People& people, int minute_of_day,
                                                     bool open) {
  const Drawings& drawings = truth_.drawings;
  const double hour = minute_of_day / 60.0;
  const bool cleaning = open && hour >= drawings.cleaning_from_h && hour < drawings.cleaning_to_h;
  const bool working_hours =
      open && hour >= drawings.working_from_h && hour < drawings.working_to_h;
  for (std::size_t zone = 0; zone < zones_.size(); ++zone) {
    const double occupied = occupied_share(people, zone, minute_of_day);
    power_[zone] = {lights_W(zone, occupied, working_hours, cleaning),
                    plugs_W(zone, occupied, working_hours)};
  }
  return power_;
}

}  // namespace recald::simulators
