#include "core/calibration/sampling.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/calibration/mode_jumps.hpp"
#include "core/calibration/posterior_findings.hpp"
#include "core/calibration/samplers/smc.hpp"
#include "core/random/streams.hpp"

namespace recald::calibration {
namespace {

// The pilot finds modes, starting points and a metric. With these figures it costs an eighth of the
// chains where gradients are cheap.
constexpr int kPilotParticles = 96;
constexpr ParticleMover::Options kPilotMoves{.sweeps_min = 2, .sweeps_max = 6};
// A chain that starts where the pilot ended, with its covariance, needs only a short burn-in.
// Gradients teach a metric in far fewer steps than acceptances do.
constexpr int kGradientBurnInAfterPilot = 200;
constexpr int kWalkBurnInAfterPilot = 2'000;
// Chains further apart than this are in different modes; more draws will not help.
constexpr double kHopelessRhat = 1.1;
// Jumps between modes that each particle of a population may try.
constexpr int kJumpSweeps = 60;
constexpr int kPointsMax = 2'000;  // kept for bridge sampling of the evidence

// The pilot has found a mode that the chains missed if this share of its particles is further out
// than any draw of the chains, and has as high a density.
constexpr double kMissedShare = 0.03;

/// One chain with everything needed to continue it.
struct Worker {
  Posterior posterior;
  Rng rng;
  Chain chain;
};

/// The chains of one sampler, run and extended in parallel.
class Chains {
 public:
  Chains(const Posterior& prototype, const Sampler& sampler, int count, const streams::Block& block,
         const RunContext& context)
      : sampler_(sampler), context_(context) {
    workers_.reserve(static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k) {
      workers_.push_back(
          {Posterior(prototype), Rng(context.seed, block[static_cast<std::uint64_t>(k)]), {}});
    }
  }

  /// Lets populations jump between modes before they are returned.
  void let_jump() { jumps_ = true; }

  /// @param begin_at  One state per chain, or none.
  Result<void> run(SamplerOptions options, const std::vector<ChainState>& begin_at) {
    return for_each([&](Worker& worker, int k) -> Result<void> {
      SamplerOptions own = options;
      if (!begin_at.empty()) own.begin_at = begin_at[static_cast<std::size_t>(k)];
      worker.chain = TRY(sample(worker, own, k));
      return {};
    });
  }

  /// Adds as many draws as there are.
  Result<void> double_draws() {
    return for_each([&](Worker& worker, int k) -> Result<void> {
      const auto kept = static_cast<int>(worker.chain.draws.rows());
      auto more =
          TRY(sample(worker, {.iterations = kept, .burn_in = 0, .begin_at = worker.chain.last}, k));
      append(worker.chain, more);
      return {};
    });
  }

  [[nodiscard]] const std::vector<Worker>& workers() const { return workers_; }

  [[nodiscard]] std::vector<ChainDraws> natural_draws() const {
    std::vector<ChainDraws> draws;
    for (const Worker& worker : workers_) {
      draws.push_back(to_natural_units(worker.chain, worker.posterior));
    }
    return draws;
  }

  void count(SampledPosterior& result) const {
    SamplingReport& report = result.report;
    report.chains.clear();
    for (const Worker& worker : workers_) {
      report.chains.push_back(worker.chain.statistics);
      report.density_evaluations += worker.chain.statistics.density_evaluations;
      report.gradient_evaluations += worker.chain.statistics.gradient_evaluations;
    }
  }

  [[nodiscard]] long jitter_count() const {
    long sum = 0;
    for (const Worker& worker : workers_) sum += worker.posterior.jitter_count();
    return sum;
  }

 private:
  static void append(Chain& chain, const Chain& more) {
    const Eigen::Index n = chain.draws.rows();
    const Eigen::Index added = more.draws.rows();
    chain.draws.conservativeResize(n + added, Eigen::NoChange);
    chain.draws.bottomRows(added) = more.draws;
    chain.log_density.conservativeResize(n + added);
    chain.log_density.tail(added) = more.log_density;
    chain.last = more.last;
    const double share = static_cast<double>(added) / static_cast<double>(n + added);
    ChainStatistics& s = chain.statistics;
    const ChainStatistics& m = more.statistics;
    s.acceptance_rate += share * (m.acceptance_rate - s.acceptance_rate);
    s.e_bfmi += share * (m.e_bfmi - s.e_bfmi);
    s.divergences += m.divergences;
    s.depth_limit_hits += m.depth_limit_hits;
    s.density_evaluations += m.density_evaluations;
    s.gradient_evaluations += m.gradient_evaluations;
  }

