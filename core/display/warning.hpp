/// What a person should keep in mind besides the numbers.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace recald::display {

struct Warning {
  std::string sentence;      ///< A line of a terminal: at most some 120 characters.
  std::string details = {};  ///< Further sentences; empty: none.
  /// Of the months, or of the energy, that it is about; 0 where it is about neither.
  double share = 0.0;

  /// Sentence and details, as files have them.
  [[nodiscard]] std::string text() const;
};

using Warnings = std::vector<Warning>;

/// A note of several sentences: the first is the warning's, the others its details.
[[nodiscard]] Warning warning_of(const std::string& note);

/// Appends each note as a warning.
void add_notes(std::span<const std::string> notes, Warnings& warnings);

/// What costs the reader most comes first: by share, then in the order given.
[[nodiscard]] Warnings ranked(Warnings warnings);

/// A line each, ranked, as the console prints them: "! …".
[[nodiscard]] std::string warning_lines(const Warnings& warnings);

/// `text` of each, in the order given.
[[nodiscard]] std::vector<std::string> texts_of(const Warnings& warnings);

}  // namespace recald::display
