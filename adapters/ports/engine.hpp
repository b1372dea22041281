/// A simulation that can be asked for months: a model of our own, a folder of runs, or a program
/// outside.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "core/executor.hpp"
#include "core/result.hpp"

namespace recald {

/// A port. An engine is made for one building, its outputs and its months; what differs between two
/// runs is the vector of parameters.
class Engine {
 public:
  /// Told how many runs are done; returns false to stop. May be called from the executor's threads.
  using Observer = std::function<bool(int done, int total)>;

  virtual ~Engine() = default;

  /// @param theta     (runs x parameters) in the parameters' own units.
  /// @param executor  Runs rows side by side; what comes out does not depend on it.
  /// @return (runs x outputs * months), each row output-major as `MonthlyModel` writes it; or why
  ///         not, as not_finite or cancelled: what was run until then may be lost.
  virtual Result<Eigen::MatrixXd> run(const Eigen::MatrixXd& theta, const ForEachIndex& executor,
                                      const Observer& observer) = 0;
};

}  // namespace recald
