// What a calibration costs beside the arithmetic it cannot avoid.
//
// `RandomWalk` is 30 000 iterations as shipped at m = 48 points. `Bare` is 30 000 times the same
// assembly of the 48 x 48 covariance over pairs of points, its Cholesky factor by Eigen, a
// triangular solve and one evaluation of the model, written out without any of core. The counter
// `ratio_to_bare` of `RandomWalkAgainstBare` is their quotient, measured in turns within one run;
// 1.5 is the limit the project set itself, and below 1 means that outputs that decouple pay for the
// rest.
//
// `DefaultSampler` samples the seedcase's `scaled` posterior with everything the default does,
// pilot and burn-in included, on one thread. `ess_per_cpu_s` is the smallest bulk ESS of its
// thirteen quantities over processor time; `ess_per_cholesky` the same in units of one 48 x 48
// Cholesky factorisation by Eigen, timed in the same run, so that it travels between machines. It
// reads tests/data.
//
// `Density`, `Gradient` and `ThetaOnly` take m as their argument: two outputs of m / 2 months each,
// decoupled, or in the general case (one known extra variance) a dense covariance.

#include <benchmark/benchmark.h>

#include <Eigen/Cholesky>
#include <chrono>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/calibration/posterior/diagnostics.hpp"
#include "core/calibration/posterior/posterior.hpp"
#include "core/calibration/samplers/seed_rwm.hpp"
#include "core/calibration/sampling.hpp"
#include "tests/core/calibration/seedcase.hpp"

namespace {

using namespace recald;
using namespace recald::calibration;

constexpr int kMonths = 24;
constexpr int kOutputs = 2;
constexpr int kParameters = 6;
constexpr int kInputs = 4;
constexpr int kIterations = 30'000;

/// Bilinear in theta as the seed's meta-model is, one row an output and month.
class BilinearModel final : public MonthlyModel {
 public:
  explicit BilinearModel(int months = kMonths)
      : months_(months),
        rows_(kOutputs * months, 1 + kParameters + kParameters * (kParameters - 1) / 2) {
    Rng rng(1);
    for (double& value : rows_.reshaped()) value = 0.1 * rng.normal();
    terms_.resize(rows_.cols());
  }
  [[nodiscard]] std::unique_ptr<MonthlyModel> clone() const override {
    return std::make_unique<BilinearModel>(*this);
  }
  [[nodiscard]] int parameter_count() const override { return kParameters; }
  [[nodiscard]] int output_count() const override { return kOutputs; }
  [[nodiscard]] int month_count() const override { return months_; }
  void evaluate(std::span<const double> theta, std::span<double> outputs) override {
    Eigen::Index term = 0;
    terms_(term++) = 1.0;
    for (std::size_t j = 0; j < kParameters; ++j) {
      terms_(term++) = theta[j];
      for (std::size_t k = 0; k < j; ++k) terms_(term++) = theta[j] * theta[k];
    }
    Eigen::Map<Eigen::VectorXd>(outputs.data(), rows_.rows()).noalias() = rows_ * terms_;
  }

  [[nodiscard]] bool has_jacobian() const override { return true; }
  void evaluate_with_jacobian(std::span<const double> theta, std::span<double> outputs,
                              std::span<double> jacobian) override {
    evaluate(theta, outputs);
    Eigen::Map<Eigen::MatrixXd> by_theta(jacobian.data(), rows_.rows(), kParameters);
    Eigen::Index term = 1;
    for (std::size_t j = 0; j < kParameters; ++j) {
      by_theta.col(static_cast<Eigen::Index>(j)) = rows_.col(term++);
      for (std::size_t k = 0; k < j; ++k, ++term) {
        by_theta.col(static_cast<Eigen::Index>(j)) += theta[k] * rows_.col(term);
        by_theta.col(static_cast<Eigen::Index>(k)) += theta[j] * rows_.col(term);
      }
    }
  }

