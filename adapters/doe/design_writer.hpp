/// Writes a design of experiments, and resumes one that was interrupted.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "adapters/doe/design_folder.hpp"
#include "core/model/parameter.hpp"
#include "core/result.hpp"

namespace recald::doe {

/// Everything about a design that is known before its first run.
struct DesignPlan {
  std::vector<Parameter> parameters;
  Eigen::MatrixXd theta;  ///< (runs x q); run i of the files is row i - 1.
  std::vector<std::string> output_names;
  std::vector<DesignMonth> months;
  MonthlyTable inputs;        ///< The design's months and the validation months.
  MonthlyTable measurements;  ///< NaN: not measured, written as a blank.
  std::uint64_t seed = 1;
  std::string fingerprint;  ///< Of everything that a run depends on besides its parameters.
};

/// The runs done so far.
struct DesignRunsSoFar {
  Eigen::MatrixXd outputs;  ///< (runs x outputs * months), output-major; NaN in rows not yet run.
  std::vector<bool> done;   ///< (runs)
  std::map<int, std::string> failed = {};  ///< Why, by number of the run.

  [[nodiscard]] int done_count() const;
};

/// Writes everything but the outputs into a new folder. If the folder already holds this design,
/// or its first runs, reads the finished ones.
/// @return invalid_value when the folder holds another design, saying how it differs;
///         malformed when this program did not write its outputs; io_failed.
[[nodiscard]] Result<DesignRunsSoFar> open_design(const std::filesystem::path& folder,
                                                  const DesignPlan& plan);

/// Of the plan that a folder was made from. Empty: it does not say.
[[nodiscard]] std::string fingerprint_of(const std::filesystem::path& folder);

/// Writes the finished runs to doe_outputs.csv and those that failed to failed.csv. After a crash
/// the file is either new or unchanged.
[[nodiscard]] Result<void> write_outputs(const std::filesystem::path& folder,
                                         const DesignPlan& plan, const DesignRunsSoFar& runs);

}  // namespace recald::doe
