#include "core/calibration/posterior_findings.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/display/id_words.hpp"
#include "core/text/number_text.hpp"

namespace recald::calibration {
namespace {

constexpr double kEdgeWidth = 0.05;  // of the prior's range
constexpr double kEdgeMass = 0.20;
constexpr double kEvidenceTolerance = 0.5;  // nats

Finding edge_finding(const Parameter& parameter, double share, const char* end) {
  std::string sentence = display::capitalised(display::parameter_words(parameter.name));
  sentence += ": " + percent_text(share) + " of the posterior lies at the " + end;
  sentence += " end of its prior.";
  return {FindingKind::prior_edge, parameter.name, std::move(sentence),
          "Unless that end is a physical limit, the model or a fixed input is wrong, or the prior "
          "is too narrow."};
}

}  // namespace

Findings edge_findings(const std::vector<Parameter>& parameters,
                       const std::vector<ChainDraws>& chains) {
  Findings findings;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const Prior& prior = parameters[j].prior;
    // An unbounded tail has no bound to pile up at; its length counts without its last thousandth.
    const double width = kEdgeWidth * (std::min(prior.max(), prior.quantile(0.999)) -
                                       std::max(prior.min(), prior.quantile(0.001)));
    double low = 0.0;
    double high = 0.0;
    double total = 0.0;
    for (const ChainDraws& chain : chains) {
      const auto values = chain.theta.col(static_cast<Eigen::Index>(j)).array();
      low += static_cast<double>((values < prior.min() + width).count());
      high += static_cast<double>((values > prior.max() - width).count());
      total += static_cast<double>(values.size());
    }
    if (low / total > kEdgeMass) {
      findings.push_back(edge_finding(parameters[j], low / total, "lower"));
    }
    if (high / total > kEdgeMass) {
      findings.push_back(edge_finding(parameters[j], high / total, "upper"));
    }
  }
  return findings;
}

Findings conflict_findings(const Summary& precision, const GammaPrior& prior) {
  const double low = prior.quantile(0.01);
  const double high = prior.quantile(0.99);
  if (low <= precision.mean && precision.mean <= high) return {};
  const auto sd = [](double value) { return number_text(1.0 / std::sqrt(value), 2); };
  return {{FindingKind::hyperprior_conflict, precision.name,
           "The data contradict the prior of the " + display::parameter_words(precision.name) + ".",
           "Its posterior mean is " + number_text(precision.mean) + ", the prior's 1-99 % range " +
               number_text(low) + " to " + number_text(high) +
               ". That means a standard deviation of " + sd(precision.mean) +
               " of the output range, where the prior expects " + sd(high) + " to " + sd(low) +
               "."}};
}

Findings trajectory_findings(const std::vector<ChainStatistics>& chains,
                             const ConvergenceGate& gate) {
  Findings findings;
  long divergences = 0;
  for (const ChainStatistics& chain : chains) divergences += chain.divergences;
  if (divergences > gate.divergences_max) {
    findings.push_back({FindingKind::not_converged,
                        "trajectories",
                        std::to_string(divergences) +
                            " trajectories of the sampler diverged: the results miss parts of "
                            "the posterior.",
                        {},
                        1.0});
  }
  for (std::size_t k = 0; k < chains.size(); ++k) {
    if (std::isnan(chains[k].e_bfmi) || chains[k].e_bfmi >= gate.e_bfmi_min) continue;
    findings.push_back(
        {FindingKind::not_converged, "energy",
         "Chain " + std::to_string(k + 1) +
             " may miss the tails of the posterior: it is slow between energy levels.",
         "E-BFMI is " + number_text(chains[k].e_bfmi, 2) + ", below " +
             number_text(gate.e_bfmi_min) + ".",
         1.0});
  }
  return findings;
}

Findings evidence_findings(const SamplingReport& report,
                           const std::optional<BridgeEstimate>& bridge) {
  if (!bridge || std::isnan(report.log_evidence)) return {};
  if (std::abs(bridge->log_evidence - report.log_evidence) <= kEvidenceTolerance) return {};
  return {{FindingKind::evidence_disagrees, "evidence",
           "Two estimates of the model's evidence disagree: use neither to compare models.",
           "log p(y) is " + number_text(report.log_evidence, 5) + " from populations and " +
               number_text(bridge->log_evidence, 5) + " from bridge sampling."}};
}

Findings discrepancy_findings(const std::vector<OutputMeasurements>& outputs,
                              const Normalisation& normalisation,
                              const std::vector<ChainDraws>& chains) {
  double sd = 0.0;
  for (const ChainDraws& chain : chains) {
    sd += chain.discrepancy_precision.array().rsqrt().mean() / static_cast<double>(chains.size());
  }
  std::string list;
  std::string most_of;
  double most = 0.0;
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    if (outputs[k].measured_months() == 0) continue;
    double sum = 0.0;
    for (const double value : outputs[k].values) sum += std::isnan(value) ? 0.0 : value;
    const double mean = sum / outputs[k].measured_months();
    const double share = sd * normalisation.scales[k].range() / std::abs(mean);
    const std::string output = display::output_words(outputs[k].name);
    list += (list.empty() ? "" : "; ") + output + ": " + percent_text(share);
    if (!(share > most)) continue;
    most = share;
    most_of = output;
  }
  if (most_of.empty()) return {};
  return {{FindingKind::discrepancy_size, "discrepancy",
           "The model's months err by up to " + percent_text(most) + " (" + most_of +
               "): it cannot show smaller savings.",
           "One standard deviation of the model's error, as a share of the mean: " + list + ".",
           most}};
}

Findings jitter_findings(long count) {
  if (count == 0) return {};
  return {{FindingKind::jitter_used, "covariance",
           "The assumed measurement error is far too small.",
           "The covariance of the measured points had no Cholesky factor " + std::to_string(count) +
               " times, so 1e-10 was added to its diagonal."}};
}

}  // namespace recald::calibration
