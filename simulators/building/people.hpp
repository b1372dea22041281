/// The building's people, one by one: when each arrives, has lunch, leaves and is away.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "simulators/building/operation.hpp"
#include "simulators/building/truth.hpp"
#include "simulators/chance/chance.hpp"

namespace recald::simulators {

class People {
 public:
  /// Creates the people of the simulated storeys; their number follows from density and floor area.
  People(const Truth& truth, Rng rng);

  /// Draws the whole local day. Call once a day, in order.
  /// @param season      Share that comes at all, of people with a working day.
  /// @param attendance  Share of those not kept away by a hidden effect. Each person's own number
  ///                    for the day decides, so that all other people's days stay the same.
  void begin_day(metering::Day day, DayKind kind, double season, double attendance);

  /// People in the zone at this local minute of the current day.
  [[nodiscard]] int present(std::size_t zone, int minute_of_day) const {
    return present_[zone * kSlotsPerDay + static_cast<std::size_t>(minute_of_day / 5)];
  }
  [[nodiscard]] int assigned(std::size_t zone) const { return assigned_[zone]; }
  [[nodiscard]] int assigned() const { return static_cast<int>(people_.size()); }

 private:
  struct Person {
    std::size_t zone;
    double arrival_h;
    double stay_h;
    double weekend_share;  ///< Of weekend days on which this person comes.
    double evening_share;  ///< Of days on which this person returns after dinner.
    int days_away;         ///< Remaining days of a vacation or illness.
    bool stays;            ///< For places with visits: the place was taken at the end of yesterday.
  };
  /// Visits of one day, in the perimeter and in the core; empty if people work there.
  struct VisitDays {
    std::optional<VisitDay> perimeter, core;
  };
  [[nodiscard]] std::size_t draw_zone(const Drawings& drawings);
  [[nodiscard]] double number_of(std::size_t person, metering::Day day) const;
  void plan_day(Person& person, DayKind kind, double attendance, bool kept_away);
  [[nodiscard]] VisitDays draw_visit_days(DayKind kind);
  [[nodiscard]] std::optional<VisitDay> visit_day(const RoomUse& rooms, std::size_t room_kind,
                                                  DayKind kind, double busy);
  void plan_visits(Person& person, const VisitDay& day, bool kept_away);
  void attend(std::size_t zone, double from_h, double to_h, bool kept_away);

  Rng rng_;
  std::uint64_t numbers_;  ///< Seed of the people's own numbers.
  Drawings drawings_;
  std::optional<Persistence> trade_;              ///< Good and bad weeks of places with visits.
  std::array<double, 2> last_share_{-1.0, -1.0};  ///< Of places taken at the end of yesterday.
  std::vector<Person> people_;
  std::vector<int> assigned_;
  std::vector<int> present_;  ///< zones × slots of five minutes
};

}  // namespace recald::simulators
