/// A design of experiments on disk: what a dynamic simulation gave at points through the priors,
/// and what the meters of the real building showed.
///
///     priors.csv        parameter,unit,min,mode,max …      see priors_file.hpp
///     doe_inputs.csv    run, one column a parameter
///     doe_outputs.csv   run,month, one column an output    every run has every month
///     inputs.csv        month, one column a model input    may cover more months than the design
///     measurements.csv  month, one column an output        other columns are ignored
///
/// A month is YYYY-MM, or a number in all files. Only the folder of one building goes together: its
/// runs differ in the parameters alone, all have the same weather.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "adapters/doe/design_month.hpp"
#include "core/model/parameter.hpp"
#include "core/result.hpp"

namespace recald::doe {

/// One column a quantity, one row a month.
struct MonthlyTable {
  std::vector<DesignMonth> months;  ///< Ascending.
  std::vector<std::string> names;
  Eigen::MatrixXd values;  ///< (months x names)

  /// Row of a month, or -1.
  [[nodiscard]] Eigen::Index row_of(DesignMonth month) const;
};

struct DesignFolder {
  std::filesystem::path folder;
  std::vector<std::filesystem::path> files;  ///< All that were read.
  std::vector<Parameter> parameters;         ///< (q) in the order of priors.csv.
  std::vector<int> runs;                     ///< Ids, in the order of doe_inputs.csv.
  Eigen::MatrixXd theta;                     ///< (runs x q) in the parameters' units.
  std::vector<std::string> output_names;     ///< As in doe_outputs.csv.
  std::vector<DesignMonth> months;           ///< Covered by every run, ascending.
  Eigen::MatrixXd outputs;                   ///< (runs x outputs * months), output-major.
  MonthlyTable inputs;             ///< All of `months`, maybe more; every value is a number.
  std::vector<std::string> notes;  ///< To be said in words; nothing in them stops anybody.

  /// The rows of `inputs` that the design covers. (months x inputs)
  [[nodiscard]] Eigen::MatrixXd design_inputs() const;
};

/// @param design  Empty; or the name of another design in the same folder, whose files are
///                NAME_priors.csv, NAME_inputs.csv and NAME_outputs.csv.
/// @return the design, or the first fault in a sentence with file, line and column:
///         not_found, io_failed  a file is absent or cannot be read;
///         malformed             columns, numbers, runs or months that are missing, unknown or come
///                               twice;
///         invalid_value         a prior nobody can sample, a parameter or model input that never
///                               changes, one name for two things;
///         not_enough_data       fewer than two runs or months.
[[nodiscard]] Result<DesignFolder> read_design_folder(const std::filesystem::path& folder,
                                                      const std::string& design = {});

struct Measurements {
  MonthlyTable table;  ///< names are the design's outputs; NaN: not measured.
  std::vector<std::string> notes;
};

/// Months of `file` that have no model inputs are left out, and so are outputs that it lacks: both
/// in words.
/// @return malformed; not_enough_data when no output, or no month of the design, is measured.
[[nodiscard]] Result<Measurements> read_measurements(const std::filesystem::path& file,
                                                     const DesignFolder& design);

}  // namespace recald::doe
