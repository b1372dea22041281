#include "adapters/views/savings/savings_words.hpp"

#include <fmt/format.h>

#include "adapters/views/frame/format.hpp"

namespace recald::views {
namespace {

/// Columns of a terminal's table.
constexpr int kWhat = 40;
constexpr int kNumber = 12;

}  // namespace

std::string savings_words(const SavingsData& data) {
  std::string words = data.headline + "\n";
  if (!data.months_before.empty()) {
    words += fmt::format("{} months before, {} to {}; {} months after, {} to {}.\n",
                         data.months_before.size(), data.months_before.front(),
                         data.months_before.back(), data.months_after.size(),
                         data.months_after.front(), data.months_after.back());
  }
  for (const SavingCard& card : data.cards) {
    words += fmt::format("\n{}\n", card.title);
    if (!card.sentence.empty()) words += "  " + card.sentence + "\n";
    words += fmt::format("  {:<{}} {:>{}} {:>{}} {:>{}} {:>10} {:>12}\n", "", kWhat, "median",
                         kNumber, "5 %", kNumber, "95 %", kNumber, "share", "saves at all");
    for (const SavedAmount& amount : card.amounts) {
      words += fmt::format("  {:<{}} {:>{}} {:>{}} {:>{}} {:>10} {:>12}\n",
                           with_unit(amount.what, amount.unit), kWhat, number_text(amount.q50),
                           kNumber, number_text(amount.q05), kNumber, number_text(amount.q95),
                           kNumber, amount.share ? signed_percent_text(*amount.share) : "–",
                           probability_text(amount.probability));
    }
    for (const std::string& note : card.notes) words += "  " + note + "\n";
  }
  if (!data.not_known.empty()) words += "\n";
  for (const std::string& sentence : data.not_known) words += "! " + sentence + "\n";
  return words;
}

}  // namespace recald::views
