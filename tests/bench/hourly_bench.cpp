// What one run of the hourly model costs over two years: five zones in two parts (some handlers run
// round the clock) and in one. Ratios are what counts; absolute times belong to the machine.

#include <benchmark/benchmark.h>

#include "core/model/hourly/hourly.hpp"
#include "tests/support/sample_building.hpp"

namespace {

using namespace recald;

void run(benchmark::State& state, double always_share, int steps_per_hour) {
  model::Building building = testing::sample_building();
  building.air->outdoor_air_unoccupied_fraction = always_share;
  model::hourly::Hourly hourly{
      std::make_shared<const model::Drivers>(testing::sample_drivers(building, 24)),
      {.steps_per_hour = steps_per_hour}};
  const model::MeterMap meters[] = {*model::default_meter_map(metering::Utility::electricity),
                                    *model::default_meter_map(metering::Utility::chilled_water),
                                    *model::default_meter_map(metering::Utility::steam)};
  Eigen::ArrayXXd power_kW(hourly.step_count(), 3);
  for (auto _ : state) {
    hourly.run(building, {}, meters, power_kW);
    benchmark::DoNotOptimize(power_kW.data());
  }
}

void BM_HourlyOnePart(benchmark::State& state) { run(state, 0.0, 1); }
void BM_HourlyTwoParts(benchmark::State& state) { run(state, 0.4, 1); }
void BM_QuarterHourlyTwoParts(benchmark::State& state) { run(state, 0.4, 4); }
BENCHMARK(BM_HourlyOnePart)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_HourlyTwoParts)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_QuarterHourlyTwoParts)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