  Result<Chain> sample(Worker& worker, const SamplerOptions& options, int k) const {
    const SamplerObserver observer = [this, k](int done, int total) {
      return !context_.observer || context_.observer({Progress::Stage::sampling, k, done, total});
    };
    auto chain = sampler_.run(worker.posterior, options, worker.rng, observer);
    if (!chain || !jumps_) return chain;
    TRY(jump_between_modes(worker.posterior, *chain, worker.rng, kJumpSweeps, observer));
    return chain;
  }

  template <class Body>
  Result<void> for_each(Body body) {
    std::vector<Result<void>> results(workers_.size());
    context_.executor(workers_.size(),
                      [&](std::size_t k) { results[k] = body(workers_[k], static_cast<int>(k)); });
    for (auto& result : results) {
      if (!result) return result;
    }
    return {};
  }

  const Sampler& sampler_;
  const RunContext& context_;
  std::vector<Worker> workers_;
  bool jumps_ = false;
};

struct LogMean {
  double value;
  double standard_error;
};

/// log of the mean of exp(values), where each value is the log evidence of one population.
LogMean log_mean(const std::vector<Worker>& populations) {
  const auto n = static_cast<double>(populations.size());
  double largest = -std::numeric_limits<double>::infinity();
  for (const Worker& p : populations) largest = std::max(largest, p.chain.statistics.log_evidence);
  double sum = 0.0;
  double squares = 0.0;
  for (const Worker& p : populations) {
    const double ratio = std::exp(p.chain.statistics.log_evidence - largest);
    sum += ratio;
    squares += ratio * ratio;
  }
  const double mean = sum / n;
  const double variance = (squares / n - mean * mean) * n / (n - 1.0);
  return {largest + std::log(mean), std::sqrt(std::max(variance, 0.0) / n) / mean};
}

/// Draws of all workers, one below the other.
Eigen::MatrixXd pooled_draws(const std::vector<Worker>& workers) {
  const Eigen::Index n = workers.front().chain.draws.rows();
  Eigen::MatrixXd all(n * static_cast<Eigen::Index>(workers.size()),
                      workers.front().chain.draws.cols());
  for (std::size_t k = 0; k < workers.size(); ++k) {
    all.middleRows(static_cast<Eigen::Index>(k) * n, n) = workers[k].chain.draws;
  }
  return all;
}

Eigen::VectorXd pooled_densities(const std::vector<Worker>& workers) {
  const Eigen::Index n = workers.front().chain.log_density.size();
  Eigen::VectorXd all(n * static_cast<Eigen::Index>(workers.size()));
  for (std::size_t k = 0; k < workers.size(); ++k) {
    all.segment(static_cast<Eigen::Index>(k) * n, n) = workers[k].chain.log_density;
  }
  return all;
}

Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& draws) {
  const Eigen::MatrixXd centred = draws.rowwise() - draws.colwise().mean();
  return centred.transpose() * centred / static_cast<double>(draws.rows() - 1);
}

Eigen::MatrixXd thinned_points(const std::vector<Worker>& workers) {
  const Eigen::MatrixXd all = pooled_draws(workers);
  const std::vector<int> rows = equally_spaced(static_cast<int>(all.rows()), kPointsMax);
  return all(rows, Eigen::all);
}

/// The whole of `sample_posterior`, step by step.
class Sampling {
 public:
  Sampling(const Posterior& posterior, const std::vector<std::string>& input_names,
           const SamplingOptions& options, const RunContext& context)
      : posterior_(posterior),
        names_(hyperparameter_names(input_names, posterior.has_output_dimension())),
        options_(options),
        context_(context) {}

  Result<SampledPosterior> run() {
    if (options_.sampler != nullptr) return run_named(*options_.sampler);
    return run_by_itself();
  }

 private:
  Result<SampledPosterior> run_named(const Sampler& sampler) {
    TRY(sampler.is_population ? run_populations(sampler) : run_chains(sampler, nullptr));
    return std::move(result_);
  }

  Result<SampledPosterior> run_by_itself() {
    const Sampler& chains = *find_sampler(posterior_.has_gradient() ? "nuts" : "dram").value();
    const Sampler& populations = *find_sampler("smc").value();
    const Sampler quick{
        "pilot",
        false,
        true,
        {},
        [](Target& target, const SamplerOptions& own, Rng& rng, const SamplerObserver& observer) {
          return smc(target, own, rng, observer, kPilotMoves);
        }};
    Chains pilot(posterior_, quick, options_.chains, streams::kPilots, context_);
    TRY(pilot.run({.iterations = kPilotParticles, .burn_in = 0}, {}));
    pilot.count(result_);
    TRY(run_chains(chains, &pilot));
    if (result_.converged && disagreement_.empty()) return std::move(result_);
    if (options_.iterations) {
      if (!disagreement_.empty()) {
        result_.converged = false;
        result_.findings.push_back({FindingKind::not_converged, std::string(chains.name),
                                    "The chains miss part of the posterior.",
                                    "That is because " + disagreement_ + ".", 1.0});
      }
      return std::move(result_);
    }
    const bool apart = !disagreement_.empty() || worst_rhat() > options_.gate.rhat_max;
    std::string why(chains.name);
    why += " was abandoned: ";
    why += !disagreement_.empty() ? disagreement_
           : apart                ? "its chains disagreed"
                                  : "it had too few effective draws or failed trajectories";
    TRY(run_populations(populations));
    result_.report.taken_over = why;
    result_.findings.push_back({FindingKind::sampler_replaced, result_.report.sampler,
                                "Tempered populations (smc) replaced the chains.",
                                "That is because " + why +
                                    (apart ? ". The data may allow more than one region of the "
                                             "parameters; the draws weight these regions."
                                           : ".")});
    return std::move(result_);
  }

