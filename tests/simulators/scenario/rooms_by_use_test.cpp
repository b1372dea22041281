#include "simulators/scenario/rooms_by_use.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <ostream>

#include "simulators/building/calendar.hpp"
#include "simulators/building/people.hpp"
#include "simulators/scenario/archetypes.hpp"

namespace recald::simulators::rooms_by_use_test {
namespace {

using namespace std::chrono;

/// A use that is printed by its name.
struct NamedUse {
  Use use;
  friend void PrintTo(const NamedUse& named, std::ostream* out) { *out << to_string(named.use); }
};

class EveryUseWithVisits : public ::testing::TestWithParam<NamedUse> {
 protected:
  const Drawings drawings_ = draw_up(typical_brief(GetParam().use));
};

struct MeanDay {
  HourlyShares present{};  ///< Of those assigned.
  int days = 0;
};

/// Half a year of its people, by kind of day.
std::map<DayKind, MeanDay> mean_days(const Drawings& drawings) {
  Truth truth = draw_truth(drawings, 1);
  truth.occupancy_density_person_m2 = drawings.occupancy_person_m2;
  People people(truth, Rng{3});
  const Calendar calendar(drawings.calendar);
  std::map<DayKind, MeanDay> means;
  for (sys_days day{2022y / January / 1}; day < sys_days{2022y / July / 1}; day += days{1}) {
    const DayKind kind = calendar.kind_of(day);
    people.begin_day(day, kind, 1.0, 1.0);
    MeanDay& mean = means[kind];
    ++mean.days;
    for (int minute = 0; minute < 1440; minute += 5) {
      double present = 0.0;
      for (std::size_t zone = 0; zone < drawings.zones(); ++zone) {
        present += people.present(zone, minute);
      }
      mean.present[static_cast<std::size_t>(minute / 60)] += present / 12.0 / people.assigned();
    }
  }
  for (auto& [kind, mean] : means) {
    for (double& share : mean.present) share /= mean.days;
  }
  return means;
}

// What the site file quotes is what happens: half a year's mean, hour by hour, within good and bad
// weeks (the level of a day varies by 8 %, and some of it persists) and the chance of a few people.
TEST_P(EveryUseWithVisits, PeopleAreThereWhenTheSiteFileSaysSo) {
  const auto means = mean_days(drawings_);
  const std::map<DayKind, HourlyShares> quoted{{DayKind::workday, drawings_.presence_workday},
                                               {DayKind::saturday, drawings_.presence_saturday},
                                               {DayKind::sunday, drawings_.presence_sunday}};
  const double assigned = drawings_.occupancy_person_m2 *
                          static_cast<double>(drawings_.storeys_simulated()) *
                          drawings_.storey_m2();
  for (const auto& [kind, mean] : means) {
    SCOPED_TRACE(static_cast<int>(kind));
    for (std::size_t hour = 0; hour < 24; ++hour) {
      const double share = quoted.at(kind)[hour];
      const double chance = std::sqrt(share * (1.0 - share) / (assigned * mean.days));
      EXPECT_NEAR(mean.present[hour], share, 0.06 * share + 5.0 * chance + 1e-9) << hour;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Uses, EveryUseWithVisits,
                         ::testing::Values(NamedUse{Use::shop}, NamedUse{Use::hotel},
                                           NamedUse{Use::clinic}, NamedUse{Use::warehouse},
                                           NamedUse{Use::restaurant}, NamedUse{Use::gym}),
                         [](const auto& tested) {
                           return std::string(to_string(tested.param.use));
                         });

// Where there are hours, at most one in thirty is there an hour before them, and as many after.
TEST(RoomsByUse, RoomsAreServedWhilePeopleAreThere) {
  for (const Use use : {Use::shop, Use::warehouse, Use::restaurant, Use::gym}) {
    SCOPED_TRACE(to_string(use));
    const Drawings drawings = draw_up(typical_brief(use));
    ASSERT_FALSE(drawings.core_runs_always || drawings.perimeter_runs_always);
    const std::array quoted{std::pair{DayKind::workday, drawings.presence_workday},
                            std::pair{DayKind::saturday, drawings.presence_saturday},
                            std::pair{DayKind::sunday, drawings.presence_sunday}};
    for (const auto& [kind, shares] : quoted) {
      for (std::size_t hour = 0; hour < 24; ++hour) {
        const auto begins_h = static_cast<double>(hour);
        const bool served = is_open(drawings.open_days, kind) &&
                            begins_h >= drawings.occupied_from_h &&
                            begins_h < drawings.occupied_to_h;
        EXPECT_TRUE(served || shares[hour] < 1.0 / 30.0)
            << static_cast<int>(kind) << ": at " << hour << " h " << shares[hour];
      }
    }
  }
}

// Guests sleep through midnight: as many are there after it as before.
TEST(RoomsByUse, HotelGuestsStayOvernight) {
  const Drawings drawings = draw_up(typical_brief(Use::hotel));
  People people(draw_truth(drawings, 2), Rng{4});
  std::vector<int> before;
  double kept = 0.0;
  double there = 0.0;
  for (int i = 0; i < 30; ++i) {
    const metering::Day day{sys_days{2022y / March / 1} + days{i}};
    people.begin_day(day, Calendar(Use::hotel).kind_of(day), 1.0, 1.0);
    for (std::size_t zone = 0; zone < drawings.zones() && !before.empty(); ++zone) {
      kept += std::min(before[zone], people.present(zone, 0));
      there += before[zone];
    }
    before.clear();
    for (std::size_t zone = 0; zone < drawings.zones(); ++zone) {
      before.push_back(people.present(zone, 1435));
    }
  }
  EXPECT_GT(kept, 0.9 * there);
  EXPECT_GT(there, 0.0);
}

// A drawn-up ordinary week draws the warm water that the site file states, a quarter of it at all
// hours.
TEST(RoomsByUse, WarmWaterOfAWeekIsWhatIsDrawnUp) {
  for (const Use use : {Use::shop, Use::hotel, Use::gym}) {
    const Drawings drawings = draw_up(typical_brief(use));
    const RoomUse& rooms = drawings.perimeter_rooms;  // like the core's in these
    double awake_h = 0.0;
    for (std::size_t hour = 0; hour < 24; ++hour) {
      awake_h += rooms.awake_share(static_cast<int>(hour) * 60) *
                 (5.0 * rooms.visits->workday[hour] + rooms.visits->saturday[hour] +
                  rooms.visits->sunday[hour]);
    }
    EXPECT_NEAR(0.25 + drawings.hot_water_with_people * awake_h / 168.0, 1.0, 1e-12)
        << to_string(use);
  }
}

}  // namespace
}  // namespace recald::simulators::rooms_by_use_test
