/// A simulation that computes months: one of our models, a folder of runs, or an external program.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "core/executor.hpp"
#include "core/result.hpp"

namespace recald {

/// A run that gave no months.
struct FailedRun {
  Eigen::Index row;     ///< Of the matrix that was run.
  std::string because;  ///< A sentence, in the simulation's words where it had some.
};

/// A port. An engine is made for one building, its outputs and its months; runs differ only in
/// their vector of parameters.
class Engine {
 public:
  /// Receives the number of finished runs; returns false to stop. The executor's
  /// threads may call it.
  using Observer = std::function<bool(int done, int total)>;

  virtual ~Engine() = default;

  /// @param theta     (runs x parameters) in the parameters' own units.
  /// @param executor  Runs rows in parallel; the result does not depend on it.
  /// @return (runs x outputs * months), each row output-major as `MonthlyModel` writes it; or an
  ///         error such as not_finite or cancelled, after which finished runs may be lost.
  virtual Result<Eigen::MatrixXd> run(const Eigen::MatrixXd& theta, const ForEachIndex& executor,
                                      const Observer& observer) = 0;

  /// Of the last `run`: rows that are NaN. Our own models have none; they return an error instead.
  [[nodiscard]] virtual std::vector<FailedRun> failed_runs() const { return {}; }

  /// Whether the engine stores each run itself, so that an interruption loses none.
  [[nodiscard]] virtual bool keeps_runs() const { return false; }
};

}  // namespace recald
