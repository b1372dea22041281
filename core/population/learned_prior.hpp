/// A prior for one more building of a population.
#pragma once

#include "core/model/prior.hpp"
#include "core/population/population.hpp"

namespace recald::population {

/// The predictive of the population as a triangular prior between the ends of `own`: with its
/// median and its 5 and 95 % quantiles where a triangle can have them, and never narrower than it.
/// The predictive has the spread of buildings and what is not known of centre and spread.
/// @param own  Of the building before anything was learned, as the sites of the population had it.
/// @return the prior; or `own` where the population spreads as far as the ends.
[[nodiscard]] Prior learned_prior(const Population& population, const Prior& own);

}  // namespace recald::population
