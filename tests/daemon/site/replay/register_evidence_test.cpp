#include "daemon/site/replay/register_evidence.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>

namespace recald::daemon::register_evidence_test {
namespace {

using metering::Instant;
using metering::Resets;
using std::chrono::days;
using std::chrono::hours;
using std::chrono::minutes;
using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::Ge;
using ::testing::Le;
using ::testing::SizeIs;

const metering::LocalCalendar kZone = metering::LocalCalendar::open("Europe/Amsterdam").value();
const Instant kStart = kZone.day_span(std::chrono::year{2025} / 3 / 10).begin;

/// A load of 2 to 18 kW; at night none, if it rests.
double load_kW(Instant t, std::mt19937& random, bool rests) {
  std::uniform_real_distribution<double> of_usual{0.7, 1.3};
  const double hour = std::fmod(metering::in_hours(t - kStart), 24.0);
  if (hour > 7.0 && hour < 19.0) return 14.0 * of_usual(random);
  return rests ? 0.0 : 3.0 * of_usual(random);
}

/// What a register shows as it counts a load.
RegisterVerdict verdict(unsigned seed, seconds step, days length,
                        const std::function<double(Instant, double used_kWh)>& shows,
                        bool rests = false) {
  std::mt19937 random{seed};
  RegisterEvidence evidence;
  double used_kWh = 0.0;
  for (Instant t = kStart; t <= kStart + length; t += step) {
    evidence.take(t, shows(t, used_kWh));
    used_kWh += load_kW(t, random, rests) * metering::in_hours(step);
  }
  return evidence.verdict(kZone);
}

TEST(RegisterEvidence, ATotalIsFoundWithItsRating) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    for (const seconds step : {seconds{minutes{5}}, seconds{minutes{15}}, seconds{hours{1}}}) {
      SCOPED_TRACE(seed);
      const auto found = verdict(
          seed, step, days{20}, [](Instant, double used) { return 5000.0 + used; }, seed % 2 == 0);
      EXPECT_TRUE(found.is_register);
      EXPECT_EQ(found.resets, Resets::never);
      EXPECT_FALSE(found.runs_back);
      EXPECT_THAT(found.rated_kW, AllOf(Ge(1.2 * 18.0), Le(1.7 * 18.2)));
      EXPECT_THAT(found.exchanges, SizeIs(0));
    }
  }
}

// Neither a jump nor a value that was misread now and then says how much the load draws.
TEST(RegisterEvidence, AnExchangeRatesNothing) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    const Instant exchanged = kStart + days{7} + seed * minutes{15};
    const auto found = verdict(seed, minutes{15}, days{20}, [&](Instant t, double used) {
      if (seed % 3 == 0 && (t - kStart) % days{2} == hours{11}) return 0.0;  // misread
      const double other_kWh = seed % 2 == 0 ? 60'000.0 : 12.0;
      return t < exchanged ? 5000.0 + used : other_kWh + used;
    });
    EXPECT_TRUE(found.is_register);
    EXPECT_THAT(found.rated_kW, AllOf(Ge(1.2 * 18.0), Le(1.7 * 18.2)));
    ASSERT_THAT(found.exchanges, SizeIs(1));
    EXPECT_EQ(found.exchanges[0].to.time, exchanged);
  }
}

// A register that is zeroed by somebody's midnight is one, and by whose.
TEST(RegisterEvidence, ResetsAreFoundByTheirMidnights) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    for (const std::string zone : {"Europe/Amsterdam", "Etc/UTC", "Etc/GMT-1"}) {
      for (const Resets resets : {Resets::daily, Resets::monthly}) {
        SCOPED_TRACE(zone + (resets == Resets::daily ? " daily " : " monthly ") +
                     std::to_string(seed));
        const auto zeroed =
            metering::reset_times(resets, metering::LocalCalendar::open(zone).value());
        double at_reset_kWh = 0.0;
        Instant last = zeroed(kStart);
        const auto found = verdict(
            seed, minutes{15}, days{100},
            [&](Instant t, double used) {
              if (std::exchange(last, zeroed(t)) != last) at_reset_kWh = used;
              return used - at_reset_kWh;
            },
            seed > 3);
        ASSERT_TRUE(found.is_register);
        EXPECT_EQ(found.resets, resets);
        if (resets == Resets::daily) {
          EXPECT_EQ(found.reset_zone, zone == "Europe/Amsterdam" ? "" : zone);
        }
      }
    }
  }
}

TEST(RegisterEvidence, ANetRegisterRunsBack) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> of_usual{0.5, 1.5};
    RegisterEvidence evidence;
    double net_kWh = 20'000.0;
    for (Instant t = kStart; t < kStart + days{60}; t += minutes{15}) {
      evidence.take(t, net_kWh);
      const double hour = std::fmod(metering::in_hours(t - kStart), 24.0);
      const double sun_kW = hour > 8.0 && hour < 18.0 ? 9.0 * of_usual(random) : 0.0;
      net_kWh += (6.0 * of_usual(random) - sun_kW) / 4.0;
    }
    const auto found = evidence.verdict(kZone);
    EXPECT_TRUE(found.is_register);
    EXPECT_TRUE(found.runs_back);
  }
}

// Amounts, however smooth, seasonal or resting, are no register.
TEST(RegisterEvidence, AmountsAreNone) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random{seed};
    std::normal_distribution<double> noise{1.0, seed % 2 == 0 ? 0.01 : 0.2};
    RegisterEvidence evidence;
    const seconds step = seed % 3 == 0 ? minutes{1} : minutes{15};
    for (Instant t = kStart; t < kStart + days{200}; t += step) {
      const double hour = metering::in_hours(t - kStart);
      const double season = 1.0 + 0.5 * std::sin(hour / 8760.0 * 6.283);
      const double sun = std::max(0.0, std::sin((hour - 6.0) / 12.0 * 3.1416));
      const double use = season * (3.0 + 2.0 * std::sin(hour / 24.0 * 6.283));
      evidence.take(t, (seed % 4 == 0 ? sun : use) * noise(random));
    }
    EXPECT_FALSE(evidence.verdict(kZone).is_register);
  }
}

}  // namespace
}  // namespace recald::daemon::register_evidence_test
