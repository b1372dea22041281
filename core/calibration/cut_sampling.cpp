#include "core/calibration/cut_sampling.hpp"

#include <numeric>
#include <utility>

#include "core/calibration/posterior/emulator.hpp"
#include "core/calibration/samplers/dram.hpp"
#include "core/model/model_adaptors.hpp"
#include "core/random/streams.hpp"

namespace recald::calibration {
namespace {

/// Everything that a chain needs.
struct CutProblem {
  const MonthlyModel& model;
  const CalibrationProblem& problem;
  const PosteriorData& data;
  const HyperPrior& hyper_prior;
  const Eigen::MatrixXd& eta;
  const CutOptions& options;
};

/// The posterior of θ with η fixed at row `row`.
Result<Posterior> posterior_at(const CutProblem& cut, Eigen::Index row) {
  std::vector<int> free(cut.problem.parameters.size());
  std::iota(free.begin(), free.end(), 0);
  std::vector<double> all(free.size());
  const Eigen::RowVectorXd eta = cut.eta.row(row);
  all.insert(all.end(), eta.begin(), eta.end());
  const FixedParametersModel model{cut.model.clone(), std::move(all), std::move(free)};
  return Posterior::make(model, cut.problem.parameters, cut.data, cut.hyper_prior);
}

/// Allocates room for `kept` draws at each of `values` of η.
ChainDraws room_for(const CutProblem& cut, const ChainDraws& like) {
  const Eigen::Index rows = cut.eta.rows() * cut.options.kept_each;
  return {.theta = Eigen::MatrixXd(rows, like.theta.cols() + cut.eta.cols()),
          .discrepancy_precision = Eigen::VectorXd(rows),
          .error_precision = Eigen::VectorXd(rows),
          .beta = Eigen::MatrixXd(rows, like.beta.cols()),
          .log_density = Eigen::VectorXd(rows),
          .acceptance_rate = 0.0};
}

/// Writes the kept draws at row `d` of η into every n-th row from `d`.
void interleave(const CutProblem& cut, Eigen::Index d, const ChainDraws& part, ChainDraws& all) {
  const Eigen::Index n = cut.eta.rows();
  const Eigen::Index q = part.theta.cols();
  for (Eigen::Index s = 0; s < cut.options.kept_each; ++s) {
    const Eigen::Index row = s * n + d;
    const Eigen::Index from = cut.options.settle_each + (s + 1) * cut.options.stride - 1;
    all.theta.row(row).head(q) = part.theta.row(from);
    all.theta.row(row).tail(cut.eta.cols()) = cut.eta.row(d);
    all.discrepancy_precision[row] = part.discrepancy_precision[from];
    all.error_precision[row] = part.error_precision[from];
    all.beta.row(row) = part.beta.row(from);
    all.log_density[row] = part.log_density[from];
  }
  all.acceptance_rate += part.acceptance_rate / static_cast<double>(n);
}

Error cancelled() { return {ErrorCode::cancelled, "the calibration was cancelled"}; }

/// Runs one chain through all values of η. Calls `go_on(done)` after each, and within each as often
/// as its sampler does.
template <class GoOn>
Result<void> walk(const CutProblem& cut, Rng& rng, ChainDraws& draws, ChainStatistics& statistics,
                  GoOn go_on) {
  const int iterations = cut.options.settle_each + cut.options.kept_each * cut.options.stride;
  ChainState state;
  for (Eigen::Index d = 0; d < cut.eta.rows(); ++d) {
    const SamplerObserver observer = [&](int, int) { return go_on(static_cast<int>(d)); };
    auto posterior = TRY(posterior_at(cut, d));
    if (d == 0) {
      const int run_in = cut.options.burn_in + 1;
      auto first = TRY(dram(posterior, {run_in, cut.options.burn_in, {}}, rng, observer));
      state = first.last;
      statistics.density_evaluations += first.statistics.density_evaluations;
    }
    // No burn-in: the steps stay as learnt, and the iterations that settle are dropped here.
    auto chain = TRY(dram(posterior, {iterations, 0, std::move(state)}, rng, observer));
    state = chain.last;
    statistics.density_evaluations += chain.statistics.density_evaluations;
    const ChainDraws part = to_natural_units(chain, posterior);
    if (d == 0) draws = room_for(cut, part);
    interleave(cut, d, part, draws);
    if (!go_on(static_cast<int>(d) + 1)) return tl::unexpected(cancelled());
  }
  statistics.acceptance_rate = draws.acceptance_rate;
  return {};
}

}  // namespace

Result<CutDraws> sample_given_eta(const MonthlyModel& model,
                                  const Eigen::VectorXd& emulator_error_sd, const Calibration& base,
                                  const CalibrationProblem& problem, const Eigen::MatrixXd& eta,
                                  const CutOptions& options, const RunContext& context) {
  auto data = normalise_problem(problem, base.normalisation);
  if (emulator_error_sd.size() > 0) {
    add_emulator_error(emulator_error_sd, model.month_count(), data);
  }
  const CutProblem cut{model, problem, data, base.hyper_prior, eta, options};
  const auto count = static_cast<std::size_t>(options.chains);
  CutDraws result{std::vector<ChainDraws>(count), std::vector<ChainStatistics>(count)};
  std::vector<Result<void>> done(count);
  context.executor(count, [&](std::size_t k) {
    Rng rng{context.seed, streams::kCut[k]};
    done[k] = walk(cut, rng, result.chains[k], result.statistics[k], [&](int values) {
      return !context.observer || context.observer({Progress::Stage::sampling, static_cast<int>(k),
                                                    values, static_cast<int>(eta.rows())});
    });
  });
  for (const Result<void>& chain : done) {
    if (!chain) return tl::unexpected(chain.error());
  }
  return result;
}

}  // namespace recald::calibration
