// What screening and the choice of a meta-model's terms cost beside the sums they start from.
//
// The rows are of the seed's size: 200 runs x 24 months x 2 output types, 11 variables and their 55
// products, 9 600 x 66 in all. `Gram` is X'X of these rows by Eigen, the one pass over the rows
// that cannot be avoided; the counters `ratio_to_gram` are measured in turns within one run.

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "core/model/metamodel/quadratic_model.hpp"
#include "core/random/rng.hpp"
#include "core/regression/monthly_form.hpp"
#include "core/regression/seed_form.hpp"
#include "core/regression/stepwise.hpp"
#include "core/screening/cross_validation.hpp"
#include "core/screening/screen.hpp"

namespace {

using namespace recald;

constexpr int kRuns = 200;
constexpr int kMonths = 24;
constexpr int kInputs = 5;  // four of weather and the output type
constexpr int kParameters = 6;

/// Long-form rows whose response is curved in all variables, so that most terms matter.
struct Rows {
  Eigen::MatrixXd x;
  Eigen::VectorXd y;
  std::vector<int> run;
  std::vector<regression::Parents> parents;
};

Rows make_rows() {
  Rng rng(1);
  Eigen::MatrixXd months(kMonths, 4);
  Eigen::MatrixXd theta(kRuns, kParameters);
  for (double& value : months.reshaped()) value = rng.uniform();
  for (double& value : theta.reshaped()) value = rng.uniform();
  const auto terms = regression::all_terms(kInputs + kParameters, false);
  const Eigen::Index count = 2 * kRuns * kMonths;
  Eigen::MatrixXd variables(count, kInputs + kParameters);
  Rows rows{Eigen::MatrixXd(count, static_cast<Eigen::Index>(terms.size())),
            Eigen::VectorXd(count),
            {},
            regression::parents_of(terms)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index run = i / kMonths % kRuns;
    const double type = i < count / 2 ? 0.0 : 1.0;
    variables.row(i) << months.row(i % kMonths), type, theta.row(run);
    rows.run.push_back(static_cast<int>(run));
    const auto v = variables.row(i);
    rows.y(i) = std::exp(v(0) * v(5) - v(1)) + v(2) * v(6) * (1.0 + v(4)) +
                0.3 * std::sin(3.0 * v(7) * v(3)) + 0.1 * v(8) * v(9) + 0.02 * rng.normal();
  }
  for (std::size_t j = 0; j < terms.size(); ++j) {
    auto column = rows.x.col(static_cast<Eigen::Index>(j));
    column = variables.col(terms[j].first);
    if (!terms[j].is_main_effect()) column.array() *= variables.col(terms[j].second).array();
  }
  return rows;
}

double gram(const Rows& rows) {
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(rows.x.cols(), rows.x.cols());
  product.selfadjointView<Eigen::Lower>().rankUpdate(rows.x.transpose());
  return product(0, 0);
}

double lasso(const Rows& rows) {
  Rng rng(2);
  const regression::RunFolds folds(kRuns, 10, rng);
  const auto products = screening::fold_products(rows.x, rows.y, rows.run, folds);
  return screening::cross_validate_lasso(products).value().error.sum();
}

double stepwise(const Rows& rows) {
  const auto products = regression::centre(regression::cross_products(rows.x, rows.y));
  return regression::stepwise(products, rows.parents, {}).value().criterion;
}

template <class Task>
void measure_against_gram(benchmark::State& state, Task task) {
  using Clock = std::chrono::steady_clock;
  const Rows rows = make_rows();
  std::chrono::duration<double> ours{0};
  std::chrono::duration<double> reference{0};
  for (auto _ : state) {
    const auto begin = Clock::now();
    benchmark::DoNotOptimize(task(rows));
    const auto middle = Clock::now();
    benchmark::DoNotOptimize(gram(rows));
    ours += middle - begin;
    reference += Clock::now() - middle;
  }
  state.counters["task_ms"] = 1e3 * ours.count() / static_cast<double>(state.iterations());
  state.counters["ratio_to_gram"] = ours / reference;
}

void Gram(benchmark::State& state) {
  const Rows rows = make_rows();
  for (auto _ : state) benchmark::DoNotOptimize(gram(rows));
}

void LassoCrossValidated(benchmark::State& state) { measure_against_gram(state, lasso); }
void StepwiseAic(benchmark::State& state) { measure_against_gram(state, stepwise); }

/// A design of 26 parameters, three meters with consumption and peak, two years.
regression::DesignData campus_sized_design() {
  Rng rng(3);
  regression::DesignData design;
  for (int j = 0; j < 26; ++j) design.parameters.push_back("p" + std::to_string(j));
  for (const char* meter : {"chw", "hw", "elec"}) {
    design.outputs.push_back(std::string(meter) + "_daily_kwh");
    design.outputs.push_back(std::string(meter) + "_peak_kw");
  }
  design.inputs = {"drybulb", "rh", "winddir", "windspeed", "sun"};
  design.theta.resize(kRuns, 26);
  design.month_inputs.resize(kMonths, 5);
  for (double& value : design.theta.reshaped()) value = rng.uniform();
  for (double& value : design.month_inputs.reshaped()) value = rng.uniform();
  design.month_inputs.col(2) *= 360.0;
  for (int i = 0; i < kMonths; ++i) design.months.push_back(std::to_string(i + 1));
  design.values.resize(kRuns, 6 * kMonths);
  for (Eigen::Index k = 0; k < 6; ++k) {
    for (Eigen::Index i = 0; i < kMonths; ++i) {
      for (Eigen::Index r = 0; r < kRuns; ++r) {
        const auto t = design.theta.row(r);
        const double warm = design.month_inputs(i, 0);
        design.values(r, k * kMonths + i) =
            std::exp(warm * t(k)) + t(k + 6) * t(k + 7) + warm * t.head(12).sum() + t(k) * t(k);
      }
    }
  }
  return design;
}

void ScreenCampus(benchmark::State& state) {
  const auto design = campus_sized_design();
  for (auto _ : state) {
    Rng rng(4);
    benchmark::DoNotOptimize(screening::screen(design, {}, rng));
  }
}

void SeedFormCampus(benchmark::State& state) {
  const auto design = campus_sized_design();
  for (auto _ : state) {
    Rng rng(5);
    benchmark::DoNotOptimize(regression::fit_seed_form(design, {}, rng));
  }
}

void MonthlyFormCampus(benchmark::State& state) {
  const auto design = campus_sized_design();
  for (auto _ : state) {
    benchmark::DoNotOptimize(regression::fit_monthly_form(design));
  }
}

/// One evaluation of a seed-sized meta-model: 48 outputs, 6 parameters, 27 terms.
void EvaluateMetaModel(benchmark::State& state) {
  Rng rng(7);
  model::metamodel::QuadraticCoefficients coefficients({kParameters, {0.0, 1.0}}, 2, kMonths);
  for (int k = 0; k < 2; ++k) {
    for (int i = 0; i < kMonths; ++i) {
      for (const auto& term : regression::all_terms(kParameters, true)) {
        coefficients.add(k, i, term, rng.normal());
      }
    }
  }
  model::metamodel::QuadraticModel model(coefficients);
  const std::vector<double> theta(kParameters, 0.4);
  std::vector<double> outputs(2 * kMonths);
  std::vector<double> jacobian(outputs.size() * kParameters);
  for (auto _ : state) {
    if (state.range(0) == 0) {
      model.evaluate(theta, outputs);
    } else {
      model.evaluate_with_jacobian(theta, outputs, jacobian);
    }
    benchmark::DoNotOptimize(outputs.data());
  }
}

BENCHMARK(Gram)->Unit(benchmark::kMillisecond);
BENCHMARK(LassoCrossValidated)->Unit(benchmark::kMillisecond);
BENCHMARK(StepwiseAic)->Unit(benchmark::kMillisecond);
BENCHMARK(ScreenCampus)->Unit(benchmark::kMillisecond);
BENCHMARK(SeedFormCampus)->Unit(benchmark::kMillisecond);
BENCHMARK(MonthlyFormCampus)->Unit(benchmark::kMillisecond);
BENCHMARK(EvaluateMetaModel)->ArgName("jacobian")->Arg(0)->Arg(1)->Unit(benchmark::kNanosecond);

}  // namespace

BENCHMARK_MAIN();