  Result<void> run_chains(const Sampler& sampler, const Chains* pilot) {
    SamplerOptions own = sampler.defaults;
    if (pilot != nullptr && !options_.burn_in) {
      const int enough = sampler.uses_gradient ? kGradientBurnInAfterPilot : kWalkBurnInAfterPilot;
      const int saved = std::max(0, own.burn_in - enough);
      own.burn_in -= saved;
      own.iterations -= saved;
    }
    if (options_.burn_in) own.burn_in = *options_.burn_in;
    if (options_.iterations) own.iterations = *options_.iterations;
    if (auto valid = check_options(own); !valid) return valid;
    Chains chains(posterior_, sampler, options_.chains, streams::kChains, context_);
    if (auto ran = chains.run(own, pilot == nullptr ? std::vector<ChainState>{} : starts(*pilot));
        !ran) {
      return ran;
    }
    result_.report.burn_in = own.burn_in;
    evaluate(sampler, chains, 0);
    for (int doubling = 1; doubling <= doublings_max() && !result_.converged; ++doubling) {
      if (options_.sampler == nullptr && worst_rhat() > kHopelessRhat) break;
      if (auto ran = chains.double_draws(); !ran) return ran;
      evaluate(sampler, chains, doubling);
    }
    chains.count(result_);
    if (pilot != nullptr) disagreement_ = compare(*pilot, chains);
    return {};
  }

  Result<void> run_populations(const Sampler& sampler) {
    SamplerOptions own = sampler.defaults;
    if (options_.iterations && options_.sampler != nullptr) own.iterations = *options_.iterations;
    own.burn_in = 0;
    for (int doubling = 0;; ++doubling, own.iterations *= 2) {
      Chains populations(posterior_, sampler, options_.chains, streams::populations_of(doubling),
                         context_);
      populations.let_jump();
      if (auto ran = populations.run(own, {}); !ran) return ran;
      result_.report.burn_in = 0;
      evaluate(sampler, populations, doubling);
      populations.count(result_);
      note_evidence(populations);
      if (result_.converged || doubling == doublings_max()) return {};
    }
  }

  /// Computes summaries and checks the gate for the chains' current draws.
  void evaluate(const Sampler& sampler, const Chains& chains, int doublings) {
    result_.chains = chains.natural_draws();
    result_.parameters =
        summarise_parameters(posterior_.parameters(), result_.chains, context_.executor);
    result_.hyperparameters =
        summarise_hyperparameters(posterior_.prior(), names_, result_.chains, context_.executor);
    result_.report.sampler = sampler.name;
    result_.report.kept = static_cast<int>(result_.chains.front().log_density.size());
    result_.report.doublings = doublings;
    result_.findings = gate_findings(result_.parameters, options_.gate);
    append(result_.findings, gate_findings(result_.hyperparameters, options_.gate));
    std::vector<ChainStatistics> statistics;
    for (const Worker& worker : chains.workers()) statistics.push_back(worker.chain.statistics);
    append(result_.findings, trajectory_findings(statistics, options_.gate));
    result_.converged = result_.findings.empty();
    append(result_.findings, jitter_findings(chains.jitter_count()));
    result_.points = thinned_points(chains.workers());
  }

  [[nodiscard]] int doublings_max() const {
    return options_.iterations ? 0 : options_.doublings_max;
  }

  [[nodiscard]] double worst_rhat() const {
    double worst = 0.0;
    for (const auto* list : {&result_.parameters, &result_.hyperparameters}) {
      for (const Summary& s : *list) worst = std::max(worst, s.rhat);
    }
    return worst;
  }

  void note_evidence(const Chains& populations) {
    const LogMean evidence = log_mean(populations.workers());
    result_.report.log_evidence = evidence.value;
    result_.report.log_evidence_se = evidence.standard_error;
  }

