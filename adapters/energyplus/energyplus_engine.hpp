/// EnergyPlus as an engine: a model, the places in it that parameters change, its months.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "adapters/energyplus/model_document.hpp"
#include "adapters/energyplus/monthly_output.hpp"
#include "adapters/energyplus/program.hpp"
#include "adapters/energyplus/simulation.hpp"
#include "adapters/ports/engine.hpp"
#include "core/model/parameter.hpp"

namespace recald::energyplus {

/// A parameter, and what it does to the model.
struct TargetedParameter {
  Parameter parameter;
  std::vector<Target> targets;
  Change change = Change::scale;
};

/// All that is fixed between runs.
struct EngineSetup {
  ModelDocument model;  ///< Its sizes frozen, so that a sample does not resize the plant.
  std::vector<TargetedParameter> parameters;
  std::vector<ModelOutput> outputs;
  std::vector<metering::Month> months;           ///< Ascending; they need not be adjacent.
  std::map<int, std::filesystem::path> weather;  ///< An EPW file for each calendar year of them.
  std::chrono::seconds peak_window{900};
  Program program;
  RunLimits limits;
  std::filesystem::path folder;  ///< Runs are made and kept here.
};

/// A run that gave no months.
struct FailedRun {
  std::string at;       ///< The parameters' values in words.
  std::string because;  ///< A sentence, in EnergyPlus's words where it had some.
};

/// Each run is kept as a small file named after all that it depends on. So a design that was
/// interrupted goes on where it stopped, and no run is ever made twice.
class EnergyPlusEngine final : public Engine {
 public:
  /// @param calendar  Of the site; outlives this.
  /// @return invalid_value: a month's year has no weather; not_found, io_failed: the weather cannot
  ///         be read.
  [[nodiscard]] static Result<std::unique_ptr<EnergyPlusEngine>> make(
      EngineSetup setup, const metering::LocalCalendar& calendar);

  /// A row whose run fails is NaN and among `failures`; the others go on.
  /// @return as Engine::run; io_failed: the folder cannot be written; cancelled: what was run is
  ///         kept.
  Result<Eigen::MatrixXd> run(const Eigen::MatrixXd& theta, const ForEachIndex& executor,
                              const Observer& observer) override;

  [[nodiscard]] const std::vector<FailedRun>& failures() const { return failures_; }

 private:
  EnergyPlusEngine(EngineSetup setup, const metering::LocalCalendar& calendar,
                   std::string fingerprint);

  [[nodiscard]] Result<std::vector<double>> run_row(const Eigen::VectorXd& values,
                                                    const std::function<bool()>& keep_going) const;
  [[nodiscard]] Result<std::vector<double>> run_year(const Json& objects, int year,
                                                     const std::filesystem::path& folder,
                                                     const std::function<bool()>& keep_going) const;
  [[nodiscard]] std::string key_of(const Eigen::VectorXd& values) const;

  EngineSetup setup_;
  const metering::LocalCalendar& calendar_;
  std::string fingerprint_;  ///< Of the setup and the weather's bytes.
  std::vector<FailedRun> failures_;
};

}  // namespace recald::energyplus
