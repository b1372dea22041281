// What one evaluation of the EPC costs, over two years, against the plain hourly sum of the same
// equations in the same run. Ratios are what counts; absolute times belong to the machine.

#include <benchmark/benchmark.h>

#include "core/model/epc/epc_model.hpp"
#include "tests/support/sample_building.hpp"

namespace {

using namespace recald;

model::epc::EpcModel make_model(int classes_per_state) {
  const model::Building building = testing::sample_building();
  const auto climate = std::make_shared<const model::epc::ClimateClasses>(
      model::epc::make_climate_classes(testing::sample_drivers(building, 24), classes_per_state));
  return {building,
          {*model::find_parameter("occupancy_density"), *model::find_parameter("outdoor_airflow"),
           *model::find_parameter("cooling_setpoint")},
          {*model::default_meter_map(metering::Utility::chilled_water),
           *model::default_meter_map(metering::Utility::steam)},
          climate};
}

void evaluate(benchmark::State& state, int classes_per_state) {
  model::epc::EpcModel model = make_model(classes_per_state);
  std::vector<double> outputs(48);
  double theta[] = {0.05, 6.0, 24.0};
  for (auto _ : state) {
    theta[2] = 25.0 - 0.5 * theta[2] / 24.0;
    model.evaluate(theta, outputs);
    benchmark::DoNotOptimize(outputs.data());
  }
}

void BM_EpcHourlySums(benchmark::State& state) { evaluate(state, 0); }
void BM_EpcClasses(benchmark::State& state) { evaluate(state, model::epc::kClassesPerState); }
BENCHMARK(BM_EpcHourlySums)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_EpcClasses)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
