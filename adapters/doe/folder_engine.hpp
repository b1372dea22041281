/// A design folder as an engine: runs that it has are read, the others are run by the engine behind
/// it and written down.
#pragma once

#include <filesystem>

#include "adapters/doe/design_writer.hpp"
#include "adapters/ports/engine.hpp"

namespace recald::doe {

class FolderEngine final : public Engine {
 public:
  /// Opens the folder, or makes it.
  /// @param behind  Outlives this; null: the folder's runs are all there is.
  /// @return or as `open_design`.
  [[nodiscard]] static Result<FolderEngine> open(std::filesystem::path folder, DesignPlan plan,
                                                 Engine* behind);

  /// How many runs the folder has.
  [[nodiscard]] int done_count() const { return runs_.done_count(); }

  /// Writes after every few runs, so that an interruption costs little.
  /// @param theta  Rows of the plan.
  /// @return or not_found where a run is missing and nothing stands behind; invalid_value for a row
  ///         that the plan does not have; what the engine behind finds; cancelled, io_failed: what
  ///         was run is kept.
  Result<Eigen::MatrixXd> run(const Eigen::MatrixXd& theta, const ForEachIndex& executor,
                              const Observer& observer) override;

 private:
  FolderEngine(std::filesystem::path folder, DesignPlan plan, Engine* behind, DesignRunsSoFar runs);

  /// @return the plan's row of each row of theta, or invalid_value.
  [[nodiscard]] Result<std::vector<Eigen::Index>> rows_of(const Eigen::MatrixXd& theta) const;
  Result<void> run_rows(const std::vector<Eigen::Index>& rows, const ForEachIndex& executor);

  std::filesystem::path folder_;
  DesignPlan plan_;
  Engine* behind_;
  DesignRunsSoFar runs_;
};

}  // namespace recald::doe
