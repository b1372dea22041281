/// EnergyPlus as an engine: a model, the places in it that parameters change, its months.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "adapters/energyplus/model/model_document.hpp"
#include "adapters/energyplus/run/monthly_output.hpp"
#include "adapters/energyplus/run/program.hpp"
#include "adapters/energyplus/run/simulation.hpp"
#include "adapters/energyplus/targeted_parameter.hpp"
#include "adapters/ports/engine.hpp"

namespace recald::energyplus {

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

/// What a run gave, output-major.
struct RunFigures {
  std::vector<double> months;  ///< As the engine gives them.
  std::vector<double> days;    ///< As `daily_figures`, of all days of the months.
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

  /// A row whose run fails is NaN and among `failed_runs`; the others go on.
  /// @return as Engine::run; io_failed: the folder cannot be written; cancelled: what was run is
  ///         kept.
  Result<Eigen::MatrixXd> run(const Eigen::MatrixXd& theta, const ForEachIndex& executor,
                              const Observer& observer) override;

  [[nodiscard]] std::vector<FailedRun> failed_runs() const override { return failures_; }
  [[nodiscard]] bool keeps_runs() const override { return true; }

  [[nodiscard]] std::vector<Parameter> parameters() const;
  [[nodiscard]] const std::vector<TargetedParameter>& targeted() const { return setup_.parameters; }

  /// What a run of the last month with these values simulates.
  [[nodiscard]] Json last_model(const Eigen::VectorXd& values) const {
    return objects_at(values, setup_.months.back() / std::chrono::last);
  }

  /// Of all that a run depends on besides its parameters' values.
  [[nodiscard]] const std::string& fingerprint() const { return fingerprint_; }

  /// The days of the months, which `daily` is of.
  [[nodiscard]] const std::vector<metering::Day>& days() const { return days_; }
  /// Of the rows last run: energies in kWh, peaks in kW; NaN in rows that failed.
  /// (rows x outputs * days), output-major.
  [[nodiscard]] const Eigen::MatrixXd& daily() const { return daily_; }

 private:
  EnergyPlusEngine(EngineSetup setup, const metering::LocalCalendar& calendar,
                   std::string fingerprint);

  [[nodiscard]] Result<RunFigures> run_row(const Eigen::VectorXd& values,
                                           const std::function<bool()>& keep_going) const;
  /// A year in which an effect comes or goes is run with and without it, and put together.
  [[nodiscard]] Result<RunFigures> run_year(const Eigen::VectorXd& values, int year,
                                            const std::filesystem::path& folder,
                                            const std::function<bool()>& keep_going) const;
  [[nodiscard]] Result<std::vector<MeterOutput>> simulate_year(
      const Json& objects, int year, const std::filesystem::path& folder,
      const std::function<bool()>& keep_going) const;
  /// The model at these values, with the effects that are there on the day.
  [[nodiscard]] Json objects_at(const Eigen::VectorXd& values, metering::Day day) const;
  [[nodiscard]] std::string key_of(const Eigen::VectorXd& values) const;

  EngineSetup setup_;
  const metering::LocalCalendar& calendar_;
  std::string fingerprint_;  ///< Of the setup and the weather's bytes.
  std::vector<metering::Day> days_;
  Eigen::MatrixXd daily_;
  std::vector<FailedRun> failures_;
};

}  // namespace recald::energyplus
