/// Summaries of draws for reports and the convergence gate.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/calibration/posterior/diagnostics.hpp"
#include "core/calibration/posterior/findings.hpp"

namespace recald::calibration {

/// One quantity over the pooled draws of all chains.
struct Summary {
  std::string name;
  std::string unit;
  double mean;
  double sd;
  double q05;
  double q50;
  double q95;
  double prior_mean;
  double prior_sd;
  double contraction;  ///< 1 - sd^2 / prior_sd^2: information from the data; near 0 or below: none.
  double rhat;
  double ess_bulk;
  double ess_tail;
  double mcse;  ///< Of the mean.
};

/// @param draws  (iterations x chains), iterations >= 8.
[[nodiscard]] Summary summarise(std::string name, std::string unit, const Eigen::MatrixXd& draws,
                                double prior_mean, double prior_sd);

/// Limits of Vehtari et al. (2021), and on the error of the mean.
struct ConvergenceGate {
  double rhat_max = 1.01;
  double ess_min = 400.0;        ///< Bulk and tail, over all chains.
  double mcse_share_max = 0.05;  ///< Of the posterior sd.
  double e_bfmi_min = 0.3;       ///< Of every chain that has one.
  long divergences_max = 0;      ///< Over all chains.
};

/// One finding per failing quantity; empty: the gate passes.
[[nodiscard]] Findings gate_findings(const std::vector<Summary>& summaries,
                                     const ConvergenceGate& gate = {});

/// `count` indices into [0, total), equally spaced, in the middle of each of `count` equal
/// stretches. All of them when total <= count.
[[nodiscard]] std::vector<int> equally_spaced(int total, int count);

}  // namespace recald::calibration
