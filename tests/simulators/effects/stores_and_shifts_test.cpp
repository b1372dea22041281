// Cold and heat moved to other hours: night_purge, tariff_load_shift, ice_storage.
#include <utility>

#include "tests/simulators/effects/by_hand.hpp"

namespace recald::simulators {

EffectKind night_purge();
EffectKind tariff_load_shift();
EffectKind ice_storage();

}  // namespace recald::simulators

namespace recald::simulators::stores_and_shifts_test {
namespace {

/// The share that purges at this hour after a day and a half of this warmth.
double purge_share(double day_C, double night_C, double humidity_kg_kg, double hour) {
  Bench bench(night_purge(), strength_of(0.6));
  bench.outdoors.air = {day_C, humidity_kg_kg};
  bench.operate_until(kMonday, 23.75);
  bench.operate_until(kTuesday, 12.0);
  bench.outdoors.air.temperature_C = night_C;
  return bench.operate(kTuesday, hour).air.purge_share;
}

TEST(NightPurge, FlushesInCoolDryNightsOfWarmSpells) {
  EXPECT_DOUBLE_EQ(purge_share(26.0, 17.0, 0.008, 23.0), 0.6);
  EXPECT_DOUBLE_EQ(purge_share(26.0, 17.0, 0.008, 3.0), 0.6);
  EXPECT_EQ(purge_share(26.0, 17.0, 0.008, 12.0), 0.0);  // not by day
  EXPECT_EQ(purge_share(26.0, 24.0, 0.008, 23.0), 0.0);  // not with warm air
  EXPECT_EQ(purge_share(12.0, 8.0, 0.006, 23.0), 0.0);   // not in cool seasons
  EXPECT_EQ(purge_share(26.0, 19.0, 0.013, 23.0), 0.0);  // dew point 18 degC: not with damp air
}

TEST(TariffLoadShift, RelaxesSummerAfternoonsAndCoolsAhead) {
  Bench bench(tariff_load_shift(), strength_of(2.0));
  const auto cooling_C = [&](double hour) { return bench.operate(kTuesday, hour).rooms.cooling_C; };
  EXPECT_EQ(cooling_C(9.0), 24.0);
  EXPECT_DOUBLE_EQ(cooling_C(11.0), 24.0 - 0.6 * 2.0);
  EXPECT_DOUBLE_EQ(cooling_C(15.0), 26.0);
  EXPECT_EQ(cooling_C(19.0), 24.0);
  EXPECT_EQ(bench.operate(kTuesday, 8.0).rooms.heating_C, 21.0);
  EXPECT_EQ(bench.operate(kSaturday, 15.0).rooms.cooling_C, 24.0);
}

TEST(TariffLoadShift, SummerIsJuneToSeptember) {
  Bench bench(tariff_load_shift(), strength_of(2.0));
  EXPECT_EQ(bench.operate(day_of(2021, 5, 25), 15.0).rooms.cooling_C, 24.0);
  EXPECT_EQ(bench.operate(day_of(2021, 6, 1), 15.0).rooms.cooling_C, 26.0);
  EXPECT_EQ(bench.operate(day_of(2021, 9, 30), 15.0).rooms.cooling_C, 26.0);
  EXPECT_EQ(bench.operate(day_of(2021, 10, 5), 15.0).rooms.cooling_C, 24.0);
}

TEST(TariffLoadShift, RelaxesWinterMorningsAndHeatsAhead) {
  const metering::Day winter = day_of(2021, 1, 12);
  Bench bench(tariff_load_shift(), strength_of(2.0));
  EXPECT_DOUBLE_EQ(bench.operate(winter, 8.0).rooms.heating_C, 19.0);
  EXPECT_DOUBLE_EQ(bench.operate(winter, 5.0).rooms.heating_C, 21.0 + 0.6 * 2.0);
  EXPECT_EQ(bench.operate(winter, 15.0).rooms.cooling_C, 24.0);
}

TEST(TariffLoadShift, SetPointsNeverMeet) {
  Bench bench(tariff_load_shift(), strength_of(4.0));
  const RoomOperation rooms = bench.operate(kTuesday, 11.0).rooms;
  EXPECT_NEAR(rooms.cooling_C - rooms.heating_C, 1.8, 1e-12);
}

/// Runs whole days under a steady load of the coils.
class ColdStore {
 public:
  explicit ColdStore(double strength, double load_W)
      : bench_(ice_storage(), strength_of(strength), drawings()), load_W_(load_W) {}

  static Drawings drawings() {
    Drawings drawings;
    drawings.chilled_water_design_kW = 900.0;
    return drawings;
  }
  /// Joules into (+) and out of (-) the tank on this day.
  std::pair<double, double> run(metering::Day day) {
    double in_J = 0.0;
    double out_J = 0.0;
    bench_.plan(day);
    for (double hour = 0.0; hour < 24.0; hour += 0.25) {
      const PlantOperation plant = bench_.operate(day, hour).plant;
      bench_.load(day, hour, {.cooling_W = load_W_});
      const double moved_J = plant.cooling_shift_W * bench_.step_s;
      (moved_J > 0.0 ? in_J : out_J) += moved_J;
      EXPECT_GE(plant.cooling_shift_W, -load_W_);
      const bool at_night = hour < 6.0 || hour >= 22.0;
      const bool afternoon = hour >= 12.0 && hour < 18.0;
      if (plant.cooling_shift_W > 0.0) {
        EXPECT_TRUE(at_night) << hour;
        EXPECT_LT(plant.chiller_cop_factor, 1.0) << hour;
      } else {
        EXPECT_EQ(plant.chiller_cop_factor, 1.0) << hour;
      }
      EXPECT_TRUE(afternoon || plant.cooling_shift_W >= 0.0) << hour;
    }
    return {in_J, out_J};
  }

 private:
  Bench bench_;
  double load_W_;
};

TEST(IceStorage, FillsAtNightAndCarriesTheAfternoon) {
  ColdStore store(2.0, 600e3);
  store.run(kMonday);
  const auto [in_J, out_J] = store.run(kTuesday);
  constexpr double capacity_J = 2.0 * 900e3 * 3600.0;
  // The tank loses 1.5 % a day through its walls.
  EXPECT_NEAR(in_J, capacity_J, 0.02 * capacity_J);
  EXPECT_NEAR(out_J, -capacity_J, 0.02 * capacity_J);
}

TEST(IceStorage, GivesNoMoreThanTheCoilsTake) {
  ColdStore store(6.0, 200e3);
  store.run(kMonday);  // seven hours fill it, six are left of this night
  store.run(kMonday);
  const auto [in_J, out_J] = store.run(kTuesday);
  EXPECT_NEAR(out_J, -0.85 * 200e3 * 6.0 * 3600.0, 1.0);
  EXPECT_LT(in_J, 1.1 * -out_J);
}

TEST(IceStorage, RestsOnWeekendsAndWithoutLoad) {
  ColdStore store(2.0, 600e3);
  store.run(kFriday);
  EXPECT_EQ(store.run(kSaturday).second, 0.0);
  ColdStore winter(2.0, 0.0);
  winter.run(kMonday);
  EXPECT_EQ(winter.run(kTuesday).second, 0.0);
}

}  // namespace
}  // namespace recald::simulators::stores_and_shifts_test
