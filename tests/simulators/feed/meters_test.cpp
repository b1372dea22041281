#include "simulators/feed/meters.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace recald::simulators::meters_test {
namespace {

using namespace std::chrono;

/// Three years of a plain daily wave: meters do not care where power comes from.
Recording wave() {
  Recording recording{sys_days{2021y / January / 1} + 5h, {}, {}};
  for (std::size_t slot = 0; slot < 3 * 365 * 96; ++slot) {
    const double phase = std::sin(2.0 * 3.14159265 * static_cast<double>(slot) / 96.0);
    recording.power.push_back({150.0 + 60.0 * phase, 400.0 + 300.0 * phase, 120.0 - 50.0 * phase});
    recording.weather.push_back(
        {15.0 + 8.0 * phase, 0.6, 3.5, 200.0, std::max(0.0, 700.0 * phase)});
  }
  return recording;
}

const metering::LocalCalendar& calendar() {
  static const auto opened = metering::LocalCalendar::open("America/New_York");
  return *opened;
}

MeterFeed read(const Recording& recording, const MeterPlate& plate, MeterCare care,
               std::uint64_t seed) {
  return read_meter(recording, plate, care, seed, {}, calendar());
}

/// Chilled water, electricity, steam.
const std::vector<MeterPlate>& all_plates() {
  static const std::vector<MeterPlate> plates = plates_of({});
  return plates;
}
const MeterPlate& plate_for(Utility utility) {
  return all_plates()[static_cast<std::size_t>(utility)];
}

TEST(Meters, WithoutFaultsTheyReadWithinTheirClass) {
  const Recording recording = wave();
  for (const MeterPlate& plate : all_plates()) {
    SCOPED_TRACE(plate.id);
    const MeterFeed feed = read(recording, plate, MeterCare::perfect, 1);
    EXPECT_TRUE(feed.faults.empty());
    double read_kWh = 0.0;
    double true_kWh = 0.0;
    for (std::size_t slot = 0; slot < feed.cells.size(); ++slot) {
      ASSERT_EQ(feed.cells[slot].state, CellState::value);
      const double power_kW = recording.power[slot][plate.utility];
      const double read_kW = feed.cells[slot].value * plate.unit_kW;
      ASSERT_NEAR(read_kW, power_kW, 0.25 * power_kW + 5.0 * plate.resolution * plate.unit_kW);
      const double steps = feed.cells[slot].value / plate.resolution;
      ASSERT_NEAR(steps, std::round(steps), 1e-6);
      read_kWh += 0.25 * read_kW;
      true_kWh += 0.25 * power_kW;
    }
    EXPECT_NEAR(read_kWh / true_kWh, feed.gain, 0.001);
    EXPECT_NEAR(feed.gain, 1.0, 0.05);
  }
}

// Pulses that did not fill an interval are carried over: a load far below one pulse keeps its mean.
TEST(Meters, CountingMetersLoseNoEnergyToResolution) {
  Recording recording{sys_days{2021y / January / 1}, {}, {}};
  recording.power.assign(100'000, {0.1, 0.1, 0.1});
  const MeterFeed feed = read(recording, plate_for(Utility::electricity), MeterCare::perfect, 1);
  double mean_kW = 0.0;
  for (const Cell& cell : feed.cells) mean_kW += cell.value / 100'000.0;
  EXPECT_NEAR(mean_kW, 0.1, 0.005);  // five standard errors of the noise
}

TEST(Meters, EveryDeclaredFaultShowsInTheFeedAndNothingElseIsTouched) {
  const Recording recording = wave();
  for (const MeterPlate& plate : all_plates()) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      SCOPED_TRACE(plate.id);
      SCOPED_TRACE(seed);
      const MeterFeed clean = read(recording, plate, MeterCare::perfect, seed);
      const MeterFeed feed = read(recording, plate, MeterCare::usual, seed);
      std::vector<bool> faulty(feed.cells.size(), false);
      for (const Fault& fault : feed.faults) {
        for (std::size_t slot = fault.first; slot < fault.first + fault.count; ++slot) {
          ASSERT_FALSE(faulty[slot]);
          faulty[slot] = true;
          const Cell& cell = feed.cells[slot];
          switch (fault.kind) {
            case FaultKind::gap:
              ASSERT_EQ(cell.state, CellState::absent);
              break;
            case FaultKind::blank:
              ASSERT_EQ(cell.state, CellState::blank);
              break;
            case FaultKind::stuck:
              ASSERT_EQ(cell.value, feed.cells[fault.first - 1].value);
              ASSERT_GT(cell.value, 0.0);
              ASSERT_GT(fault.count, 12u);  // long enough for a check of three hours
              break;
            case FaultKind::zero:
              ASSERT_EQ(cell.value, 0.0);
              ASSERT_GT(fault.count, 24u);  // longer than any believable pause
              break;
            case FaultKind::spike:
              ASSERT_GE(cell.value, plate.spike_min);
              break;
            case FaultKind::negative:
              ASSERT_LT(cell.value, 0.0);
              break;
          }
        }
      }
      for (std::size_t slot = 0; slot < feed.cells.size(); ++slot) {
        if (faulty[slot]) continue;
        ASSERT_EQ(feed.cells[slot].state, CellState::value);
        ASSERT_EQ(feed.cells[slot].value, clean.cells[slot].value);
      }
    }
  }
}

