/// The design of experiments: where in the prior box a model is run.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/model/parameter.hpp"
#include "core/random/rng.hpp"

namespace recald::design {

/// Latin hypercube through the parameters' priors.
///
/// Column j is F_j^-1((pi_j(i) - 1 + U_ij) / runs) with a random permutation pi_j and U_ij uniform
/// on (0, 1): each of the `runs` equally likely strata of each prior holds exactly one point.
/// Of `candidates` such designs the one with the smallest largest absolute correlation between two
/// columns is kept, so that no two parameters move together by chance.
///
/// @param parameters  (q), q >= 1.
/// @param runs        >= 2.
/// @param candidates  >= 1 designs drawn; 1 is the plain hypercube.
/// @return (runs x q) in the parameters' own units. The same state of `rng` gives the same bytes.
/// @note   O(candidates * runs * q^2).
/// @see    McKay, Beckman, Conover (1979), Technometrics 21(2).
[[nodiscard]] Eigen::MatrixXd latin_hypercube(std::span<const Parameter> parameters, int runs,
                                              Rng& rng, int candidates = 50);

inline constexpr int kWideBlock = 200;

/// Runs for a meta-model that has to hold at the priors' ends too: rows in turn from a Latin
/// hypercube through the priors and from one that is even between their ends. Triangles leave the
/// corners of a box of sixteen parameters all but empty, and a calibration may move there. An
/// office's chilled water, simulated at random corners, was 5.6 % off with runs from the priors
/// alone and 4.4 % with these; where the prior density is high it cost nothing.
/// A prior with tails counts between its quantiles of one in a thousand.
/// More than `kWideBlock` runs are several such designs, one behind the other, so that a design can
/// be continued: its first runs are those of a smaller one.
/// @param runs  >= 4.
/// @return (runs x q) in the parameters' own units.
[[nodiscard]] Eigen::MatrixXd wide_hypercube(std::span<const Parameter> parameters, int runs,
                                             Rng& rng);

/// Random corners of the prior box, where a meta-model is least sure: each parameter at one end of
/// its prior, or at its quantile of one in a thousand where it has tails.
/// @return (runs x q) in the parameters' own units.
[[nodiscard]] Eigen::MatrixXd corners(std::span<const Parameter> parameters, int runs, Rng& rng);

enum class Points {
  wide,     ///< To fit a meta-model to.
  priors,   ///< A Latin hypercube, to check one where the truth is likely.
  corners,  ///< To check one where it is least sure.
};

/// Draws by the function above of that name.
[[nodiscard]] Eigen::MatrixXd draw_points(Points points, std::span<const Parameter> parameters,
                                          int runs, Rng& rng);

/// Largest |Pearson correlation| between two columns of `design`; 0 for a single column.
[[nodiscard]] double largest_correlation(const Eigen::MatrixXd& design);

}  // namespace recald::design
