/// The line of a calibration's page that says what the model lacks most likely. The diagnosis is
/// made after the page, so it finds the line again and fills it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace recald::report {

inline constexpr std::string_view kMostLikelyOpen = "<p class=\"lead\" id=\"most-likely\">";

/// What stands in the line. @param sentence  Of a diagnosis; empty: there is none yet.
[[nodiscard]] std::string most_likely_markup(std::string_view sentence);

/// The page with the sentence of a diagnosis in that line.
/// @return nothing where the page has no such line, or is of other data.
[[nodiscard]] std::optional<std::string> with_most_likely(std::string page,
                                                          std::string_view data_revision,
                                                          std::string_view sentence);

}  // namespace recald::report
