/// The ground of a diagnosis: the base model fitted to the meters, and the remaining noise. All
/// candidates are judged on it.
#pragma once

#include <memory>
#include <vector>

#include "core/diagnosis/check/usual_errors.hpp"
#include "core/diagnosis/evidence/joint_fit.hpp"
#include "core/diagnosis/evidence/observations.hpp"
#include "core/diagnosis/evidence/site_problem.hpp"
#include "core/result.hpp"

namespace recald::diagnosis {

/// Observations by role, noise and base fit of one version of the model.
struct Ground {
  Observations fit;                          ///< Months to fit.
  Observations select;                       ///< Months to choose by; may be empty.
  Observations show;                         ///< Held-out months; may be empty.
  std::shared_ptr<const UsualErrors> usual;  ///< Drawn at a mode near the last one.
  Eigen::MatrixXd errors;                    ///< E of the months to fit.
  std::vector<NoiseLevel> levels;            ///< (m) as fitted to the residuals of the base model.
  std::vector<NoiseNode> grid;               ///< Nodes with some weight under the base model.
  std::size_t reference_node = 0;
  NoiseNode search;  ///< Nearly white, as strong as the residuals of the base model for each meter.
  JointFit none;     ///< Base parameters alone, at their mode.

  [[nodiscard]] FitContext context(const SiteProblem& site) const {
    return {site, fit, errors, grid, reference_node, search};
  }
};

/// Finds scales, noise and mode in turn: the first fit gives the scales, the second the noise, and
/// the third is the result.
/// @param predictor  With the effects that the model already has.
/// @param start      (q) scores near the mode, such as those of the signatures' fit.
/// @return the ground; not_enough_data if a meter has fewer than 100 measured parts to fit; or
///         not_finite, not_positive_definite from the fits.
[[nodiscard]] Result<Ground> lay_ground(Predictor& predictor, const SiteProblem& site,
                                        const Eigen::VectorXd& start);

/// The ground of a model with one more effect, starting where that effect was found: same scales,
/// new noise and mode. Two grounds then differ by the effect and not by another mode.
/// @param predictor  With the effect.
/// @param found      The base parameters fitted together with it, on `before`.
[[nodiscard]] Result<Ground> lay_next_ground(Predictor& predictor, const SiteProblem& site,
                                             const Ground& before, const JointFit& found);

}  // namespace recald::diagnosis
