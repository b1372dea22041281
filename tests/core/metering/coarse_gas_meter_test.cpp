/// Gas meters that show 0 or a few steps most of the time, and the boiler's firings between.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <random>
#include <string>

#include "core/metering/months/validation.hpp"
#include "month_builder.hpp"

namespace recald::metering::coarse_gas_meter_test {
namespace {

using testing::calendar;
using testing::kQuarter;
using testing::month;

/// How the boiler fires. Energies are kWh of gas in a quarter of an hour.
struct Firing {
  const char* name;
  double per_day;    ///< Firings, on average.
  int quarters_max;  ///< Length of a firing.
  double low_kWh;    ///< In a quarter of full firing: one boiler, or a cascade that modulates.
  double high_kWh;
  double hot_water_kWh;  ///< A quarter's mean draw between firings.
  bool weekly = false;   ///< Mondays only.
};

constexpr Firing kFirings[] = {{"one_a_day", 1.0, 1, 90.0, 90.0, 2.0},
                               {"a_few_a_day", 3.0, 2, 80.0, 100.0, 2.0},
                               {"modulating", 2.0, 2, 40.0, 120.0, 3.0},
                               {"with_kitchen", 2.0, 1, 70.0, 90.0, 12.0},
                               {"monday_start", 1.0, 2, 100.0, 120.0, 3.0, true},
                               {"cold", 12.0, 4, 80.0, 100.0, 3.0}};

struct Case {
  double step_kWh;  ///< 0.1 m³ is 1.1 kWh, 1 m³ 11 kWh, 100 cubic feet 29 kWh.
  Firing firing;
  [[nodiscard]] std::string name() const {
    return std::to_string(std::lround(step_kWh)) + "_kWh_" + firing.name;
  }
  friend void PrintTo(const Case& which, std::ostream* out) { *out << which.name(); }
};

/// What the register rose by in each quarter, kWh.
std::vector<double> quarters(const Case& which, int slots, std::mt19937& random) {
  const Firing& firing = which.firing;
  std::uniform_real_distribution<double> uniform{0.0, 1.0};
  std::vector<double> energy_kWh(static_cast<std::size_t>(slots), 0.0);
  for (double& one_kWh : energy_kWh) one_kWh = -firing.hot_water_kWh * std::log(uniform(random));
  for (int slot = 0; slot < slots; ++slot) {
    const bool may_fire = !firing.weekly || slot / 96 % 7 == 2;
    const int length = 1 + static_cast<int>(uniform(random) * firing.quarters_max);
    if (!may_fire || uniform(random) > firing.per_day / 96.0) continue;
    const double full_kWh = firing.low_kWh + (firing.high_kWh - firing.low_kWh) * uniform(random);
    for (int i = slot; i < std::min(slots, slot + length); ++i) {
      energy_kWh[static_cast<std::size_t>(i)] += full_kWh;
    }
  }
  double count_kWh = 0.0;
  double shown_kWh = 0.0;
  for (double& one_kWh : energy_kWh) {
    count_kWh += one_kWh;
    const double now_kWh = std::floor(count_kWh / which.step_kWh) * which.step_kWh;
    one_kWh = now_kWh - shown_kWh;
    shown_kWh = now_kWh;
  }
  return energy_kWh;
}

struct Score {
  int readings = 0;
  int false_alarms = 0;
  double lost_share = 0.0;  ///< Of the months' energy, in false alarms.
  int glitches = 0;
  int found = 0;
};

/// Twenty Januaries, each with one glitch: so many times the month's largest reading, at a random
/// quarter; 0: none.
Score judge(const Case& which, double glitch) {
  Score score;
  double energy_kW = 0.0;
  double lost_kW = 0.0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random{seed};
    const auto energy_kWh = quarters(which, 31 * 96, random);
    const double largest_kWh = *std::max_element(energy_kWh.begin(), energy_kWh.end());
    const int at = static_cast<int>(std::uniform_real_distribution<double>{}(random)*31 * 96);
    const auto before_kWh = quarters(which, 31 * 96, random);
    const auto reading = [](const std::vector<double>& from) {
      return [&from](int slot) { return 4.0 * from[static_cast<std::size_t>(slot)]; };
    };
    MonthSlots before =
        testing::month_reading("UTC", month(2022, 12), kQuarter, reading(before_kWh));
    MonthSlots slots = testing::month_reading("UTC", month(2023, 1), kQuarter, reading(energy_kWh));
    if (glitch > 0.0) {
      slots.measured_kW[static_cast<std::size_t>(at)] = 4.0 * largest_kWh * glitch;
      ++score.glitches;
    }
    Meter meter;
    meter.utility = Utility::gas;
    meter.stuck_max = std::chrono::seconds{0};
    // So generous that the range check leaves the glitch to the spike rule.
    meter.rated_kW = 4.0 * largest_kWh * std::max(1.0, glitch);
    validate(slots, meter, {&before}, {});
    for (int slot = 0; slot < slots.slots(); ++slot) {
      const double value_kW = slots.measured_kW[static_cast<std::size_t>(slot)];
      const bool is_suspect = slots.validity[static_cast<std::size_t>(slot)] == Validity::suspect;
      if (glitch > 0.0 && slot == at) {
        score.found += is_suspect ? 1 : 0;
        continue;
      }
      ++score.readings;
      energy_kW += value_kW;
      if (!is_suspect) continue;
      ++score.false_alarms;
      lost_kW += value_kW;
    }
  }
  score.lost_share = lost_kW / energy_kW;
  return score;
}

class CoarseGasMeter : public ::testing::TestWithParam<Case> {};

TEST_P(CoarseGasMeter, ItsFiringsAreBelieved) {
  const Score score = judge(GetParam(), 0.0);
  // A firing that is alone for a week cannot be told from a glitch.
  EXPECT_LE(score.lost_share, 0.01);
}

TEST_P(CoarseGasMeter, AGlitchBetweenThemIsFound) {
  for (const double glitch : {10.0, 1000.0}) {
    const Score score = judge(GetParam(), glitch);
    EXPECT_EQ(score.found, score.glitches) << glitch;
  }
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const double step_kWh : {1.1, 11.0, 29.3}) {
    for (const Firing& firing : kFirings) all.push_back({step_kWh, firing});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Steps, CoarseGasMeter, ::testing::ValuesIn(cases()),
                         [](const auto& one) { return one.param.name(); });

/// 4 kW all month with 400 kW once.
MonthSlots one_firing(int at) {
  return testing::month_reading("UTC", month(2023, 1), kQuarter, [=](int slot) {
    return slot == at ? 400.0 : 4.0 + 4.0 * (slot % 3);
  });
}

// Nothing else in the month is like it, but the register has counted it and goes on from there. One
// that falls back has misread.
TEST(CounterConfirms, AFiringThatTheRegisterKeeps) {
  Meter meter;
  meter.rated_kW = 500.0;
  constexpr int firing = 1234;
  for (const auto& [is_counted, after, verdict] :
       {std::tuple{false, Reason::none, Validity::suspect},
        std::tuple{true, Reason::none, Validity::ok},
        std::tuple{true, Reason::reset, Validity::suspect}}) {
    meter.is_counted = is_counted;
    MonthSlots slots = one_firing(firing);
    slots.reasons[firing + 1] = after;
    validate(slots, meter, {}, {});
    EXPECT_EQ(slots.validity[firing], verdict) << is_counted << to_string(after);
  }
}

// The first firing of January is like those of the last days of December.
TEST(CoarseGasMeter, AFiringIsConfirmedOverTheMonthsEnd) {
  const auto resting = [](int slot) { return 4.0 * (slot % 3 == 0); };
  const MonthSlots before = testing::month_reading("UTC", month(2022, 12), kQuarter, [&](int slot) {
    return slot == 2900 ? 380.0 : resting(slot);
  });
  for (const MonthSlots* neighbour : {&before, static_cast<const MonthSlots*>(nullptr)}) {
    MonthSlots slots = testing::month_reading("UTC", month(2023, 1), kQuarter, [&](int slot) {
      return slot == 50 ? 400.0 : resting(slot);
    });
    Meter meter;
    meter.rated_kW = 500.0;
    validate(slots, meter, {neighbour}, {});
    EXPECT_EQ(slots.validity[50], neighbour != nullptr ? Validity::ok : Validity::suspect);
  }
}

}  // namespace
}  // namespace recald::metering::coarse_gas_meter_test
