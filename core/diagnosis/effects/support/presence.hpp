/// Fewer or more people than in the schedule, with the lights and plugs that follow them.
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "core/model/drivers.hpp"
#include "core/model/hourly/alteration.hpp"

namespace recald::diagnosis::effects {

/// Loads that stay on when nobody is in: the lowest lights and plugs of each calendar month, W.
class StandbyLoads {
 public:
  explicit StandbyLoads(const model::Drivers& drivers) {
    lights_W_.fill(std::numeric_limits<double>::infinity());
    plugs_W_.fill(std::numeric_limits<double>::infinity());
    for (const model::DriverHour& hour : drivers.hours) {
      const std::size_t month = index(hour);
      lights_W_[month] = std::min(lights_W_[month], hour.lights_W);
      plugs_W_[month] = std::min(plugs_W_[month], hour.plugs_W);
    }
  }

  /// The step's lights and plugs above standby; 0 in months that the drivers lack.
  [[nodiscard]] double lights_above_W(const model::DriverHour& hour, double lights_W) const {
    return std::max(lights_W - lights_W_[index(hour)], 0.0);
  }
  [[nodiscard]] double plugs_above_W(const model::DriverHour& hour, double plugs_W) const {
    return std::max(plugs_W - plugs_W_[index(hour)], 0.0);
  }

 private:
  static std::size_t index(const model::DriverHour& hour) {
    return static_cast<unsigned>(hour.date.month()) - 1;
  }
  std::array<double, 12> lights_W_;
  std::array<double, 12> plugs_W_;
};

/// Corridors, printers and servers do not follow the people: only this share of lights and plugs
/// above standby does.
inline constexpr double kLoadsFollowingPeople = 0.8;

/// Multiplies people by 1 + change, and lights and plugs above standby by
/// 1 + kLoadsFollowingPeople · change. Their heat leaves the zones with them.
/// @param change  -1: nobody, 0: as scheduled.
inline void change_presence(double change, const StandbyLoads& standby,
                            const model::DriverHour& hour,
                            model::hourly::StepOperation& operation) {
  const double loads_change = kLoadsFollowingPeople * change;
  operation.people_share *= 1.0 + change;
  operation.lights_W += loads_change * standby.lights_above_W(hour, operation.lights_W);
  operation.plugs_W += loads_change * standby.plugs_above_W(hour, operation.plugs_W);
}

}  // namespace recald::diagnosis::effects
