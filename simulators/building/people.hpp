/// The building's people, one by one: when each comes, lunches, leaves and is away.
#pragma once

#include <array>
#include <vector>

#include "core/metering/civil_time.hpp"
#include "simulators/building/drawings.hpp"
#include "simulators/chance/chance.hpp"

namespace recald::simulators {

class People {
 public:
  /// @param density_person_m2 people assigned per floor area; rounded to whole people.
  People(double density_person_m2, Rng rng);

  /// Draws the whole local day. Call once a day, in order.
  void begin_day(metering::Day day);

  /// People in the zone at this local minute of the day that was begun.
  [[nodiscard]] int present(std::size_t zone, int minute_of_day) const {
    return present_[zone][static_cast<std::size_t>(minute_of_day / 5)];
  }
  [[nodiscard]] int assigned(std::size_t zone) const { return assigned_[zone]; }
  [[nodiscard]] int assigned() const { return static_cast<int>(people_.size()); }

 private:
  struct Person {
    std::size_t zone;
    double arrival_h;
    double stay_h;
    double weekend_share;  ///< Of weekend days on which this person shows up.
    double evening_share;  ///< Of days on which this person returns after dinner.
    int days_away;         ///< Left of a vacation or illness.
  };
  void plan_day(Person& person, metering::Day day, double attendance);
  void attend(std::size_t zone, double from_h, double to_h);

  Rng rng_;
  std::vector<Person> people_;
  std::array<int, drawings::zones> assigned_{};
  std::array<std::array<int, 288>, drawings::zones> present_{};
};

}  // namespace recald::simulators
