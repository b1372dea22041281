#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "simulators/effects/meter_slots.hpp"
#include "tests/simulators/effects/hand_made_year.hpp"

namespace recald::simulators {

EffectKind stuck_meter();
EffectKind scale_fault();
EffectKind phase_lost();
EffectKind clock_offset();
EffectKind dst_misapplied();

}  // namespace recald::simulators

namespace recald::simulators::meter_effects_test {
namespace {

using namespace hand_made;

/// A meter's record of whole local days, filled slot by slot.
class Record {
 public:
  template <class Fill>
  Record(metering::Day first, int days, Fill fill, std::string_view zone = "America/New_York")
      : calendar_(metering::LocalCalendar::open(zone).value()),
        begin_(calendar_.day_span(first).begin),
        shown_kW_(static_cast<std::size_t>(96 * days)) {
    for (std::size_t slot = 0; slot < shown_kW_.size(); ++slot) {
      shown_kW_[slot] = fill(static_cast<double>(slot));
    }
  }

  /// What the meter shows with the effect.
  [[nodiscard]] std::vector<double> with(const EffectKind& kind, double strength,
                                         const EffectSettings& settings,
                                         Utility utility = Utility::electricity) const {
    std::vector<double> shown_kW = shown_kW_;
    make(kind, strength, {}, settings)->distort({utility, begin_, calendar_, shown_kW});
    return shown_kW;
  }

  [[nodiscard]] const std::vector<double>& right_kW() const { return shown_kW_; }
  [[nodiscard]] std::size_t slot_at(metering::Day day, int minute) const {
    return static_cast<std::size_t>((calendar_.first_instant(day, minute) - begin_) / kInterval);
  }

