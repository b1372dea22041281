/// Residuals of a model, averaged into maps that people can read.
///
/// All values are shares of the meter's mean measured power, measured minus modelled: +0.1 means
/// that the meter read more than the model by a tenth of its mean. Means are weighted by the parts'
/// hours; NaN without measurements, so an empty cell is never mistaken for agreement.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/diagnosis/evidence/site_problem.hpp"

namespace recald::diagnosis {

/// Mean of a meter over its measured parts, kW; NaN if there are none.
[[nodiscard]] double measured_mean_kW(const SiteProblem& site, Eigen::Index meter);

/// @param modelled_kW  (parts x m)
/// @return (parts x m) (measured - modelled) / mean measured of the meter; NaN where not measured,
///         and throughout for a meter whose mean is not positive.
[[nodiscard]] Eigen::ArrayXXd residual_shares(const SiteProblem& site,
                                              const Eigen::ArrayXXd& modelled_kW);

/// A change of the model on the scale of `residual_shares`, with the same gaps, so that means of
/// the two cover the same parts.
/// @param change_kW  (parts x m), e.g. an effect's footprint
[[nodiscard]] Eigen::ArrayXXd change_shares(const SiteProblem& site,
                                            const Eigen::ArrayXXd& change_kW);

/// Limits of bins of outdoor temperature: whole degC and equally wide (1, 2, 3, 5 or 10 K), at most
/// 14 bins, which contain every part of the period. Empty if there is no part.
[[nodiscard]] std::vector<double> temperature_limits_C(const DayParts& day_parts);

/// One meter's shares in two maps.
struct ResidualMap {
  Eigen::ArrayXXd by_month;        ///< (42 x months) part of the week from Sunday 00 h, by month.
  Eigen::ArrayXXd by_temperature;  ///< (6 x bins) part of the day, by outdoor temperature.
};

/// @param shares    (parts) one column of `residual_shares`
/// @param months    Number of months of the period.
/// @param limits_C  As of `temperature_limits_C`.
[[nodiscard]] ResidualMap residual_map(const DayParts& day_parts,
                                       const Eigen::Ref<const Eigen::ArrayXd>& shares,
                                       std::size_t months, const std::vector<double>& limits_C);

/// The shape of one column, for comparison with an effect's footprint.
struct Signature {
  Eigen::ArrayXd by_part_of_week;  ///< (42)
  Eigen::ArrayXd by_temperature;   ///< (bins)
};

[[nodiscard]] Signature signature_of(const DayParts& day_parts,
                                     const Eigen::Ref<const Eigen::ArrayXd>& shares,
                                     const std::vector<double>& limits_C);

}  // namespace recald::diagnosis
