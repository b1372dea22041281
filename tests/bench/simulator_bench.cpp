// One simulated building-year at fifteen-minute steps against the same year at five: the first is
// what blind populations are made of. Ratios are what counts; absolute times belong to the machine.

#include <benchmark/benchmark.h>

#include "simulators/scenario/archetypes.hpp"
#include "simulators/scenario/twin.hpp"

namespace {

using namespace recald::simulators;

void building_year(benchmark::State& state, std::chrono::seconds step) {
  Scenario scenario;
  scenario.drawings = draw_up({.use = Use::office, .storeys = 6});
  scenario.period = {2022, 1};
  scenario.step = step;
  const auto calendar = recald::metering::LocalCalendar::open(scenario.drawings.time_zone);
  for (auto _ : state) {
    auto simulated = simulate(scenario, 1, *calendar);
    benchmark::DoNotOptimize(simulated->recording.power.data());
  }
}

void BM_BuildingYearFiveMinutes(benchmark::State& state) {
  building_year(state, std::chrono::seconds{300});
}
void BM_BuildingYearFifteenMinutes(benchmark::State& state) {
  building_year(state, std::chrono::seconds{900});
}
BENCHMARK(BM_BuildingYearFiveMinutes)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_BuildingYearFifteenMinutes)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
