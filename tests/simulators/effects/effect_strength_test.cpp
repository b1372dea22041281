// What holds for each effect of the catalogue through a year of cold-climate weather: twice the
// strength turns the same things at the same hours, by the same chance, and turns them further.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <optional>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "simulators/climate/weather.hpp"
#include "tests/simulators/effects/by_hand.hpp"

namespace recald::simulators::effect_strength_test {
namespace {

const metering::Day kFirst = day_of(2021, 1, 1);
constexpr int kDays = 365;

/// One cold-winter year, an hour a step.
const std::vector<Outdoors>& weather() {
  static const std::vector<Outdoors> year = [] {
    const auto begin = std::chrono::sys_days{kFirst};
    WeatherGenerator generator(climate_of(ClimateKind::cold, Place{44.9, -93.2, 256.0}), begin,
                               Rng{3, 1}, std::chrono::minutes{60});
    std::vector<Outdoors> steps;
    for (int hour = 0; hour < 24 * kDays; ++hour) steps.push_back(generator.advance());
    return steps;
  }();
  return year;
}

/// A struct of nothing but doubles, number by number.
template <class Doubles>
void append(std::vector<double>& numbers, const Doubles& doubles) {
  constexpr std::size_t count = sizeof(Doubles) / sizeof(double);
  static_assert(sizeof(Doubles) == count * sizeof(double));
  const auto flat = std::bit_cast<std::array<double, count>>(doubles);
  numbers.insert(numbers.end(), flat.begin(), flat.end());
}

void append(std::vector<double>& numbers, const AirOperation& air) {
  static_assert(sizeof(AirOperation) == 11 * sizeof(double) + sizeof(std::optional<double>),
                "a new member must be listed here");
  numbers.insert(
      numbers.end(),
      {air.outdoor_factor, air.damper_leak_share, air.economiser_share, air.economiser_shift_K,
       air.supply_shift_K, air.supply_reset_share, air.night_run_share, air.reheat_leak_share,
       air.fan_follows_flow, air.dry_to_C.value_or(99.0), air.humidify_to_kg_kg, air.purge_share});
}

/// All that an effect can turn in one step, weighed so that more of it is more on a meter.
std::vector<double> turned_in_step(Bench& bench, metering::Day day, int hour,
                                   const Timetable& timetable) {
  std::vector<double> numbers{hours(timetable.air),
                              hours(timetable.air) > 0.0 ? timetable.warm_up_h : 0.0,
                              timetable.attendance};
  const Operation operation = bench.operate(day, hour);
  append(numbers, operation.rooms);
  append(numbers, operation.air);
  append(numbers, operation.envelope);
  append(numbers, operation.plant);
  const double summer = std::max(0.0, bench.outdoors.air.temperature_C - 12.0);
  const ServiceLoad asked{.cooling_W = 40e3 * summer,
                          .heating_W = 10e3 * std::max(0.0, 18.0 - summer),
                          .lights_and_plugs_W = 90e3,
                          .fans_W = 20e3,
                          .people_share = bench.people_share};
  const ServiceLoad load = bench.load(day, hour, asked);
  numbers.insert(numbers.end(), {load.cooling_W, load.heating_W, load.lights_and_plugs_W,
                                 load.fans_W, load.other_electricity_W, load.other_fuel_W});
  append(numbers, bench.supply(day, hour, {200.0, 500.0, 300.0}));
  return numbers;
}

std::vector<std::vector<double>> turned(const EffectKind& kind, const EffectSettings& settings) {
  Drawings drawings;
  drawings.skylight_share = 0.1;
  drawings.economiser_limit_C = 18.0;
  Bench bench(kind, settings, drawings);
  bench.step_s = 3600.0;
  std::vector<std::vector<double>> steps;
  metering::Day day = kFirst;
  for (int i = 0; i < kDays; ++i, day = next(day)) {
    const Timetable timetable = bench.plan(day);
    for (int hour = 0; hour < 24; ++hour) {
      const bool in = timetable.kind == DayKind::workday && hour >= 8 && hour < 18;
      bench.people_share = in ? 0.7 * timetable.attendance : 0.0;
      bench.outdoors = weather()[static_cast<std::size_t>(24 * i + hour)];
      steps.push_back(turned_in_step(bench, day, hour, timetable));
    }
  }
  return steps;
}

EffectSettings settings_for(const EffectKind& kind, double strength) {
  EffectSettings settings = strength_of(strength);
  if (kind.dated) settings.from = day_of(2021, 3, 1);
  if (kind.of_one_meter) settings.meter = Utility::electricity;
  return settings;
}

/// A kind that is printed by its name.
struct NamedKind : EffectKind {
  friend void PrintTo(const NamedKind& kind, std::ostream* out) { *out << kind.id; }
};

class EffectStrength : public ::testing::TestWithParam<NamedKind> {
 protected:
  /// What people, controls and plant do when nothing is hidden.
  static const std::vector<std::vector<double>>& nothing() {
    static const auto steps = [] {
      EffectKind none = effect_kinds().front();
      none.make = [](const EffectSettings&, const Drawings&) -> std::unique_ptr<HiddenEffect> {
        return std::make_unique<HiddenEffect>();
      };
      return turned(none, {});
    }();
    return steps;
  }
};

TEST_P(EffectStrength, MoreStrengthTurnsTheSameThingsFurther) {
  // A store that holds more may give at other hours; a relief is followed by a rebound.
  const std::set<std::string_view> moves_in_time{"ice_storage", "demand_limit"};
  if (moves_in_time.contains(GetParam().id)) GTEST_SKIP() << "moves what it turns in time";
  const StrengthRange& range = GetParam().strength;
  for (const double end : {range.max, range.min}) {
    if (end == 0.0) continue;
    const auto half = turned(GetParam(), settings_for(GetParam(), 0.5 * end));
    const auto full = turned(GetParam(), settings_for(GetParam(), end));
    for (std::size_t step = 0; step < full.size(); ++step) {
      for (std::size_t i = 0; i < full[step].size(); ++i) {
        const double half_turn = half[step][i] - nothing()[step][i];
        const double full_turn = full[step][i] - nothing()[step][i];
        const double slack = 1e-9 * (1.0 + std::abs(nothing()[step][i]));
        ASSERT_GE(half_turn * full_turn, 0.0) << "number " << i << " at step " << step;
        ASSERT_GE(std::abs(full_turn), std::abs(half_turn) - slack)
            << "number " << i << " at step " << step << ", strength " << end;
      }
    }
  }
}

TEST_P(EffectStrength, IsExplainedAndWithinItsRange) {
  const EffectKind& kind = GetParam();
  EXPECT_FALSE(kind.title.empty());
  EXPECT_GT(kind.sentence.size(), 60U);
  EXPECT_EQ(kind.sentence.back(), '.');
  EXPECT_FALSE(kind.turns.empty());
  EXPECT_FALSE(kind.strength.unit.empty());
  EXPECT_LE(kind.strength.min, 0.0);
  EXPECT_NE(kind.strength.typical, 0.0);
  EXPECT_GE(kind.strength.typical, kind.strength.min);
  EXPECT_LE(kind.strength.typical, kind.strength.max);
  EXPECT_EQ(find_effect_kind(kind.id)->id, kind.id);
}

std::vector<NamedKind> named_kinds() {
  std::vector<NamedKind> kinds;
  for (const EffectKind& kind : effect_kinds()) kinds.push_back({kind});
  return kinds;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EffectStrength, ::testing::ValuesIn(named_kinds()),
                         [](const auto& tested) { return std::string(tested.param.id); });

}  // namespace
}  // namespace recald::simulators::effect_strength_test
