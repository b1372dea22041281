#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/simulators/effects/hand_made_year.hpp"

namespace recald::simulators::all_effects_test {
namespace {

using namespace hand_made;
using namespace std::chrono_literals;

Drawings drawings_with_skylight() {
  Drawings drawings;
  drawings.skylight_share = 0.1;
  return drawings;
}

/// Steps in which a hook changed anything, over the days given.
int steps_changed(HiddenEffect& effect, metering::Day first, int days) {
  int changed = 0;
  walk(
      first, days, 1800s,
      [&](metering::Day day, Timetable& timetable) {
        changed += leaves_alone(timetable, [&](Timetable& t) { effect.plan(day, t); }) ? 0 : 1;
      },
      [&](const Moment& now) {
        Untouched step;
        const bool alone =
            leaves_alone(step.operation, [&](Operation& o) { effect.operate(now, o); }) &
            leaves_alone(step.load, [&](ServiceLoad& l) { effect.load(now, l); }) &
            leaves_alone(step.power, [&](UtilityPower& p) { effect.supply(now, p); });
        changed += alone ? 0 : 1;
      });
  return changed;
}

/// Values of a meter over so many days that `distort` changed.
int values_changed(const HiddenEffect& effect, metering::Day first, int days) {
  const auto calendar = metering::LocalCalendar::open("America/New_York");
  std::vector<double> shown_kW(static_cast<std::size_t>(96 * days));
  for (std::size_t i = 0; i < shown_kW.size(); ++i) {
    shown_kW[i] = 200.0 + 100.0 * std::sin(0.001 * static_cast<double>(i * i % 7919));
  }
  const std::vector<double> before_kW = shown_kW;
  effect.distort({Utility::electricity, calendar->day_span(first).begin, *calendar, shown_kW});
  int changed = 0;
  for (std::size_t i = 0; i < shown_kW.size(); ++i) changed += shown_kW[i] != before_kW[i] ? 1 : 0;
  return changed;
}

bool leaves_truth_alone(const HiddenEffect& effect) {
  Truth truth{};
  truth.mass_scale = 1.1;
  truth.ground_u_W_m2K = 0.4;
  effect.build(truth);
  return truth.mass_scale == 1.1 && truth.ground_u_W_m2K == 0.4;
}

TEST(EffectsAtZero, ChangeNotOneBit) {
  for (const EffectKind& kind : effect_kinds()) {
    SCOPED_TRACE(kind.id);
    const auto effect = make(kind, 0.0, drawings_with_skylight(), on_meter(Utility::electricity));
    EXPECT_TRUE(leaves_truth_alone(*effect));
    EXPECT_EQ(steps_changed(*effect, day_of(2021, 12, 1), 425), 0);
    EXPECT_EQ(values_changed(*effect, day_of(2022, 1, 1), 365), 0);
  }
}

TEST(EffectsOutsideTheirDates, ChangeNotOneBit) {
  for (const EffectKind& kind : effect_kinds()) {
    SCOPED_TRACE(kind.id);
    const auto effect = make(kind, kind.strength.typical, drawings_with_skylight(),
                             between(day_of(2023, 1, 1), day_of(2023, 12, 31)));
    EXPECT_EQ(steps_changed(*effect, day_of(2022, 1, 1), 365), 0) << "before";
    EXPECT_EQ(values_changed(*effect, day_of(2022, 1, 1), 365), 0) << "before";
    steps_changed(*effect, day_of(2023, 1, 1), 365);
    EXPECT_EQ(steps_changed(*effect, day_of(2024, 1, 1), 300), 0) << "after";
    EXPECT_EQ(values_changed(*effect, day_of(2024, 1, 1), 300), 0) << "after";
  }
}

// Without this, the two tests above could pass on effects that do nothing at all.
TEST(EffectsAtTypicalStrength, ChangeSomethingInAYear) {
  for (const EffectKind& kind : effect_kinds()) {
    SCOPED_TRACE(kind.id);
    const auto effect =
        make(kind, kind.strength.typical, drawings_with_skylight(), on_meter(Utility::electricity));
    EXPECT_TRUE(steps_changed(*effect, day_of(2021, 12, 1), 425) +
                        values_changed(*effect, day_of(2022, 1, 1), 365) >
                    0 ||
                !leaves_truth_alone(*effect));
  }
}

TEST(Effects, AreTheSameForTheSameSeed) {
  for (const EffectKind& kind : effect_kinds()) {
    SCOPED_TRACE(kind.id);
    std::array<std::vector<double>, 2> traces;
    for (auto& trace : traces) {
      const auto effect = make(kind, kind.strength.max, drawings_with_skylight());
      run(*effect, day_of(2022, 1, 1), 40, 900s, [&](const Step& step) {
        trace.insert(trace.end(),
                     {step.load.other_electricity_W, step.power.electricity_kW,
                      step.operation.plant.heating_standing_W, step.operation.rooms.server_W,
                      step.operation.envelope.opening_m2[0], step.operation.rooms.plugs_factor});
      });
    }
    EXPECT_EQ(traces[0], traces[1]);
  }
}

}  // namespace
}  // namespace recald::simulators::all_effects_test
