#include "core/diagnosis/evidence/monthly_impact.hpp"

#include <algorithm>
#include <limits>

namespace recald::diagnosis {
namespace {

constexpr double kLeastMonths = 1.0 / 31.0;  // one day, if the dates leave less

double months_of(const SiteProblem& site, const Candidate& candidate, std::span<const double> eta) {
  const auto all = static_cast<double>(site.drivers->months.size());
  if (!candidate.begins) return all;
  const double from = eta[eta.size() - (candidate.ends ? 2 : 1)];
  const double to = candidate.ends ? eta.back() : std::numeric_limits<double>::infinity();
  double hours = 0.0;
  double hours_inside = 0.0;
  for (const DayPart& part : site.day_parts.parts) {
    hours += part.hours;
    const double day = part.time_h / 24.0;
    if (from <= day && day < to) hours_inside += part.hours;
  }
  return std::max(all * hours_inside / std::max(hours, 1.0), kLeastMonths);
}

}  // namespace

std::vector<double> monthly_impact_kWh(const SiteProblem& site, const Candidate& candidate,
                                       std::span<const double> eta,
                                       const Eigen::ArrayXXd& effect_kW) {
  const double months = months_of(site, candidate, eta);
  std::vector<double> impact;
  for (Eigen::Index g = 0; g < effect_kW.cols(); ++g) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < effect_kW.rows(); ++i) {
      sum += site.day_parts.parts[static_cast<std::size_t>(i)].hours * effect_kW(i, g);
    }
    impact.push_back(sum / months);
  }
  return impact;
}

}  // namespace recald::diagnosis
