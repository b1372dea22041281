/// Writing a design of experiments, and taking up one that was interrupted.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "adapters/doe/design_folder.hpp"
#include "core/model/parameter.hpp"
#include "core/result.hpp"

namespace recald::doe {

/// All of a design that is known before its first run.
struct DesignPlan {
  std::vector<Parameter> parameters;
  Eigen::MatrixXd theta;  ///< (runs x q); run i of the files is row i - 1.
  std::vector<std::string> output_names;
  std::vector<DesignMonth> months;
  MonthlyTable inputs;        ///< Months of the design and those that validate.
  MonthlyTable measurements;  ///< NaN: not measured, written as a blank.
  std::uint64_t seed = 1;
  std::string fingerprint;  ///< Of all that a run depends on besides its parameters.
};

/// The runs as far as they have come.
struct DesignRunsSoFar {
  Eigen::MatrixXd outputs;  ///< (runs x outputs * months), output-major; NaN in rows not yet run.
  std::vector<bool> done;   ///< (runs)

  [[nodiscard]] int done_count() const;
};

/// Writes everything but the outputs into a new folder; in a folder that holds this very design,
/// reads the runs that are there already.
/// @return invalid_value when the folder holds another design, saying in what it differs;
///         malformed when its outputs are not as this program left them; io_failed.
[[nodiscard]] Result<DesignRunsSoFar> open_design(const std::filesystem::path& folder,
                                                  const DesignPlan& plan);

/// Writes doe_outputs.csv with the runs that are done: whole, or as it was before.
[[nodiscard]] Result<void> write_outputs(const std::filesystem::path& folder,
                                         const DesignPlan& plan, const DesignRunsSoFar& runs);

}  // namespace recald::doe
