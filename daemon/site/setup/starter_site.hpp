/// Weather and a starter model for a drafted site file.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "core/metering/civil_time.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/setup/export_survey.hpp"

namespace recald::daemon {

struct StarterRequest {
  std::filesystem::path epw;  ///< Empty: no weather, and then no model either.
  std::string use;            ///< Empty: no model.
  double floor_area_m2 = 0.0;
  int storeys = 1;
  std::optional<int> built;
};

/// @param drafted   The site that `text` describes.
/// @param exports   From which it was drafted.
/// @param folder    Where the site file will stand.
/// @return `text` with location and [weather] and, where a use is given, period, model and
/// building;
///         or what is wrong with the EPW file, the request, or the months that the meters share.
[[nodiscard]] Result<std::string> with_starter(std::string text, const SiteConfig& drafted,
                                               std::span<const SurveyedExport> exports,
                                               const metering::LocalCalendar& calendar,
                                               const StarterRequest& request,
                                               const std::filesystem::path& folder);

}  // namespace recald::daemon