 private:
  metering::LocalCalendar calendar_;
  metering::Instant begin_;
  std::vector<double> shown_kW_;
};

double slope(double slot) { return slot; }

/// A parabola: linear interpolation between whole slots is seen to be linear.
double bowl(double slot) { return slot * slot; }

double wavy(double slot) { return 100.0 + 30.0 * std::sin(0.37 * slot); }

EffectSettings on_electricity() { return on_meter(Utility::electricity); }

TEST(CoveredSlots, AreThoseThatBeginOnCoveredDays) {
  const auto calendar = metering::LocalCalendar::open("America/New_York").value();
  std::vector<double> shown_kW(96 * 40);
  const MeterRecord record{Utility::electricity, calendar.day_span(day_of(2022, 3, 1)).begin,
                           calendar, shown_kW};
  EXPECT_EQ(covered_slots(record, {}).count(), 96U * 40U);
  // 13 March has 23 hours.
  const SlotRange change = covered_slots(record, between(day_of(2022, 3, 13), day_of(2022, 3, 13)));
  EXPECT_EQ(change.first, 12U * 96U);
  EXPECT_EQ(change.count(), 92U);
  EXPECT_EQ(covered_slots(record, between(day_of(2023, 1, 1), day_of(2023, 2, 1))).count(), 0U);
  EXPECT_EQ(covered_slots(record, between(day_of(2020, 1, 1), day_of(2021, 2, 1))).count(), 0U);
}

TEST(ShownBetween, SharesNeighboursAndStopsAtTheEnds) {
  const std::vector<double> shown_kW{1.0, 3.0, 9.0};
  EXPECT_EQ(shown_between(shown_kW, 1.0), 3.0);
  EXPECT_EQ(shown_between(shown_kW, 1.25), 0.75 * 3.0 + 0.25 * 9.0);
  EXPECT_EQ(shown_between(shown_kW, -0.5), 1.0);
  EXPECT_EQ(shown_between(shown_kW, -7.0), 1.0);
  EXPECT_EQ(shown_between(shown_kW, 2.5), 9.0);
  EXPECT_EQ(shown_between(shown_kW, 40.0), 9.0);
}

TEST(StuckMeter, RepeatsValuesForItsShareOfTheTime) {
  const Record record(day_of(2022, 1, 1), 360, slope);
  const std::vector<double> shown_kW = record.with(stuck_meter(), 0.12, on_electricity());
  int stuck = 0;
  int spells = 0;
  for (std::size_t slot = 1; slot < shown_kW.size(); ++slot) {
    const bool now = shown_kW[slot] != record.right_kW()[slot];
    const bool before = shown_kW[slot - 1] != record.right_kW()[slot - 1];
    stuck += now ? 1 : 0;
    spells += now && !before ? 1 : 0;
    if (now) {
      EXPECT_EQ(shown_kW[slot], shown_kW[slot - 1]) << slot;
    }
  }
  EXPECT_EQ(spells, 8);  // one in each 45 days
  EXPECT_NEAR(stuck, 0.12 * 360 * 96, 8.0);
}

TEST(StuckMeter, KeepsHangingWhereAStrongerOneHangs) {
  const Record record(day_of(2022, 1, 1), 360, slope);
  const std::vector<double> some_kW = record.with(stuck_meter(), 0.1, on_electricity());
  const std::vector<double> more_kW = record.with(stuck_meter(), 0.4, on_electricity());
  for (std::size_t slot = 0; slot < some_kW.size(); ++slot) {
    if (some_kW[slot] != record.right_kW()[slot]) {
      EXPECT_EQ(some_kW[slot], more_kW[slot]) << slot;
    }
  }
}

TEST(MeterFaults, StrikeTheirMeterAlone) {
  const Record record(day_of(2022, 5, 1), 60, wavy);
  for (const EffectKind& kind : {stuck_meter(), scale_fault(), clock_offset()}) {
    SCOPED_TRACE(kind.id);
    EXPECT_EQ(record.with(kind, 0.3, on_electricity(), Utility::heat), record.right_kW());
    EXPECT_NE(record.with(kind, 0.3, on_meter(Utility::heat), Utility::heat), record.right_kW());
  }
  EXPECT_EQ(record.with(phase_lost(), 0.3, {}, Utility::cooling), record.right_kW());
}

TEST(ScaleFault, MultipliesFromItsDateOn) {
  const Record record(day_of(2022, 5, 1), 4, wavy);
  EffectSettings settings = on_electricity();
  settings.from = day_of(2022, 5, 3);
  const std::vector<double> high_kW = record.with(scale_fault(), 0.25, settings);
  const std::vector<double> low_kW = record.with(scale_fault(), -0.5, settings);
  for (std::size_t slot = 0; slot < high_kW.size(); ++slot) {
    const double right_kW = record.right_kW()[slot];
    EXPECT_EQ(high_kW[slot], slot < 192 ? right_kW : right_kW * 1.25);
    EXPECT_EQ(low_kW[slot], slot < 192 ? right_kW : right_kW * 0.5);
  }
}

TEST(PhaseLost, LosesAThirdOfAnEvenLoad) {
  const Record even(day_of(2022, 5, 1), 4, [](double) { return 300.0; });
  for (const double shown : even.with(phase_lost(), 1.0 / 3.0, {})) EXPECT_NEAR(shown, 200.0, 1e-9);
}

TEST(PhaseLost, CarriesAShareThatFollowsTheLoadALittle) {
  const Record record(day_of(2022, 5, 1), 30, wavy);
  const std::vector<double> shown_kW = record.with(phase_lost(), 0.3, {});
  double least = 1.0;
  double most = 0.0;
  for (std::size_t slot = 0; slot < shown_kW.size(); ++slot) {
    const double lost = 1.0 - shown_kW[slot] / record.right_kW()[slot];
    least = std::min(least, lost);
    most = std::max(most, lost);
  }
  EXPECT_GT(least, 0.3 * (1.0 - 0.12 * 0.31));
  EXPECT_LT(most, 0.3 * (1.0 + 0.12 * 0.31));
  EXPECT_GT(most - least, 0.0);
}

TEST(ClockOffset, ShowsEarlierPowerWhereTheClockIsFast) {
  const Record record(day_of(2022, 1, 1), 3, bowl);
  const std::vector<double> fast_kW = record.with(clock_offset(), 30.0, on_electricity());
  EXPECT_EQ(fast_kW[100], 98.0 * 98.0);
  const std::vector<double> slow_kW = record.with(clock_offset(), -45.0, on_electricity());
  EXPECT_EQ(slow_kW[100], 103.0 * 103.0);
  // 20 minutes are one interval and a third of another.
  const std::vector<double> odd_kW = record.with(clock_offset(), 20.0, on_electricity());
  EXPECT_NEAR(odd_kW[100], 2.0 / 3.0 * 99.0 * 99.0 + 1.0 / 3.0 * 98.0 * 98.0, 1e-9);
  EXPECT_EQ(odd_kW[0], 0.0) << "before the record its first value goes on";
}

TEST(ClockOffset, KeepsEnergyButAtTheEnds) {
  const Record record(day_of(2022, 1, 1), 30, wavy);
  const std::vector<double> shown_kW = record.with(clock_offset(), 100.0, on_electricity());
  const double shown = std::accumulate(shown_kW.begin(), shown_kW.end(), 0.0);
  const double right = std::accumulate(record.right_kW().begin(), record.right_kW().end(), 0.0);
  EXPECT_NEAR(shown, right, 7.0 * 60.0);  // at most seven intervals, each by at most the swing
}

// New York's clocks go forward on 13 March 2022 and back on 6 November.
TEST(DstMisapplied, IsAnHourEarlyInSummerAndRightInWinter) {
  const Record record(day_of(2022, 1, 1), 365, slope);
  const std::vector<double> shown_kW = record.with(dst_misapplied(), 1.0, {});
  const auto ahead = [&](metering::Day day, int minute) {
    const std::size_t slot = record.slot_at(day, minute);
    return shown_kW[slot] - record.right_kW()[slot];
  };
  EXPECT_EQ(ahead(day_of(2022, 2, 1), 600), 0.0);
  EXPECT_EQ(ahead(day_of(2022, 3, 13), 60), 0.0);
  EXPECT_EQ(ahead(day_of(2022, 3, 13), 180), 4.0);
  EXPECT_EQ(ahead(day_of(2022, 7, 1), 600), 4.0);
  EXPECT_EQ(ahead(day_of(2022, 11, 6), 0), 4.0);
  EXPECT_EQ(ahead(day_of(2022, 11, 6), 180), 0.0);
}

TEST(DstMisapplied, InterpolatesPartsOfAnHour) {
  const Record record(day_of(2022, 6, 1), 5, bowl);
  const std::vector<double> shown_kW = record.with(dst_misapplied(), 0.3, {});  // 1.2 intervals
  EXPECT_NEAR(shown_kW[100], 0.8 * 101.0 * 101.0 + 0.2 * 102.0 * 102.0, 1e-9);
}

TEST(DstMisapplied, ChangesTheClockWhereNobodyDoes) {
  const Record record(day_of(2022, 1, 1), 365, slope, "America/Phoenix");
  const std::vector<double> shown_kW = record.with(dst_misapplied(), 1.0, {});
  const auto ahead = [&](metering::Day day) {
    const std::size_t slot = record.slot_at(day, 600);
    return shown_kW[slot] - record.right_kW()[slot];
  };
  EXPECT_EQ(ahead(day_of(2022, 3, 12)), 0.0);
  EXPECT_EQ(ahead(day_of(2022, 3, 13)), -4.0);
  EXPECT_EQ(ahead(day_of(2022, 11, 5)), -4.0);
  EXPECT_EQ(ahead(day_of(2022, 11, 6)), 0.0);
}

}  // namespace
}  // namespace recald::simulators::meter_effects_test
