/// What the page of meters alone says first, and what has changed, in words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/views/meters/meters_page.hpp"
#include "core/assessment/output_assessment.hpp"
#include "core/metering/months/level_change.hpp"

namespace recald::views {

/// A meter as the first sentence weighs it.
struct MeterStory {
  std::string label;
  display::MeterUnits units = {};
  std::optional<YearComparison> year;
  std::vector<metering::LevelChange> changes;
  std::optional<assessment::UnseenMean> unseen;
  double base_share;  ///< NaN: not known.
};

/// The last twelve months against those of the year before. Months that are counted in another
/// unit say nothing of it.
/// @return nothing where no month is usable.
[[nodiscard]] std::optional<YearComparison> compare_years(
    const std::vector<metering::MonthlyFigure>& figures,
    const std::vector<metering::LevelChange>& changes);

/// A sentence about a change of level.
[[nodiscard]] std::string change_words(const std::string& label,
                                       const metering::LevelChange& change);

/// What matters most: a changed unit, a changed level, use that the weather does not explain, a
/// year unlike the one before; else what was used.
[[nodiscard]] FirstScreen first_screen_of(const std::vector<MeterStory>& stories);

}  // namespace recald::views
