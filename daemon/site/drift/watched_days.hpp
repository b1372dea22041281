/// A followed site's days, beside what the hourly model of its drawings makes of them.
#pragma once

#include <string>
#include <vector>

#include "core/drift/watch/daily_reference.hpp"
#include "core/result.hpp"
#include "daemon/site/model/modelled_site.hpp"

namespace recald::daemon {

/// What is followed of one meter by its months.
struct FollowedMeter {
  std::string meter;             ///< Its id, one of the model's outputs.
  std::vector<double> measured;  ///< (months) NaN: none, and its days are none either.
};

/// @param months           "2019-03", ascending; days of others are left out.
/// @param learning_months  The first of them, from which alone the electricity profile is read.
/// @return (meters) days in order of time; or the errors of `make_site_problem`.
[[nodiscard]] Result<std::vector<std::vector<drift::WatchedDay>>> watched_days(
    const ModelledSite& modelled, const std::vector<FollowedMeter>& meters,
    const std::vector<std::string>& months, int learning_months);

}  // namespace recald::daemon
