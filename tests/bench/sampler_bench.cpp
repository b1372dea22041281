// What samplers cost beside the density: on targets that are nearly free, all the time is theirs.
//
// `Overhead` divides the time of whole runs by the evaluations in them (of nuts: leapfrog steps),
// `SmcMove` by the moves of particles; `TargetAlone` is what one evaluation of the same density
// costs by itself. `effective_per_1000` is the smallest bulk ESS of four chains per thousand
// evaluations, burn-in counted, on a correlated normal density in 13 dimensions and on one with a
// bend.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "core/calibration/posterior/diagnostics.hpp"
#include "core/calibration/samplers/particles.hpp"
#include "core/calibration/samplers/samplers.hpp"
#include "tests/core/calibration/sampling_targets.hpp"

namespace {

using namespace recald;
using namespace recald::calibration;

constexpr Eigen::Index kDimension = 13;

/// Standard normal: a dozen operations.
class UnitNormal final : public NormalPriorTarget {
 public:
  UnitNormal() : NormalPriorTarget(kDimension, 2.0) {}
  [[nodiscard]] bool has_gradient() const override { return true; }
  [[nodiscard]] Result<double> log_density(const Eigen::VectorXd& x) override {
    return -0.5 * x.squaredNorm();
  }
  [[nodiscard]] Result<double> log_density_and_gradient(const Eigen::VectorXd& x,
                                                        Eigen::VectorXd& gradient) override {
    gradient = -x;
    return -0.5 * x.squaredNorm();
  }
};

long evaluations(const ChainStatistics& statistics) {
  return statistics.density_evaluations + statistics.gradient_evaluations;
}

void TargetAlone(benchmark::State& state) {
  UnitNormal target;
  Rng rng(1);
  const Eigen::VectorXd point = target.draw_start(rng);
  Eigen::VectorXd gradient(kDimension);
  for (auto _ : state) {
    benchmark::DoNotOptimize(target.log_density_and_gradient(point, gradient));
  }
}

/// Seconds of the sampler per evaluation of the density.
void Overhead(benchmark::State& state, std::string_view name) {
  const Sampler& sampler = *find_sampler(name).value();
  UnitNormal target;
  Rng rng(2);
  double evaluated = 0.0;
  for (auto _ : state) {
    const Chain chain = sampler.run(target, sampler.defaults, rng, {}).value();
    evaluated += static_cast<double>(evaluations(chain.statistics));
  }
  state.counters["s_per_evaluation"] =
      benchmark::Counter(evaluated, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void SmcMove(benchmark::State& state) {
  UnitNormal target;
  Rng rng(3);
  Particles particles = draw_particles(target, 2'048, rng).value();
  ParticleMover mover(target, rng, particles.count(), {});
  if (!mover.set_shape(covariance(particles))) return state.SkipWithError("no shape");
  for (auto _ : state) benchmark::DoNotOptimize(mover.sweep(particles, 1.0));
  state.counters["s_per_move"] =
      benchmark::Counter(static_cast<double>(mover.evaluations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Smallest bulk ESS over all coordinates of four chains, per thousand evaluations.
void Effective(benchmark::State& state, std::string_view name, bool bent) {
  const Sampler& sampler = *find_sampler(name).value();
  SkewNormal normal(kDimension);
  Banana banana(kDimension);
  Target& target = bent ? static_cast<Target&>(banana) : normal;
  double smallest_sum = 0.0;
  double evaluated = 0.0;
  std::uint64_t seed = 4;
  for (auto _ : state) {
    std::vector<Chain> chains;
    for (std::uint64_t k = 0; k < 4; ++k) {
      Rng rng(seed, k);
      chains.push_back(sampler.run(target, sampler.defaults, rng, {}).value());
      evaluated += static_cast<double>(evaluations(chains.back().statistics));
    }
    ++seed;
    double smallest = std::numeric_limits<double>::infinity();
    for (Eigen::Index j = 0; j < kDimension; ++j) {
      Eigen::MatrixXd draws(chains.front().draws.rows(), 4);
      for (std::size_t k = 0; k < 4; ++k) {
        draws.col(static_cast<Eigen::Index>(k)) = chains[k].draws.col(j);
      }
      smallest = std::min(smallest, diagnose(draws).ess_bulk);
    }
    smallest_sum += smallest;
  }
  state.counters["effective_per_1000"] = 1000.0 * smallest_sum / evaluated;
}

BENCHMARK(TargetAlone);
BENCHMARK_CAPTURE(Overhead, nuts, "nuts")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Overhead, dram, "dram")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Overhead, seed_rwm, "seed_rwm")->Unit(benchmark::kMillisecond);
BENCHMARK(SmcMove)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Effective, nuts_normal, "nuts", false)
    ->Iterations(5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Effective, nuts_banana, "nuts", true)
    ->Iterations(5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Effective, dram_normal, "dram", false)
    ->Iterations(2)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Effective, dram_banana, "dram", true)
    ->Iterations(2)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Effective, smc_normal, "smc", false)
    ->Iterations(2)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Effective, smc_banana, "smc", true)->Iterations(2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Effective, seed_rwm_normal, "seed_rwm", false)
    ->Iterations(2)
    ->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
