#include "core/calibration/posterior_findings.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "core/text/number_text.hpp"

namespace recald::calibration {
namespace {


constexpr double kEdgeWidth = 0.05;  // of the prior's range
constexpr double kEdgeMass = 0.20;

Finding edge_finding(const Parameter& parameter, double share, double end) {
  std::string sentence = percent_text(share);
  sentence += " of the posterior of " + parameter.name;
  sentence += " lies within 5 % of the end of its prior at " + number_text(end);
  sentence += " " + parameter.unit;
  sentence +=
      ": unless that end is a physical limit, the model or a fixed input is wrong, or the prior "
      "too "
      "narrow.";
  return {FindingKind::prior_edge, parameter.name, std::move(sentence)};
}

}  // namespace

Findings edge_findings(const std::vector<Parameter>& parameters,
                       const std::vector<ChainDraws>& chains) {
  Findings findings;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const TriangularPrior& prior = parameters[j].prior;
    const double width = kEdgeWidth * (prior.max - prior.min);
    double low = 0.0;
    double high = 0.0;
    double total = 0.0;
    for (const ChainDraws& chain : chains) {
      const auto values = chain.theta.col(static_cast<Eigen::Index>(j)).array();
      low += static_cast<double>((values < prior.min + width).count());
      high += static_cast<double>((values > prior.max - width).count());
      total += static_cast<double>(values.size());
    }
    if (low / total > kEdgeMass) {
      findings.push_back(edge_finding(parameters[j], low / total, prior.min));
    }
    if (high / total > kEdgeMass) {
      findings.push_back(edge_finding(parameters[j], high / total, prior.max));
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
           "The data contradict the prior of " + precision.name + ": posterior mean " +
               number_text(precision.mean) + ", prior 1-99 % range " + number_text(low) + " to " +
               number_text(high) + ", that is a standard deviation of " + sd(precision.mean) +
               " of the output range where " + sd(high) + " to " + sd(low) + " was believed."}};
}

Findings jitter_findings(long count) {
  if (count == 0) return {};
  return {{FindingKind::jitter_used, "covariance",
           "The covariance of the measured points had no Cholesky factor " + std::to_string(count) +
               " times and was given 1e-10 more on its diagonal: the measurement error is believed "
               "far too small."}};
}

}  // namespace recald::calibration
