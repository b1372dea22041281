/// How each possible effect would change the signatures of a site, by its fitted model.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "core/diagnosis/naming/signature_fit.hpp"

namespace recald::diagnosis {

/// A candidate in one shape, with typical amounts, from a day to a day.
struct ExpectedChange {
  const Candidate* candidate;
  std::vector<double> values;  ///< Of the effect's own parameters.
  int from_day;                ///< Counted as `DriverHour::day_index`.
  int to_day;                  ///< Not included.
  Eigen::VectorXd change;      ///< (names * meters) of signatures; NaN where there are none.
};

/// Every eight weeks a date is tried, and for what may end also how long it lasts. A shape costs
/// one run of the model, its dates none: what may begin or not is run once for both.
/// @param candidates  Must outlive what is told.
/// @param visit        Called with each change, in the order of the candidates, in this thread.
/// @param since_day   The day on which all candidates began; absent: dates are tried.
void expect_changes(const SiteProblem& site, const SignatureReader& reader, const SignatureFit& fit,
                    const std::vector<Candidate>& candidates, Predictor& predictor,
                    const std::function<void(const ExpectedChange&)>& visit,
                    std::optional<int> since_day = {});

}  // namespace recald::diagnosis
