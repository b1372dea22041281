#include "adapters/views/frame/cost_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <vector>

#include "adapters/views/frame/format.hpp"

namespace recald::views {

std::string cost_words(std::optional<double> money, std::optional<double> emissions_kg,
                       const std::string& currency, std::string_view period) {
  std::vector<std::string> costs;
  std::vector<std::string> savings;
  const auto add = [&](double amount, const std::string& words) {
    (amount > 0.0 ? costs : savings).push_back(words);
  };
  constexpr double kLeast = 12.0;  // a unit a month is not worth a word
  if (money && std::abs(*money) >= kLeast) {
    add(*money, fmt::format("{} {}", count_text(std::abs(*money)), currency));
  }
  if (emissions_kg && std::abs(*emissions_kg) >= kLeast) {
    add(*emissions_kg, fmt::format("{:.1f} t of CO2", std::abs(1e-3 * *emissions_kg)));
  }
  const auto sentence = [&](const char* verb, const std::vector<std::string>& items) {
    return fmt::format("It {} about {} {}.", verb, fmt::join(items, " and "), period);
  };
  std::string text;
  if (!costs.empty()) text = sentence("costs", costs);
  if (!savings.empty()) text += (text.empty() ? "" : " ") + sentence("saves", savings);
  return text;
}

std::string cost_words(std::optional<double> money_month, std::optional<double> emissions_kg_month,
                       const std::string& currency) {
  const auto of_a_year = [](std::optional<double> month) {
    return month ? std::optional{12.0 * *month} : std::nullopt;
  };
  return cost_words(of_a_year(money_month), of_a_year(emissions_kg_month), currency, "a year");
}

}  // namespace recald::views
