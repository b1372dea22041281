#include "core/population/population.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <string>

namespace recald::population {
namespace {

constexpr double kLocationSd = 0.70710678;  // sqrt(1/2)
constexpr double kSpreadSd = 0.5;           // before it is halved
constexpr int kDegrees = 4;                 // of freedom; `t_cumulative` is of this one
constexpr double kQ95 = 1.6448536;

constexpr int kLocations = 61;  // -3 to 3
constexpr int kSpreads = 40;    // 0.05 to 2: buildings are never quite alike
constexpr double kLocationStep = 0.1;
constexpr double kSpreadStep = 0.05;
constexpr int kScores = 241;  // -6 to 6
constexpr double kScoreStep = 0.05;
constexpr double kNegligible = 1e-7;  // of the largest weight

/// t_4(mu, tau) is the mean of normals with the variances tau^2 / w, w ~ chi^2_4 / 4.
constexpr std::size_t kNormals = 16;
using Factors = std::array<double, kNormals>;

Factors variance_factors() {
  const boost::math::chi_squared_distribution<> chi_squared(kDegrees);
  Factors factors{};
  for (std::size_t k = 0; k < kNormals; ++k) {
    const double probability = (static_cast<double>(k) + 0.5) / kNormals;
    factors[k] = kDegrees / boost::math::quantile(chi_squared, probability);
  }
  return factors;
}

/// Without the constant sqrt(2 pi).
double log_likelihood(std::span<const SiteEvidence> sites, const Factors& factors, double location,
                      double spread) {
  double sum = 0.0;
  for (const SiteEvidence& site : sites) {
    const double distance = site.score - location;
    double density = 0.0;
    for (const double factor : factors) {
      const double variance = site.sd * site.sd + spread * spread * factor;
      density += std::exp(-0.5 * distance * distance / variance) / std::sqrt(variance);
    }
    // A site beyond all of them is equally impossible everywhere.
    sum += std::log(std::max(density / kNormals, 1e-300));
  }
  return sum;
}

/// Of Student's t with 4 degrees of freedom, in closed form.
double t_cumulative(double t) {
  const double share = t * t / (4.0 + t * t);
  return 0.5 + std::copysign(std::sqrt(share), t) * (0.75 - 0.25 * share);
}

double score_of(const Prior& prior, double value) {
  constexpr double kEnd = 1e-9;
  const double below = std::clamp(prior.cumulative(value), kEnd, 1.0 - kEnd);
  return boost::math::quantile(boost::math::normal_distribution<>(), below);
}

struct GridPoint {
  double location;
  double spread;
  double weight;  ///< First the log of the density, then the probability.
};

std::vector<GridPoint> posterior_grid(std::span<const SiteEvidence> sites) {
  const Factors factors = variance_factors();
  std::vector<GridPoint> grid;
  grid.reserve(static_cast<std::size_t>(kLocations) * kSpreads);
  for (int i = 0; i < kLocations; ++i) {
    const double location = kLocationStep * (i - kLocations / 2);
    for (int j = 1; j <= kSpreads; ++j) {
      const double spread = kSpreadStep * j;
      const double of_location = location / kLocationSd;
      const double of_spread = spread / kSpreadSd;
      grid.push_back({location, spread,
                      log_likelihood(sites, factors, location, spread) -
                          0.5 * (of_location * of_location + of_spread * of_spread)});
    }
  }
  const double largest = std::ranges::max(grid, {}, &GridPoint::weight).weight;
  for (GridPoint& point : grid) point.weight = std::exp(point.weight - largest);
  std::erase_if(grid, [](const GridPoint& point) { return point.weight < kNegligible; });
  double sum = 0.0;
  for (const GridPoint& point : grid) sum += point.weight;
  for (GridPoint& point : grid) point.weight /= sum;
  return grid;
}

void add_predictive(const std::vector<GridPoint>& grid, Population& population) {
  for (int i = 0; i < kScores; ++i) {
    const double score = kScoreStep * (i - kScores / 2);
    double below = 0.0;
    for (const GridPoint& point : grid) {
      below += point.weight * t_cumulative((score - point.location) / point.spread);
    }
    population.scores.push_back(score);
    population.cumulative.push_back(below);
  }
}

}  // namespace

std::vector<SiteEvidence> evidence_of(std::span<const SitePosterior> sites) {
  std::vector<SiteEvidence> evidence;
  for (const SitePosterior& site : sites) {
    const double sd =
        (score_of(site.prior, site.q95) - score_of(site.prior, site.q05)) / (2.0 * kQ95);
    const double variance = sd * sd;
    if (!(variance > 0.0) || 1.0 - variance < kLeastContraction) continue;
    evidence.push_back(
        {score_of(site.prior, site.q50) / (1.0 - variance), 1.0 / std::sqrt(1.0 / variance - 1.0)});
  }
  return evidence;
}

double Population::quantile(double probability) const {
  assert(probability > 0.0 && probability < 1.0);
  const auto above = std::ranges::lower_bound(cumulative, probability);
  if (above == cumulative.begin()) return scores.front();
  if (above == cumulative.end()) return scores.back();
  const auto i = static_cast<std::size_t>(above - cumulative.begin());
  const double share = (probability - cumulative[i - 1]) / (cumulative[i] - cumulative[i - 1]);
  return scores[i - 1] + share * (scores[i] - scores[i - 1]);
}

Result<Population> estimate_population(std::span<const SitePosterior> sites) {
  const std::vector<SiteEvidence> evidence = evidence_of(sites);
  const std::size_t needed = std::max<std::size_t>(kSitesMin, (sites.size() + 1) / 2);
  if (evidence.size() < needed) {
    return failure(ErrorCode::not_enough_data,
                   std::to_string(evidence.size()) + " of " + std::to_string(sites.size()) +
                       " calibrations say something of it beyond their priors, and at least " +
                       std::to_string(needed) + " are needed");
  }
  const std::vector<GridPoint> grid = posterior_grid(evidence);
  Population population{.sites = static_cast<int>(evidence.size()),
                        .location = 0.0,
                        .location_sd = 0.0,
                        .spread = 0.0,
                        .scores = {},
                        .cumulative = {}};
  double square = 0.0;
  for (const GridPoint& point : grid) {
    population.location += point.weight * point.location;
    population.spread += point.weight * point.spread;
    square += point.weight * point.location * point.location;
  }
  const double variance = square - population.location * population.location;
  population.location_sd = std::sqrt(std::max(0.0, variance));
  add_predictive(grid, population);
  return population;
}

}  // namespace recald::population
