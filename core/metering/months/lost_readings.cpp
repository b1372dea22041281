#include "core/metering/months/lost_readings.hpp"

#include <algorithm>

#include "core/metering/reading.hpp"

namespace recald::metering {
namespace {

constexpr double kLossMin = 0.15;
constexpr double kTimesTheWorst = 3.0;

double mean_coverage(std::span<const MonthlyFigure> figures) {
  double sum = 0.0;
  for (const MonthlyFigure& figure : figures) sum += figure.coverage;
  return sum / static_cast<double>(figures.size());
}

}  // namespace

std::optional<LostReadings> find_lost_readings(std::span<const MonthlyFigure> figures,
                                               std::size_t first_months) {
  if (first_months == 0 || figures.size() < first_months + 2) return std::nullopt;
  const auto first = figures.first(first_months);
  const double worst = 1.0 - std::ranges::min(first, {}, &MonthlyFigure::coverage).coverage;
  const double limit = std::max(kLossMin, kTimesTheWorst * worst);
  for (std::size_t i = first_months; i + 1 < figures.size(); ++i) {
    if (1.0 - figures[i].coverage <= limit || 1.0 - figures[i + 1].coverage <= limit) continue;
    const auto since = figures.subspan(i);
    return LostReadings{.since = figures[i].month,
                        .seen = figures[i + 1].month,
                        .share_before = mean_coverage(first),
                        .share_since = mean_coverage(since),
                        .stands_still = std::ranges::any_of(since, [](const MonthlyFigure& one) {
                          return has(one.reasons, Reason::stuck);
                        })};
  }
  return std::nullopt;
}

}  // namespace recald::metering