 private:
  int months_;
  Eigen::MatrixXd rows_;
  Eigen::VectorXd terms_;
};

PosteriorData bench_data(int months) {
  Rng rng(2);
  PosteriorData data;
  data.month_inputs.resize(months, kInputs);
  for (double& x : data.month_inputs.reshaped()) x = rng.uniform();
  for (int k = 0; k < kOutputs; ++k) {
    for (int i = 0; i < months; ++i) data.points.push_back({k, i});
  }
  data.values.resize(kOutputs * months);
  for (double& y : data.values) y = rng.uniform();
  data.extra_variances.setZero(data.values.size());
  data.common_errors.resize(data.values.size(), 0);
  data.scales.assign(kOutputs, {0.0, 1.0});
  data.weights.assign(kOutputs, 1.0);
  return data;
}

std::vector<Parameter> bench_parameters() {
  return {kParameters, Parameter{"p", "-", {0.0, 0.4, 1.0}}};
}

Posterior bench_posterior(int months = kMonths, bool general = false) {
  PosteriorData data = bench_data(months);
  if (general) data.extra_variances(0) = 1e-4;
  return Posterior::make(BilinearModel(months), bench_parameters(), data,
                         make_hyper_prior(HyperPriorProfile::scaled, 0.028))
      .value();
}

double random_walk() {
  Posterior posterior = bench_posterior();
  Rng rng(3);
  return seed_rwm(posterior, {kIterations, kIterations / 10}, rng).value().log_density.sum();
}

/// One iteration's unavoidable arithmetic, the plain way: every pair of points has its exp().
class BareLikelihood {
 public:
  BareLikelihood() : data_(bench_data(kMonths)), m_(data_.values.size()), outputs_(m_) {
    for (Eigen::Index j = 0; j < m_; ++j) {
      for (Eigen::Index i = j + 1; i < m_; ++i) {
        const auto& a = data_.points[static_cast<std::size_t>(i)];
        const auto& b = data_.points[static_cast<std::size_t>(j)];
        distances_.conservativeResize(kInputs + 1, distances_.cols() + 1);
        distances_.rightCols<1>().head(kInputs) =
            (data_.month_inputs.row(a.month) - data_.month_inputs.row(b.month)).array().square();
        distances_(kInputs, distances_.cols() - 1) = a.output == b.output ? 0.0 : 1.0;
      }
    }
    distances_.transposeInPlace();
  }

  double operator()(std::span<const double> theta, double variance, double noise,
                    const Eigen::VectorXd& beta) {
    packed_.noalias() = distances_ * beta;
    packed_ = variance * (-packed_.array()).exp();
    sigma_.resize(m_, m_);
    const double* next = packed_.data();
    for (Eigen::Index j = 0; j < m_; ++j) {
      sigma_(j, j) = variance + noise;
      for (Eigen::Index i = j + 1; i < m_; ++i) sigma_(i, j) = *next++;
    }
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(sigma_);
    model_.evaluate(theta, {outputs_.data(), static_cast<std::size_t>(m_)});
    residual_ = data_.values - outputs_;
    factor.matrixL().solveInPlace(residual_);
    return -0.5 * residual_.squaredNorm() - sigma_.diagonal().array().log().sum();
  }

