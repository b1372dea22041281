/// The line of a calibration's page that says what the model most likely lacks. The diagnosis runs
/// after the page is written, so it finds this line again and fills it in.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace recald::views {

inline constexpr std::string_view kMostLikelyOpen = "<p class=\"lead\" id=\"most-likely\">";

/// The content of the line. @param sentence  From a diagnosis; empty: there is none yet.
[[nodiscard]] std::string most_likely_markup(std::string_view sentence);

/// Puts the sentence of a diagnosis into that line of a page.
/// @return the page, or nothing if it has no such line or shows other data.
[[nodiscard]] std::optional<std::string> with_most_likely(std::string page,
                                                          std::string_view data_revision,
                                                          std::string_view sentence);

}  // namespace recald::views
