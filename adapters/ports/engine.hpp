/// A simulation that computes months: one of our models, a folder of runs, or an external program.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "core/executor.hpp"
#include "core/result.hpp"

namespace recald {

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
};

}  // namespace recald