 private:
  PosteriorData data_;
  Eigen::Index m_;
  BilinearModel model_;
  Eigen::MatrixXd distances_;
  Eigen::VectorXd packed_;
  Eigen::MatrixXd sigma_;
  Eigen::VectorXd outputs_;
  Eigen::VectorXd residual_;
};

double bare() {
  BareLikelihood likelihood;
  std::vector<double> theta(kParameters, 0.4);
  Eigen::VectorXd beta = Eigen::VectorXd::Constant(kInputs + 1, 0.5);
  double sum = 0.0;
  for (int i = 0; i < kIterations; ++i) {
    const double wobble = 1e-3 * (i % 7);
    theta[0] = 0.4 + wobble;
    beta(0) = 0.5 + wobble;
    sum += likelihood(theta, 0.01 + wobble, 0.001 + wobble, beta);
  }
  return sum;
}

void RandomWalk(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(random_walk());
  state.SetItemsProcessed(state.iterations() * kIterations);
}

void Bare(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(bare());
  state.SetItemsProcessed(state.iterations() * kIterations);
}

void RandomWalkAgainstBare(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  std::chrono::duration<double> walk{0};
  std::chrono::duration<double> plain{0};
  for (auto _ : state) {
    const auto begin = Clock::now();
    benchmark::DoNotOptimize(random_walk());
    const auto middle = Clock::now();
    benchmark::DoNotOptimize(bare());
    walk += middle - begin;
    plain += Clock::now() - middle;
  }
  state.counters["ratio_to_bare"] = walk / plain;
}

Posterior posterior_of(const benchmark::State& state) {
  return bench_posterior(static_cast<int>(state.range(0)) / kOutputs, state.range(1) != 0);
}

/// Everything moves: assembly, factorisation, model, solve.
void Density(benchmark::State& state) {
  Posterior posterior = posterior_of(state);
  Rng rng(4);
  Eigen::VectorXd point = posterior.draw_start(rng);
  for (auto _ : state) {
    point(7) += 1e-9;
    benchmark::DoNotOptimize(posterior.log_density(point));
  }
}

void Gradient(benchmark::State& state) {
  Posterior posterior = posterior_of(state);
  Rng rng(4);
  Eigen::VectorXd point = posterior.draw_start(rng);
  Eigen::VectorXd gradient(point.size());
  for (auto _ : state) {
    point(7) += 1e-9;
    benchmark::DoNotOptimize(posterior.log_density_and_gradient(point, gradient));
  }
}

/// A change of theta alone: the model and one triangular solve.
void ThetaOnly(benchmark::State& state) {
  Posterior posterior = posterior_of(state);
  Rng rng(4);
  Eigen::VectorXd point = posterior.draw_start(rng);
  for (auto _ : state) {
    point(0) += 1e-9;
    benchmark::DoNotOptimize(posterior.log_density(point));
  }
}

double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Processor seconds of one 48 x 48 Cholesky factorisation by Eigen.
double cholesky_s() {
  constexpr int m = kOutputs * kMonths;
  constexpr int repeats = 20'000;
  const Eigen::MatrixXd root = Eigen::MatrixXd::Random(m, m);
  const Eigen::MatrixXd matrix = root * root.transpose() + Eigen::MatrixXd::Identity(m, m);
  Eigen::MatrixXd factor = matrix;
  const double begin = processor_s();
  for (int i = 0; i < repeats; ++i) {
    factor = matrix;
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(factor);
    benchmark::DoNotOptimize(in_place.info());
  }
  return (processor_s() - begin) / repeats;
}

double smallest_ess(const SampledPosterior& sampled) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto* list : {&sampled.parameters, &sampled.hyperparameters}) {
    for (const Summary& s : *list) least = std::min(least, s.ess_bulk);
  }
  return least;
}

void DefaultSampler(benchmark::State& state) {
  const Seedcase seedcase = read_seedcase();
  const HyperPrior prior{"scaled", {10.0, 0.0084}, {10.0, 0.00084}, {1.0, 0.3}};
  const Posterior posterior =
      Posterior::make(*seedcase.model, seedcase.parameters, seedcase.data, prior).value();
  const std::vector<std::string> names{"drybulb", "rh", "winddir", "windspeed"};
  double ess = 0.0;
  double seconds = 0.0;
  double gradients = 0.0;
  std::uint64_t seed = 0;
  for (auto _ : state) {
    const double begin = processor_s();
    const auto sampled = sample_posterior(posterior, names, {}, {.seed = ++seed});
    seconds += processor_s() - begin;
    ess += smallest_ess(sampled.value());
    gradients += static_cast<double>(sampled->report.gradient_evaluations);
  }
  state.counters["ess_per_cpu_s"] = ess / seconds;
  state.counters["ess_per_gradient"] = ess / gradients;
  state.counters["ess_per_cholesky"] = ess / seconds * cholesky_s();
}

/// R-hat, ESS and MCSE of one quantity of 4 chains of 27 000 draws.
void DiagnoseOneQuantity(benchmark::State& state) {
  Rng rng(5);
  Eigen::MatrixXd draws(27'000, 4);
  for (double& x : draws.reshaped()) x = rng.normal();
  for (auto _ : state) benchmark::DoNotOptimize(diagnose(draws));
}

BENCHMARK(RandomWalk)->Unit(benchmark::kMillisecond);
BENCHMARK(Bare)->Unit(benchmark::kMillisecond);
BENCHMARK(RandomWalkAgainstBare)->Unit(benchmark::kMillisecond);
BENCHMARK(DefaultSampler)->Unit(benchmark::kMillisecond)->Iterations(10);
BENCHMARK(Density)
    ->ArgsProduct({{48, 96, 240, 480}, {0, 1}})
    ->ArgNames({"m", "general"})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(Gradient)
    ->ArgsProduct({{48, 96, 240, 480}, {0, 1}})
    ->ArgNames({"m", "general"})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(ThetaOnly)
    ->ArgsProduct({{48, 96, 240, 480}, {0, 1}})
    ->ArgNames({"m", "general"})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(DiagnoseOneQuantity)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
