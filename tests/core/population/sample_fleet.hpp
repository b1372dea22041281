/// Posteriors of buildings whose scores are known.
#pragma once

#include <cmath>
#include <vector>

#include "core/population/population.hpp"
#include "core/random/rng.hpp"

namespace recald::population {

inline constexpr double kQ95 = 1.6448536;

/// The posterior under `prior` where the likelihood is normal(score, sd) in scores.
inline SitePosterior posterior_of(const SiteEvidence& evidence, const Prior& prior) {
  const double precision = 1.0 / (evidence.sd * evidence.sd);
  const double mean = evidence.score * precision / (1.0 + precision);
  const double sd = 1.0 / std::sqrt(1.0 + precision);
  return {prior.at_score(mean - kQ95 * sd).value, prior.at_score(mean).value,
          prior.at_score(mean + kQ95 * sd).value, prior};
}

/// Of a t with 4 degrees of freedom.
inline double draw_t(Rng& rng) {
  double squares = 0.0;
  for (int i = 0; i < 4; ++i) {
    const double normal = rng.normal();
    squares += normal * normal;
  }
  return rng.normal() / std::sqrt(squares / 4.0);
}

struct Fleet {
  double location;
  double spread;
  std::vector<SitePosterior> sites;
};

inline Fleet draw_fleet(int count, double location, double spread, double sd, const Prior& prior,
                        Rng& rng) {
  Fleet fleet{location, spread, {}};
  for (int i = 0; i < count; ++i) {
    double score = 0.0;
    do {  // beyond, posteriors lie at an end of the prior to the last digit
      score = location + spread * draw_t(rng);
    } while (std::fabs(score) > 5.0);
    fleet.sites.push_back(posterior_of({score + sd * rng.normal(), sd}, prior));
  }
  return fleet;
}

}  // namespace recald::population
