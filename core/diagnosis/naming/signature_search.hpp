/// The building model, alone or with one effect, fitted to signatures as closely as what is known
/// of models and parameters asks for.
///
/// With u the parameters' distance from where they mostly are, r what is left of the signatures in
/// the metric of the null, and a the amount of an effect, the negative log posterior density is
///     (F + nu) / 2 log(nu + F |r|^2 / n) + |u|^2 / 2 + (log a)^2 / (2 s^2):
/// Student's t, with as many free observations F as so many signatures are worth, because they
/// repeat each other.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/diagnosis/naming/signature_null.hpp"
#include "core/diagnosis/naming/signatures.hpp"

namespace recald::diagnosis {

/// An effect in one shape.
struct EffectShape {
  const Candidate* candidate = nullptr;
  std::vector<double> values;  ///< Of all its parameters, amounts typical.
  double sign = 1.0;           ///< Of the amount.

  /// Whether there can be more or less of it: a clock is wrong or not.
  [[nodiscard]] bool has_amount() const;
  /// @param factor  On the typical amount.
  [[nodiscard]] std::vector<double> with_factor(double factor) const;
};

/// A place of the model. With an amount there is one entry more than parameters: its logarithm.
struct SignaturePoint {
  Eigen::VectorXd at;        ///< (q or q + 1) u, log a
  Eigen::VectorXd residual;  ///< (n) r, measured minus modelled.
  Eigen::MatrixXd slopes;    ///< (n x (q or q + 1)) of what is modelled, at or near this place.
  double misfit = 0.0;       ///< |r|^2
  double cost = 0.0;         ///< Negative log posterior density, up to a constant.
};

class SignatureSearch {
 public:
  static constexpr double kAmountSpread = 0.9;  ///< s

  /// @param measured  (entries) signatures of the meters.
  /// @param modelled  (entries) of a model; where either is NaN, the site has no such signature.
  /// All references must outlive the search.
  SignatureSearch(const SiteProblem& site, const SignatureReader& reader, const SignatureNull& null,
                  Predictor& predictor, Eigen::VectorXd measured, const Eigen::VectorXd& modelled);

  [[nodiscard]] const SignatureMetric& metric() const { return metric_; }
  [[nodiscard]] Eigen::Index parameters() const { return centre_.size(); }
  /// As `SignatureMetric::widen`; points made before are in the metric of before.
  void widen(const SignaturePoint& base) { metric_.widen(base.residual); }

  /// The base model there. @param scores  (q) standard scores of the parameters.
  [[nodiscard]] SignaturePoint base_at(const Eigen::VectorXd& scores);
  /// Adds an effect to a base model. @param change  (n) what its typical amount changes, whitened.
  [[nodiscard]] SignaturePoint with_effect(const SignaturePoint& base, const EffectShape& shape,
                                           double factor, const Eigen::VectorXd& change);
  /// Makes the slopes by the parameters anew. @param shape  Null: the base model.
  void linearise(SignaturePoint& point, const EffectShape* shape);
  /// Some Gauss-Newton steps whose slopes learn from each run.
  /// @see Broyden (1965), A class of methods for solving nonlinear simultaneous equations.
  [[nodiscard]] SignaturePoint improved(SignaturePoint point, const EffectShape* shape);
  /// At a mode, or nearly.
  [[nodiscard]] SignaturePoint settled(SignaturePoint point, const EffectShape* shape);

  /// (q) standard scores of the parameters.
  [[nodiscard]] Eigen::VectorXd scores_of(const SignaturePoint& point) const;
  /// How much a squared residual counts there, beside a squared distance of parameters.
  [[nodiscard]] double weight_of(const SignaturePoint& point) const;
  /// How much the cost falls when the squared residual falls from `before` to `after`.
  [[nodiscard]] double log_ratio(double before, double after) const;
  /// Log of the log amount's posterior over its prior standard deviation; 0 without an amount.
  [[nodiscard]] double log_narrowing(const SignaturePoint& point) const;
  /// The same search, asking another predictor of the same model.
  [[nodiscard]] SignatureSearch with(Predictor& predictor) const;
  /// (entries) signatures of the model there.
  [[nodiscard]] Eigen::VectorXd modelled(const Eigen::VectorXd& at, const EffectShape* shape) {
    return modelled_by(*predictor_, at, shape);
  }
  /// (entries) measured minus modelled; NaN where the site has no such signature.
  [[nodiscard]] Eigen::VectorXd left_at(const SignaturePoint& point, const EffectShape* shape) {
    return measured_ - modelled(point.at, shape);
  }

 private:
  [[nodiscard]] Eigen::VectorXd modelled_by(Predictor& predictor, const Eigen::VectorXd& at,
                                            const EffectShape* shape) const;
  void evaluate(SignaturePoint& point, const EffectShape* shape);
  [[nodiscard]] Eigen::VectorXd precision_of(const SignaturePoint& point) const;

  SiteFacts facts_;
  const SignatureReader& reader_;
  Predictor* predictor_;
  std::vector<Prior> priors_;
  Eigen::VectorXd measured_;
  SignatureMetric metric_;
  Eigen::VectorXd centre_;  ///< (q) scores where parameters mostly are …
  Eigen::VectorXd reach_;   ///< … and how far they go from there.
};

}  // namespace recald::diagnosis
