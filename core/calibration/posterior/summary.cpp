#include "core/calibration/posterior/summary.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/display/id_words.hpp"
#include "core/statistics/quantile.hpp"
#include "core/text/number_text.hpp"

namespace recald::calibration {

Summary summarise(std::string name, std::string unit, const Eigen::MatrixXd& draws,
                  double prior_mean, double prior_sd) {
  Eigen::VectorXd sorted = draws.reshaped();
  std::sort(sorted.begin(), sorted.end());
  const double mean = sorted.mean();
  const double variance =
      (sorted.array() - mean).square().sum() / static_cast<double>(sorted.size() - 1);
  const Diagnostics diagnostics = diagnose(draws);
  return {.name = std::move(name),
          .unit = std::move(unit),
          .mean = mean,
          .sd = std::sqrt(variance),
          .q05 = quantile_of_sorted(sorted, 0.05),
          .q50 = quantile_of_sorted(sorted, 0.50),
          .q95 = quantile_of_sorted(sorted, 0.95),
          .prior_mean = prior_mean,
          .prior_sd = prior_sd,
          .contraction = 1.0 - variance / (prior_sd * prior_sd),
          .rhat = diagnostics.rhat,
          .ess_bulk = diagnostics.ess_bulk,
          .ess_tail = diagnostics.ess_tail,
          .mcse = diagnostics.mcse};
}

Findings gate_findings(const std::vector<Summary>& summaries, const ConvergenceGate& gate) {
  Findings findings;
  for (const Summary& s : summaries) {
    std::string faults;
    const auto add = [&faults](const std::string& fault) {
      faults += (faults.empty() ? "" : ", ") + fault;
    };
    // Written so that a NaN fails the gate.
    if (!(s.rhat <= gate.rhat_max)) {
      add("R-hat " + number_text(s.rhat, 5) + " above " + number_text(gate.rhat_max));
    }
    if (!(s.ess_bulk >= gate.ess_min)) {
      add("bulk ESS " + number_text(s.ess_bulk) + " below " + number_text(gate.ess_min));
    }
    if (!(s.ess_tail >= gate.ess_min)) {
      add("tail ESS " + number_text(s.ess_tail) + " below " + number_text(gate.ess_min));
    }
    if (!(s.mcse <= gate.mcse_share_max * s.sd)) {
      add("error of the mean " + number_text(s.mcse) + " above " +
          number_text(gate.mcse_share_max) + " of the sd " + number_text(s.sd));
    }
    if (faults.empty()) continue;
    findings.push_back({FindingKind::not_converged, s.name,
                        "The chains have not converged for the " +
                            display::parameter_words(s.name) + "; run more iterations.",
                        "Do not rely on its figures: " + faults + ".", 1.0});
  }
  return findings;
}

std::vector<int> equally_spaced(int total, int count) {
  assert(total >= 0 && count > 0);
  const int n = std::min(total, count);
  std::vector<int> indices(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    const auto middle = (2LL * i + 1) * total / (2LL * n);
    indices[static_cast<std::size_t>(i)] = static_cast<int>(middle);
  }
  return indices;
}

}  // namespace recald::calibration
