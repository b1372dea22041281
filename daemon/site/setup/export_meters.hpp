/// Which meters an export has, as its description, its header or its rows name them, before it is
/// read to its end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "daemon/site/setup/export_survey.hpp"

namespace recald::daemon {

/// The error, with the file's name if it has none.
[[nodiscard]] tl::unexpected<Error> about(const std::filesystem::path& file, const Error& error);

[[nodiscard]] std::vector<SurveyedMeter> meters_of_columns(const table::TableGuess& guess,
                                                           const std::string& file_stem);

/// Those that the rows of a long table name, each with its first unit.
[[nodiscard]] Result<std::vector<SurveyedMeter>> meters_of_rows(const std::filesystem::path& file,
                                                                const table::TableGuess& guess);

/// A unit that nothing says is asked for once its values are known; kWh shows them as they are.
[[nodiscard]] std::string unit_read(const SurveyedMeter& meter);

/// That a reader needs for the meter's unit.
[[nodiscard]] metering::UnitFactors factors_of(const SurveyedMeter& meter);

/// The export as its first rows show it: container, layout, columns, meters and their units.
[[nodiscard]] Result<SurveyedExport> described_export(const std::filesystem::path& file,
                                                      const SurveyHints& hints);

}  // namespace recald::daemon
