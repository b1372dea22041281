/// All files of a calibration, written so that no interruption leaves half of two results.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "adapters/views/frame/report_data.hpp"
#include "core/result.hpp"
#include "daemon/site/calibrate/finished_calibration.hpp"

namespace recald::daemon {

/// The report page; where no model was calibrated, that of the meters.
/// @param generated_at  Shown on it.
/// @param most_likely   What a diagnosis of the same data holds most likely; empty: there is none.
/// @param compared      All models of the site, where it has several.
[[nodiscard]] std::string render(const FinishedCalibration& done, const std::string& generated_at,
                                 const std::string& most_likely = "",
                                 std::vector<views::ComparedModel> compared = {});

/// Draws, months, profile, page and, last, calibration.json: who finds that finds everything it
/// speaks of. What an earlier calibration left in the folder goes. Where no model was calibrated
/// there are months, page and calibration.json alone.
[[nodiscard]] Result<void> write_calibration(const FinishedCalibration& done,
                                             const std::string& json,
                                             const std::string& generated_at,
                                             const std::filesystem::path& folder,
                                             std::vector<views::ComparedModel> compared = {});

/// The same of a calibration on a design, which has no profile but a screening and a meta-model.
/// @param months  months.csv.
[[nodiscard]] Result<void> write_calibration(const FinishedDesign& done, const std::string& months,
                                             const std::string& json,
                                             const std::string& generated_at,
                                             const std::filesystem::path& folder);

}  // namespace recald::daemon
