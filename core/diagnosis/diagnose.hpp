/// A complete diagnosis: locate the gap, name the effect, and check it on months not used before.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnosis/check/gap.hpp"
#include "core/diagnosis/evidence/locate.hpp"
#include "core/diagnosis/naming.hpp"
#include "core/display/warning.hpp"
#include "core/executor.hpp"
#include "core/result.hpp"

namespace recald::diagnosis {

struct DiagnoseOptions {
  NamingRules rules;
  int additions_max = 4;
  double prior_none = kEvenPrior;  ///< That nothing is missing, before any reading; > 0, < 1.
  std::uint64_t seed = 1;
  /// Effects known to be present, "damper_stuck_open" or "scale_fault:steam". They are
  /// added in this order and kept, whatever their probability and the held-out scores.
  /// Nothing else is added.
  std::vector<std::string> assumed = {};
  ForEachIndex executor = for_each_index_serially;  ///< Of runs of the model, and of noises.
};

/// One added effect, as found when it was added.
struct Addition {
  Candidate candidate;
  std::vector<double> eta;                 ///< At the mode.
  std::vector<double> eta_sd;              ///< Posterior, linearised.
  std::vector<std::vector<double>> draws;  ///< (draws x r) of the posterior.
  double probability;
  double evidence_gain;
  std::vector<double> monthly_kWh;  ///< (m) with the effect minus without, mean of its months.
  Eigen::ArrayXXd effect_kW;        ///< (parts x m) with the effect minus without.
};

/// A base parameter from the calibration of the hourly model, in its own unit.
struct ParameterBelief {
  double mode;
  double q05;
  double q95;
};

/// One pass of the search.
struct Pass {
  std::vector<Misfit> located;
  Naming naming;
  Eigen::ArrayXXd modelled_kW;  ///< (parts x m) the base model of this pass.
  std::vector<MeterGap> gaps;   ///< (m) its gap on the shown months.
};

struct Diagnosis {
  Outcome outcome = Outcome::none;  ///< `named` once one effect was added and confirmed.
  std::vector<Candidate> candidates;
  std::vector<NotIdentifiable> not_identifiable;
  std::vector<Pass> passes;  ///< The first one starts from the drawings.
  std::string why;           ///< Why this outcome, one sentence.
  std::vector<Addition> added;
  Eigen::ArrayXXd modelled_kW;     ///< (parts x m) the final model.
  std::vector<MeterGap> gaps;      ///< (m) its gap on the shown months.
  std::optional<GapChange> gap;    ///< Of the hourly model; absent where no month was held.
  bool not_confirmed = false;      ///< Effects were named, and the shown months did not agree.
  std::vector<MeterGap> base_fit;  ///< (m) the base model on the fitted months.
  std::vector<ParameterBelief> parameters_before;  ///< (q) of the drawings alone.
  std::vector<ParameterBelief> parameters_after;   ///< (q) with what stands added.
  display::Warnings warnings;
  int model_runs = 0;
};

/// Progress in words and as a share; returning false stops the diagnosis. Called before each run of
/// the model, many times per second, from any thread of the executor but never from two at once.
using Observer = std::function<bool(const char* what, double share)>;

/// @return the diagnosis, whatever its outcome; or
///         not_enough_data  a meter has fewer than 100 measured day parts in the months to fit;
///         not_found        an assumed effect is not in the catalogue, or cannot be
///         seen at this site;
///         not_finite, not_positive_definite from the fits; cancelled.
/// @note   Pure: the same site, options and seed give the same bytes with any executor.
[[nodiscard]] Result<Diagnosis> diagnose(const SiteProblem& site, const DiagnoseOptions& options,
                                         const Observer& observer = {});

}  // namespace recald::diagnosis
