// What it costs to follow a site by one month: 2 048 particles, two outputs of 36 months.
//
// `MonthlyUpdate` forecasts and takes in each month of the third year; `s_a_month` is the mean,
// `s_worst` the dearest of the twelve (the yearly run from the prior is among them), and
// `calibrations_a_month` the mean in units of one full calibration by default on the same points,
// timed in the same run. The model is a polynomial: `daemon/site/drift` follows every site with
// one, be its model the EPC or a meta-model.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <numeric>
#include <string>
#include <vector>

#include "core/calibration/sampling.hpp"
#include "core/drift/sequential.hpp"
#include "core/model/metamodel/quadratic_model.hpp"

namespace {

using namespace recald;
using namespace recald::calibration;

constexpr int kOutputs = 2;
constexpr int kMonths = 36;
constexpr int kParameters = 4;

model::metamodel::QuadraticModel model() {
  Rng rng{1};
  model::metamodel::QuadraticCoefficients coefficients{
      std::vector<regression::ColumnScale>(kParameters, {0.0, 1.0}), kOutputs, kMonths};
  for (int output = 0; output < kOutputs; ++output) {
    for (int month = 0; month < kMonths; ++month) {
      coefficients.add_constant(output, month, 0.3 + 0.1 * rng.normal());
      for (int j = 0; j < kParameters; ++j) {
        coefficients.add(output, month, {j}, 0.15 * rng.normal());
        for (int k = 0; k <= j; ++k) coefficients.add(output, month, {k, j}, 0.02 * rng.normal());
      }
    }
  }
  return model::metamodel::QuadraticModel{coefficients};
}

const HyperPrior kPrior = make_hyper_prior(HyperPriorProfile::scaled, 0.028);

/// What the model gives in the middle of the priors, with the noise that the hyper-prior expects.
PosteriorData data() {
  Rng rng{2};
  auto truth = model();
  std::vector<double> outputs(kOutputs * kMonths);
  truth.evaluate(std::vector<double>(kParameters, 0.5), outputs);
  PosteriorData data;
  data.month_inputs.resize(kMonths, 4);
  for (double& x : data.month_inputs.reshaped()) x = rng.uniform();
  data.values.resize(kOutputs * kMonths);
  for (int i = 0; i < kOutputs * kMonths; ++i) {
    data.points.push_back({i / kMonths, i % kMonths});
    data.values(i) = outputs[static_cast<std::size_t>(i)] + 0.02 * rng.normal();
  }
  data.extra_variances.setConstant(data.values.size(), 1e-5);
  data.common_errors = Eigen::VectorXd::Constant(data.values.size(), 0.01);
  data.scales.assign(kOutputs, {0.0, 1.0});
  data.weights.assign(kOutputs, 1.0);
  return data;
}

std::vector<Parameter> parameters() {
  return std::vector<Parameter>(kParameters, Parameter{"p", "-", {0.0, 0.4, 1.0}});
}

double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double calibration_s() {
  const auto posterior = Posterior::make(model(), parameters(), data(), kPrior);
  const std::vector<std::string> names{"a", "b", "c", "d"};
  const double begin = processor_s();
  benchmark::DoNotOptimize(sample_posterior(*posterior, names, {}, {.seed = 1}));
  return processor_s() - begin;
}

void MonthlyUpdate(benchmark::State& state) {
  std::vector<double> seconds;
  for (auto _ : state) {
    drift::SequentialCalibration sequence{
        model(), parameters(), data(), kPrior, {}, {.particles = static_cast<int>(state.range(0))},
        1};
    std::vector<int> first(24);
    std::iota(first.begin(), first.end(), 0);
    (void)sequence.learn(first);
    for (int month = 24; month < kMonths; ++month) {
      const double begin = processor_s();
      benchmark::DoNotOptimize(sequence.forecast(month));
      benchmark::DoNotOptimize(sequence.take(month));
      seconds.push_back(processor_s() - begin);
    }
  }
  const double mean =
      std::accumulate(seconds.begin(), seconds.end(), 0.0) / static_cast<double>(seconds.size());
  state.counters["s_a_month"] = mean;
  state.counters["s_worst"] = std::ranges::max(seconds);
  state.counters["calibrations_a_month"] = mean / calibration_s();
}
BENCHMARK(MonthlyUpdate)->Arg(256)->Arg(2048)->Unit(benchmark::kSecond);

}  // namespace

BENCHMARK_MAIN();
