/// Lights, plugs and laboratory equipment: they follow people, plus daily variations of their own.
#pragma once

#include <vector>

#include "simulators/building/people.hpp"
#include "simulators/building/truth.hpp"
#include "simulators/chance/chance.hpp"

namespace recald::simulators {

struct ZonePower {
  double lights_W;
  double plugs_W;
};

class InternalLoads {
 public:
  InternalLoads(const Truth& truth, double step_s, Rng rng);

  /// Call once a local day, in order.
  void begin_day();

  /// Power of all zones in one step.
  /// @param open  Whether people work in the building on this day.
  const std::vector<ZonePower>& advance(const People& people, int minute_of_day, bool open);

 private:
  struct Run {
    double power_W;
    int steps_left;
  };
  struct ZoneState {
    double lights_on = 0.1;        ///< Share, falls slowly: switches have delays.
    double lights_habit = 1.0;     ///< Of the day.
    double equipment_habit = 1.0;  ///< Of the day.
    std::vector<Run> runs;         ///< Appliances that are running.
  };
  [[nodiscard]] const RoomUse& use_of(std::size_t zone) const;
  [[nodiscard]] double occupied_share(const People& people, std::size_t zone,
                                      int minute_of_day) const;
  [[nodiscard]] double lights_W(std::size_t zone, double occupied, bool working_hours,
                                bool cleaning);
  [[nodiscard]] double plugs_W(std::size_t zone, double occupied, bool working_hours);
  [[nodiscard]] double appliance_runs_W(std::size_t zone, double installed_W, bool working_hours);

  Truth truth_;
  double step_s_;
  double lights_on_follow_;
  double lights_off_follow_;
  Rng rng_;
  std::vector<ZoneState> zones_;
  std::vector<Persistence> day_habit_;  ///< Good and bad weeks of a zone.
  std::vector<Persistence> flicker_;    ///< Minutes to an hour.
  std::vector<ZonePower> power_;
};

}  // namespace recald::simulators
