/// Lights, plugs and laboratory equipment: they follow people, and have habits of their own.
#pragma once

#include <array>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "simulators/building/drawings.hpp"
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
  InternalLoads(const Truth& truth, Rng rng);

  /// Call once a local day, in order.
  void begin_day();

  /// Power of all zones in one step of `kStep`.
  const std::array<ZonePower, drawings::zones>& advance(const People& people, int minute_of_day,
                                                        bool workday);

 private:
  struct Run {
    double power_W;
    int steps_left;
  };
  struct ZoneState {
    double lights_on = 0.1;        ///< Share, falls slowly: switches have delays.
    double lights_habit = 1.0;     ///< Of the day.
    double equipment_habit = 1.0;  ///< Of the day.
    std::vector<Run> runs;         ///< Laboratory equipment that was started and will end.
  };
  [[nodiscard]] double occupied_share(const People& people, std::size_t zone,
                                      int minute_of_day) const;
  [[nodiscard]] double lights_W(std::size_t zone, double occupied, bool cleaning);
  [[nodiscard]] double plugs_W(std::size_t zone, double occupied, int minute_of_day, bool workday);
  [[nodiscard]] double equipment_runs_W(std::size_t zone, double installed_W, bool working_hours);

  Truth truth_;
  Rng rng_;
  std::array<ZoneState, drawings::zones> zones_;
  std::vector<Persistence> day_habit_;  ///< A zone's good and bad weeks.
  std::vector<Persistence> flicker_;    ///< Minutes to an hour.
  std::array<ZonePower, drawings::zones> power_{};
};

}  // namespace recald::simulators
