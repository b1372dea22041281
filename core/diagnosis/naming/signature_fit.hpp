/// The building model fitted to the signatures of the meters, in a second or two.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/diagnosis/naming/signatures.hpp"

namespace recald::diagnosis {

/// All vectors have (names * meters) entries, meter by meter.
struct SignatureFit {
  Eigen::VectorXd measured;
  Eigen::VectorXd nominal;    ///< Of the model by its drawings.
  Eigen::VectorXd fitted;     ///< Of the fitted model.
  Eigen::MatrixXd jacobian;   ///< (entries x q) change of `fitted` for one score of a parameter.
  Eigen::VectorXd scores;     ///< (q) where the fit is, in standard scores of the priors.
  std::vector<double> theta;  ///< (q) the same in the parameters' units.
  Eigen::ArrayXXd hours_kW;   ///< (hours x m) of the fitted model.
  double objective = 0.0;  ///< Squared scores plus squared misfits, a dozen of which count as one.
};

/// Gauss-Newton on one rough spread for all signatures and the original priors. Steps are
/// shortened where they make it worse. Signatures repeat each other, so a dozen count as one.
/// @param predictor  Of the same site; what it has accepted counts.
[[nodiscard]] SignatureFit fit_signatures(const SiteProblem& site, const SignatureReader& reader,
                                          Predictor& predictor);

}  // namespace recald::diagnosis
