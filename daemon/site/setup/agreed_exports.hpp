/// What files that are written alike settle for each other: the order of dates, the decimal sign,
/// the clock, which end of an interval a stamp marks, what flags mean.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "daemon/site/setup/export_survey.hpp"

namespace recald::daemon {

/// What the others of its kind say where an export leaves it open, or was guessed otherwise.
/// @param hints     With which each was surveyed; they go on counting.
/// @param calendar  Of the site, if its zone is known.
/// @return for each export the hints to survey it again with; nothing: it stays as it is.
[[nodiscard]] std::vector<std::optional<SurveyHints>> hints_of_others(
    std::span<const SurveyedExport> exports, std::span<const SurveyHints> hints,
    const std::optional<metering::LocalCalendar>& calendar);

/// Adds the questions that only show in several files together.
void ask_together(std::span<SurveyedExport> exports, std::span<const SurveyHints> hints,
                  const metering::LocalCalendar& calendar);

/// Gives all of a kind the stamps that most evidence is for, and the flags that any of them has.
void agree(std::span<SurveyedExport> exports);

}  // namespace recald::daemon
