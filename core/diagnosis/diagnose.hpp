/// A diagnosis from beginning to end: locate, name, and show on months that chose nothing.
/// @see discrepancy.md, 3.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnosis/locate.hpp"
#include "core/diagnosis/naming.hpp"
#include "core/result.hpp"

namespace recald::diagnosis {

struct DiagnoseOptions {
  NamingRules rules;
  int additions_max = 4;
  std::uint64_t seed = 1;
};

/// How well a model tells one meter's shown months. Shares of the mean measured.
struct MeterGap {
  double nmbe_sim_minus_meas;  ///< Of the day parts' energy.
  double cvrmse_daily;
  double cvrmse_monthly;
  double log_score;          ///< Mean log density a month.
  double discrepancy_share;  ///< V: what the structure takes of what is left, fitted months.
};

struct GapChange {
  std::vector<MeterGap> before;          ///< (m)
  std::vector<MeterGap> after;           ///< (m)
  std::vector<double> log_score_change;  ///< (m) after - before, summed over the shown months.
  std::vector<double> log_score_se;      ///< (m)
  bool confirmed = false;  ///< Better by more than two standard errors, and no meter worse by two.
};

/// One effect that was added, as it stood when it was.
struct Addition {
  Candidate candidate;
  std::vector<double> eta;                 ///< At the mode.
  std::vector<double> eta_sd;              ///< Posterior, linearised.
  std::vector<std::vector<double>> draws;  ///< (draws x r) of the posterior.
  double probability;
  double evidence_gain;
  std::vector<double> monthly_kWh;  ///< (m) with the effect minus without, mean month.
};

/// One turn of the wheel.
struct Pass {
  std::vector<Finding> located;
  FirstLook look;
  Naming naming;
};

struct Diagnosis {
  Outcome outcome = Outcome::none;  ///< named as soon as one effect was added and confirmed.
  std::vector<Candidate> candidates;
  std::vector<NotIdentifiable> not_identifiable;
  std::vector<Pass> passes;  ///< The first one is of the drawings.
  std::vector<Addition> added;
  std::optional<GapChange> gap;    ///< Of the hourly model; absent where no month was held.
  bool not_confirmed = false;      ///< Effects were named, and the shown months did not agree.
  std::vector<MeterGap> base_fit;  ///< (m) the base model on the fitted months.
  std::vector<std::string> warnings;
  int model_runs = 0;
};

/// Progress in words and as a share; false stops the diagnosis.
using Observer = std::function<bool(const char* what, double share)>;

/// @return the diagnosis, whatever its outcome; or
///         not_enough_data  no meter with 100 measured day parts;
///         not_finite, not_positive_definite from the fits; cancelled.
[[nodiscard]] Result<Diagnosis> diagnose(const SiteProblem& site, const DiagnoseOptions& options,
                                         const Observer& observer = {});

}  // namespace recald::diagnosis