  /// Each chain starts at a particle of its own pilot, with the covariance of all pilots.
  [[nodiscard]] std::vector<ChainState> starts(const Chains& pilot) const {
    const Eigen::MatrixXd covariance = covariance_of(pooled_draws(pilot.workers()));
    const auto d = static_cast<double>(covariance.rows());
    std::vector<ChainState> states;
    for (const Worker& worker : pilot.workers()) {
      Rng rng = worker.rng;
      const auto n = static_cast<std::uint64_t>(worker.chain.draws.rows());
      const auto row = static_cast<Eigen::Index>(rng.below(n));
      states.push_back({worker.chain.draws.row(row).transpose(), 1.0 / std::sqrt(d), covariance});
    }
    return states;
  }

  /// Chains that all missed a mode agree with each other but not with the pilot, which started from
  /// the prior and found it. Uses Mahalanobis distances from the chains' own mean; the pilot's
  /// means are too rough, because a small, quick population is off by half a deviation.
  /// @return the disagreement in words; empty: none.
  [[nodiscard]] std::string compare(const Chains& pilot, const Chains& chains) const {
    const Eigen::MatrixXd draws = pooled_draws(chains.workers());
    const Eigen::MatrixXd particles = pooled_draws(pilot.workers());
    const Eigen::RowVectorXd mean = draws.colwise().mean();
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance_of(draws));
    const auto squared_distances = [&](const Eigen::MatrixXd& points) -> Eigen::VectorXd {
      const Eigen::MatrixXd centred = (points.rowwise() - mean).transpose();
      return factor.matrixL().solve(centred).colwise().squaredNorm().transpose();
    };
    const double furthest = squared_distances(draws).maxCoeff();
    double lowest = std::numeric_limits<double>::infinity();
    for (const Worker& worker : chains.workers()) {
      lowest = std::min(lowest, worker.chain.log_density.minCoeff());
    }
    const Eigen::VectorXd densities = pooled_densities(pilot.workers());
    const Eigen::VectorXd distances = squared_distances(particles);
    Eigen::RowVectorXd outside = Eigen::RowVectorXd::Zero(mean.size());
    int count = 0;
    for (Eigen::Index i = 0; i < distances.size(); ++i) {
      // A particle that the pilot did not move far enough is also outside, but has a low density.
      if (distances(i) <= furthest || densities(i) < lowest) continue;
      outside += particles.row(i) - mean;
      ++count;
    }
    if (count <= kMissedShare * static_cast<double>(distances.size())) return {};
    const Eigen::RowVectorXd sd = covariance_of(draws).diagonal().cwiseSqrt().transpose();
    Eigen::Index where = 0;
    (outside.array() / sd.array()).abs().maxCoeff(&where);
    const auto q = static_cast<Eigen::Index>(posterior_.parameter_count());
    const std::string& name = where < q ? result_.parameters[static_cast<std::size_t>(where)].name
                                        : names_[static_cast<std::size_t>(where - q)];
    return "its chains agree, but a tempered pilot found another mode, which differs from theirs "
           "in " +
           name;
  }

  const Posterior& posterior_;
  std::vector<std::string> names_;
  const SamplingOptions& options_;
  const RunContext& context_;
  SampledPosterior result_;
  std::string disagreement_;
};

}  // namespace

Result<void> check_sampling(const SamplingOptions& options) {
  if (options.chains < 2) {
    return failure(ErrorCode::invalid_value,
                   "a calibration needs at least 2 chains to check whether they agree, but " +
                       std::to_string(options.chains) + " was requested");
  }
  const Sampler* sampler = options.sampler;
  const bool is_population = sampler != nullptr && sampler->is_population;
  if (is_population && options.burn_in) {
    return failure(ErrorCode::invalid_value,
                   std::string(sampler->name) + " has no burn-in; leave it out");
  }
  if (is_population || (!options.iterations && !options.burn_in)) return {};
  SamplerOptions own =
      sampler != nullptr ? sampler->defaults : find_sampler("nuts").value()->defaults;
  if (options.burn_in) own.burn_in = *options.burn_in;
  if (options.iterations) own.iterations = *options.iterations;
  if (auto valid = check_options(own); !valid) return valid;
  if (own.iterations - own.burn_in < 8) {
    return failure(ErrorCode::invalid_value,
                   "at least 8 iterations must remain after burn-in to check convergence");
  }
  return {};
}

Result<SampledPosterior> sample_posterior(const Posterior& posterior,
                                          const std::vector<std::string>& input_names,
                                          const SamplingOptions& options,
                                          const RunContext& context) {
  TRY(check_sampling(options));
  if (options.sampler != nullptr && options.sampler->uses_gradient && !posterior.has_gradient()) {
    return failure(ErrorCode::unsupported,
                   std::string(options.sampler->name) +
                       " needs the model's derivatives, which this model does not have; choose "
                       "dram, smc or seed_rwm, or let recald choose");
  }
  return Sampling(posterior, input_names, options, context).run();
}

}  // namespace recald::calibration
