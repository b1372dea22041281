/// A diagnosis as files have it.
#pragma once

#include <string>
#include <vector>

#include "core/diagnosis/diagnose.hpp"
#include "core/diagnosis/model_version.hpp"
#include "daemon/results/run_facts.hpp"

namespace recald::daemon {

/// 90 % interval of a change, after - before, over resampled months; NaN without a month.
struct ChangeInterval {
  double low;
  double high;
};

/// The gap of another model than the hourly one, before and after it got the same effects, on the
/// same months kept back.
struct ModelGap {
  /// One output; NaN where there is nothing to judge by.
  struct Figures {
    double nmbe_sim_minus_meas;
    double cvrmse;  ///< Of months.
    double log_score;
    double discrepancy_share;
  };
  /// Of one output, after - before.
  struct Change {
    diagnosis::ScoreGain log_score;
    ChangeInterval nmbe_size;
    ChangeInterval cvrmse;
  };
  std::string model;                 ///< "epc"
  std::vector<std::string> outputs;  ///< (n) as in calibration.json: "steam_daily_kWh"
  std::vector<Figures> before;       ///< (n)
  std::vector<Figures> after;        ///< (n)
  std::vector<Change> change;        ///< (n)
};

/// `diagnosis.json`.
/// @param others   Entries of `gap` beside the hourly model's.
/// @pre the diagnosis has a pass.
[[nodiscard]] std::string diagnosis_json(const diagnosis::Diagnosis& diagnosis,
                                         const diagnosis::SiteProblem& site, const RunFacts& facts,
                                         const std::vector<ModelGap>& others = {});

/// The model's next version: the parent and what the diagnosis added.
[[nodiscard]] diagnosis::ModelVersion next_version(const diagnosis::Diagnosis& diagnosis,
                                                   const diagnosis::SiteProblem& site,
                                                   const diagnosis::ModelVersion& parent,
                                                   const RunFacts& facts, const std::string& at);

}  // namespace recald::daemon
