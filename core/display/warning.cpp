#include "core/display/warning.hpp"

#include <algorithm>
#include <functional>

namespace recald::display {

std::string Warning::text() const { return details.empty() ? sentence : sentence + " " + details; }

Warning warning_of(const std::string& note) {
  // A sentence ends where a capital letter follows: "approx. 5" does not.
  for (std::size_t end = note.find(". "); end != std::string::npos;
       end = note.find(". ", end + 1)) {
    const char next = end + 2 < note.size() ? note[end + 2] : ' ';
    if ('A' <= next && next <= 'Z') return {note.substr(0, end + 1), note.substr(end + 2)};
  }
  return {note};
}

void add_notes(std::span<const std::string> notes, Warnings& warnings) {
  for (const std::string& note : notes) warnings.push_back(warning_of(note));
}

Warnings ranked(Warnings warnings) {
  std::ranges::stable_sort(warnings, std::greater{}, &Warning::share);
  return warnings;
}

std::string warning_lines(const Warnings& warnings) {
  std::string text;
  for (const Warning& warning : ranked(warnings)) text += "! " + warning.sentence + "\n";
  return text;
}

std::vector<std::string> texts_of(const Warnings& warnings) {
  std::vector<std::string> texts;
  for (const Warning& warning : warnings) texts.push_back(warning.text());
  return texts;
}

}  // namespace recald::display
