#include "core/metering/registers/placement.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace recald::metering::placement_test {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Reading reading(double mean_kW, Validity validity) { return {0, Instant{}, mean_kW, validity}; }

TEST(Placement, TheFirstReadingIsTaken) {
  EXPECT_EQ(place({}, reading(1.0, Validity::ok)), Placement::first);
  EXPECT_EQ(place({}, reading(kNone, Validity::missing)), Placement::first);
}

TEST(Placement, EverythingMayArriveTwice) {
  for (const Validity validity : {Validity::ok, Validity::scaled, Validity::suspect}) {
    EXPECT_EQ(place(reading(17.3, validity), reading(17.3, validity)), Placement::duplicate);
    EXPECT_EQ(place(reading(17.3, validity), reading(17.3 * (1.0 + 1e-12), validity)),
              Placement::duplicate);
  }
  EXPECT_EQ(place(reading(kNone, Validity::missing), reading(kNone, Validity::missing)),
            Placement::duplicate);
}

// Each pair in the order of strength: the stronger one replaces the weaker, never the reverse.
TEST(Placement, TheStrongerHolds) {
  const Validity ascending[] = {Validity::missing, Validity::suspect, Validity::filled,
                                Validity::scaled, Validity::ok};
  for (int weak = 0; weak < 5; ++weak) {
    for (int strong = weak + 1; strong < 5; ++strong) {
      const Reading weaker = reading(weak == 0 ? kNone : 10.0, ascending[weak]);
      const Reading stronger = reading(11.0, ascending[strong]);
      EXPECT_EQ(place(weaker, stronger), Placement::replaces) << weak << strong;
      EXPECT_EQ(place(stronger, weaker), Placement::weaker) << weak << strong;
    }
  }
}

TEST(Placement, OfTwoValuesAlikeInStrengthTheFirstStays) {
  EXPECT_EQ(place(reading(10.0, Validity::ok), reading(11.0, Validity::ok)), Placement::conflict);
  EXPECT_EQ(place(reading(10.0, Validity::scaled), reading(11.0, Validity::scaled)),
            Placement::conflict);
}

TEST(Placement, ACorrectionReplacesWhatItIsWeakerThan) {
  EXPECT_EQ(place(reading(10.0, Validity::ok), reading(11.0, Validity::scaled), true),
            Placement::replaces);
  EXPECT_EQ(place(reading(10.0, Validity::ok), reading(kNone, Validity::missing), true),
            Placement::weaker);
  EXPECT_EQ(place(reading(10.0, Validity::ok), reading(10.0, Validity::ok), true),
            Placement::duplicate);
}

}  // namespace
}  // namespace recald::metering::placement_test
