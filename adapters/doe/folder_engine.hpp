/// A design folder as an engine: it reads the runs that the folder has, lets the engine behind it
/// compute the others, and stores them.
#pragma once

#include <filesystem>

#include "adapters/doe/design_writer.hpp"
#include "adapters/ports/engine.hpp"

namespace recald::doe {

class FolderEngine final : public Engine {
 public:
  /// Opens the folder, or makes it.
  /// @param behind  Outlives this; null: only the folder's runs are available.
  /// @return the engine, or as `open_design`.
  [[nodiscard]] static Result<FolderEngine> open(std::filesystem::path folder, DesignPlan plan,
                                                 Engine* behind);

  /// Number of runs in the folder.
  [[nodiscard]] int done_count() const { return runs_.done_count(); }
  /// Why runs failed, by number; they are tried again by the next `run`.
  [[nodiscard]] const std::map<int, std::string>& failed() const { return runs_.failed; }

  /// Writes after every few runs, so that an interruption loses little; once where the engine keeps
  /// its runs itself. A run that fails is NaN and stands in `failed`.
  /// @param theta  Rows of the plan.
  /// @return the outputs; or not_found if a run is missing and there is no engine behind;
  ///         invalid_value for a row that is not in the plan; an error of the engine behind;
  ///         cancelled, io_failed. Finished runs are kept.
  Result<Eigen::MatrixXd> run(const Eigen::MatrixXd& theta, const ForEachIndex& executor,
                              const Observer& observer) override;

 private:
  FolderEngine(std::filesystem::path folder, DesignPlan plan, Engine* behind, DesignRunsSoFar runs);

  /// @return the plan's row for each row of theta, or invalid_value.
  [[nodiscard]] Result<std::vector<Eigen::Index>> rows_of(const Eigen::MatrixXd& theta) const;
  Result<void> run_rows(const std::vector<Eigen::Index>& rows, const ForEachIndex& executor,
                        const Observer& observer);

  std::filesystem::path folder_;
  DesignPlan plan_;
  Engine* behind_;
  DesignRunsSoFar runs_;
};

}  // namespace recald::doe