TEST(Meters, SpikesExceedTheRatingsOfTheSiteFile) {
  for (const HeatingPlant heating :
       {HeatingPlant::district_steam, HeatingPlant::district_water, HeatingPlant::boiler}) {
    Drawings drawings;
    drawings.heating = heating;
    for (const MeterPlate& plate : plates_of(drawings)) {
      EXPECT_GT(plate.spike_min * plate.unit_kW, 1.2 * plate.rated_kW) << plate.id;
    }
  }
}

TEST(Meters, SteamIsBadlyButNotHopelesslyCorrupted) {
  const Recording recording = wave();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const auto lost = [&](Utility utility) {
      const MeterFeed feed = read(recording, plate_for(utility), MeterCare::usual, seed);
      double slots = 0.0;
      for (const Fault& fault : feed.faults) slots += static_cast<double>(fault.count);
      return slots / static_cast<double>(feed.cells.size());
    };
    const double steam = lost(Utility::heat);
    EXPECT_GT(steam, 0.12);
    EXPECT_LT(steam, 0.33);
    EXPECT_LT(lost(Utility::electricity), 0.04);
    EXPECT_LT(lost(Utility::cooling), 0.04);
  }
}

TEST(Meters, UnitsAreThoseOfTheFile) {
  EXPECT_NEAR(plate_for(Utility::cooling).unit_kW, 12'000.0 * 0.29307107e-3, 1e-6);
  EXPECT_NEAR(plate_for(Utility::heat).unit_kW, 4.0 * 0.29307107, 1e-12);
}

TEST(Meters, LoggersWithGapsLoseAboutATwentiethAndNothingElse) {
  const Recording recording = wave();
  double lost = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const MeterFeed feed = read(recording, plate_for(Utility::heat), MeterCare::gaps, seed);
    for (const Fault& fault : feed.faults) {
      ASSERT_EQ(fault.kind, FaultKind::gap);
      lost += static_cast<double>(fault.count) / static_cast<double>(feed.cells.size()) / 20.0;
    }
  }
  EXPECT_NEAR(lost, 0.05, 0.01);
}

TEST(Meters, AHeatPumpsHeatIsNotMetered) {
  Drawings drawings;
  drawings.heating = HeatingPlant::heat_pump;
  EXPECT_EQ(plates_of(drawings).size(), 2u);
}

TEST(WeatherStation, ReadsNearTheTruthAndDeclaresItsGaps) {
  const Recording recording = wave();
  const WeatherFeed feed = read_weather_station(recording, MeterCare::usual, 1);
  std::size_t absent = 0;
  std::size_t blank = 0;
  for (std::size_t slot = 0; slot < feed.cells.size(); ++slot) {
    const WeatherCell& cell = feed.cells[slot];
    absent += cell.absent ? 1 : 0;
    blank += cell.humidity_blank ? 1 : 0;
    ASSERT_NEAR(cell.reading.dry_bulb_C, recording.weather[slot].dry_bulb_C, 1.2);
    ASSERT_NEAR(cell.reading.relative_humidity, recording.weather[slot].relative_humidity, 0.12);
    ASSERT_GE(cell.reading.wind_from_deg, 0.0);
    ASSERT_LT(cell.reading.wind_from_deg, 360.0);
  }
  std::size_t declared = 0;
  for (const Fault& fault : feed.faults) declared += fault.count;
  EXPECT_EQ(absent + blank, declared);
  EXPECT_GT(declared, 0u);
  EXPECT_LT(declared, feed.cells.size() / 50);
}

}  // namespace
}  // namespace recald::simulators::meters_test
