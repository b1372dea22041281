#include "daemon/gateway/feed/rising_watch.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace recald::daemon::rising_watch_test {
namespace {

using metering::Reading;
using metering::Validity;
using std::chrono::minutes;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const metering::Instant kStart = std::chrono::sys_days{std::chrono::year{2025} / 6 / 1};

std::vector<Reading> readings(const std::vector<double>& values_kW, std::size_t first = 0) {
  std::vector<Reading> made;
  for (std::size_t i = 0; i < values_kW.size(); ++i) {
    made.push_back({0, kStart + minutes{15} * (first + i), values_kW[i]});
  }
  return made;
}

bool is_suspect(const Reading& reading) { return reading.validity == Validity::suspect; }

// Whatever the register's count and load, in one push or in pushes of one.
TEST(RisingWatch, ARegisterIsFoundAndAllOfItDoubted) {
  constexpr std::size_t kCount = 120;  // thirty hours
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> load_kW{0.5, 40.0};
    double register_kW = std::exp(std::uniform_real_distribution<double>{3.0, 10.0}(random));
    RisingWatch watch;
    std::ptrdiff_t doubted = 0;
    const std::size_t at_once = seed % 2 == 0 ? 1 : 6;
    for (std::size_t i = 0; i < kCount; i += at_once) {
      std::vector<double> values;
      for (std::size_t k = 0; k < at_once; ++k) values.push_back(register_kW += load_kW(random));
      auto pushed = readings(values, i);
      const auto doubt = watch.look(pushed, minutes{15});
      doubted = std::ssize(doubt.before) + std::ranges::count_if(pushed, is_suspect);
      if (i + at_once == kCount) {
        EXPECT_THAT(doubt.words, HasSubstr("only rise"));
      }
    }
    EXPECT_EQ(doubted, std::ptrdiff_t{kCount});
  }
}

// A load never rises so evenly, in a morning neither.
TEST(RisingWatch, ALoadIsNone) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random{seed};
    std::normal_distribution<double> noise{0.0, 0.02};
    std::vector<double> values_kW;
    for (int i = 0; i < 400; ++i) {
      const double of_day = std::sin(i / 96.0 * 6.283);
      values_kW.push_back((30.0 + 20.0 * of_day) * (1.0 + noise(random)));
    }
    RisingWatch watch;
    auto pushed = readings(values_kW);
    EXPECT_THAT(watch.look(pushed, minutes{15}).words, IsEmpty());
    EXPECT_EQ(std::ranges::count_if(pushed, is_suspect), 0);
  }
}

// A clear day, as inverters send it each minute: it rises for hours, and by little around noon.
TEST(RisingWatch, AClearMorningIsNone) {
  for (const double step_minutes : {1.0, 5.0, 15.0}) {
    std::vector<double> values_kW;
    for (int i = 0; i < 3 * 24 * 60 / step_minutes; ++i) {
      const double of_day = std::sin(i * step_minutes / 1440.0 * 6.283 - 1.571);
      values_kW.push_back(200.0 * std::max(0.0, of_day));
    }
    RisingWatch watch;
    auto pushed = readings(values_kW);
    for (std::size_t i = 0; i < pushed.size(); ++i) {
      pushed[i].start = kStart + std::chrono::seconds{static_cast<int>(60 * step_minutes)} * i;
    }
    EXPECT_THAT(watch.look(pushed, minutes{15}).words, IsEmpty()) << step_minutes;
  }
}

// A steady load is the same again and again.
TEST(RisingWatch, ASteadyLoadIsNone) {
  RisingWatch watch;
  auto pushed = readings(std::vector<double>(100, 12.0));
  EXPECT_THAT(watch.look(pushed, minutes{15}).words, IsEmpty());
}

// Four readings of a large register, or of a large steady load: nothing is thrown away.
TEST(RisingWatch, AFewSmallRisesAreOnlyTold) {
  RisingWatch watch;
  auto pushed = readings({8138.0, 8152.4, 8166.8, 8181.2});
  const auto doubt = watch.look(pushed, minutes{15});
  EXPECT_TRUE(doubt.is_weak);
  EXPECT_THAT(doubt.words, HasSubstr("only rise"));
  EXPECT_EQ(std::ranges::count_if(pushed, is_suspect), 0);
}

TEST(RisingWatch, OneValueLargerThanAnyBuildingsIsDoubted) {
  RisingWatch watch;
  auto pushed = readings({12.0, 728'138.0, 11.0});
  EXPECT_THAT(watch.look(pushed, minutes{15}).words, HasSubstr("larger than any building's"));
  EXPECT_TRUE(is_suspect(pushed[1]));
  EXPECT_FALSE(is_suspect(pushed[0]) || is_suspect(pushed[2]));
}

}  // namespace
}  // namespace recald::daemon::rising_watch_test
