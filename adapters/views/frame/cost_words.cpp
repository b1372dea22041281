#include "adapters/views/frame/cost_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <vector>

#include "adapters/views/frame/format.hpp"

namespace recald::views {

std::string cost_words(std::optional<double> money_month, std::optional<double> emissions_kg_month,
                       const std::string& currency) {
  std::vector<std::string> costs;
  std::vector<std::string> savings;
  const auto add = [&](double a_year, const std::string& words) {
    (a_year > 0.0 ? costs : savings).push_back(words);
  };
  if (money_month && std::abs(*money_month) >= 1.0) {
    add(12.0 * *money_month,
        fmt::format("{} {}", count_text(std::abs(12.0 * *money_month)), currency));
  }
  if (emissions_kg_month && std::abs(*emissions_kg_month) >= 1.0) {
    add(12.0 * *emissions_kg_month,
        fmt::format("{:.1f} t of CO2", std::abs(12e-3 * *emissions_kg_month)));
  }
  const auto joined = [](const std::vector<std::string>& items) {
    return fmt::format("{}", fmt::join(items, " and "));
  };
  std::string text;
  if (!costs.empty()) text = "It costs about " + joined(costs) + " a year.";
  if (!savings.empty()) {
    text += (text.empty() ? "" : " ") + ("It saves about " + joined(savings) + " a year.");
  }
  return text;
}

}  // namespace recald::views
