/// The days of a design's runs: what months that were not simulated are predicted from.
///
///     doe_days.csv    run,day, one column per output    every run has every day
///
/// A day is YYYY-MM-DD, local. A value is the day's energy in kWh for an output that is a daily
/// average over the month, and the day's highest mean power in kW for a peak.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "adapters/doe/design_folder.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"

namespace recald::doe {

struct DesignDays {
  std::vector<metering::Day> days;  ///< Ascending; they need not be adjacent.
  Eigen::MatrixXd values;  ///< (runs x outputs * days), output-major; runs, outputs of the design.
};

/// The file of days in a design's folder.
[[nodiscard]] std::filesystem::path days_file(const std::filesystem::path& folder);

/// Reads the days of the design's runs. Those of other runs are skipped: a run may have been set
/// aside.
/// @return not_found: the design was made without days; malformed: columns, days or numbers that
///         are missing or repeated, a run of the design without its days; io_failed.
[[nodiscard]] Result<DesignDays> read_design_days(const DesignFolder& design);

/// Writes the file, five digits a value: some 20 bytes and 6 an output a day of a run.
/// @param runs          Ids, in the order of the rows of `days.values`.
/// @param output_names  In the order of its columns.
/// @return io_failed. After a crash the file is either new or unchanged.
[[nodiscard]] Result<void> write_design_days(const std::filesystem::path& folder,
                                             const std::vector<int>& runs,
                                             const std::vector<std::string>& output_names,
                                             const DesignDays& days);

}  // namespace recald::doe
