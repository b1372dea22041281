/// A design of experiments on disk: what a dynamic simulation computed at points across the priors,
/// and what the meters of the real building showed.
///
///     priors.csv        parameter,unit,min,mode,max …      see priors_file.hpp
///     doe_inputs.csv    run, one column per parameter
///     doe_outputs.csv   run,month, one column per output    every run has every month
///     inputs.csv        month, one column per model input   may cover more months than the design
///     measurements.csv  month, one column per output        other columns are ignored
///     failed.csv        run,because                         these runs have no outputs
///
/// A month is YYYY-MM, or a number in all files. A folder holds the runs of one building: they
/// differ only in the parameters and share the same weather.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "adapters/doe/design_month.hpp"
#include "core/model/parameter.hpp"
#include "core/result.hpp"

namespace recald::doe {

/// One column per quantity, one row per month.
struct MonthlyTable {
  std::vector<DesignMonth> months;  ///< Ascending.
  std::vector<std::string> names;
  Eigen::MatrixXd values;  ///< (months x names)

  /// Row of a month, or -1.
  [[nodiscard]] Eigen::Index row_of(DesignMonth month) const;
};

struct DesignFolder {
  std::filesystem::path folder;
  std::vector<std::filesystem::path> files;  ///< All files that were read.
  std::vector<Parameter> parameters;         ///< (q) in the order of priors.csv.
  std::vector<int> runs;                     ///< Run ids, in the order of doe_inputs.csv.
  Eigen::MatrixXd theta;                     ///< (runs x q) in the parameters' units.
  std::vector<std::string> output_names;     ///< As in doe_outputs.csv.
  std::vector<DesignMonth> months;           ///< Covered by every run, ascending.
  Eigen::MatrixXd outputs;                   ///< (runs x outputs * months), output-major.
  MonthlyTable inputs;             ///< All of `months`, maybe more; every value is a number.
  std::vector<std::string> notes;  ///< Notes for the user; none of them is an error.

  /// The rows of `inputs` for the months of the design. (months x inputs)
  [[nodiscard]] Eigen::MatrixXd design_inputs() const;
};

/// @param design  Empty, or the name of another design in the same folder, whose files are
///                NAME_priors.csv, NAME_inputs.csv and NAME_outputs.csv.
/// @return the design, or the first fault in a sentence with file, line and column:
///         not_found, io_failed  a file is absent or cannot be read;
///         malformed             columns, numbers, runs or months that are missing, unknown or
///                               repeated;
///         invalid_value         a prior that cannot be sampled, a parameter or model input that
///                               never changes, one name for two things;
///         not_enough_data       fewer than two runs or months.
[[nodiscard]] Result<DesignFolder> read_design_folder(const std::filesystem::path& folder,
                                                      const std::string& design = {});

struct Measurements {
  MonthlyTable table;  ///< names are the design's outputs; NaN: not measured.
  std::vector<std::string> notes;
};

/// Leaves out months of `file` that have no model inputs, and outputs that the file lacks. A note
/// reports both.
/// @return malformed; not_enough_data when no output, or no month of the design, is measured.
[[nodiscard]] Result<Measurements> read_measurements(const std::filesystem::path& file,
                                                     const DesignFolder& design);

}  // namespace recald::doe
