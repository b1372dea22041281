/// What signatures of buildings look like in which nothing is hidden, beside their fitted models.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

namespace recald::diagnosis {

/// Learnt from buildings with nothing hidden. All vectors have (names * meters) entries, as in
/// `SignatureFit`.
struct SignatureNull {
  Eigen::VectorXd spread;    ///< Root mean square of measured minus fitted; NaN: never seen.
  Eigen::MatrixXd patterns;  ///< (entries x k) P: in units of the spread, the covariance is P P' …
  Eigen::VectorXd own;       ///< … plus this diagonal.
  std::map<std::string, double> centre;  ///< Mean of a parameter's standard scores …
  std::map<std::string, double> reach;   ///< … and their standard deviation.

  /// 0 for a parameter that was not in those buildings.
  [[nodiscard]] double centre_of(const std::string& parameter) const;
  /// 1 for a parameter that was not in those buildings; at least 0.4.
  [[nodiscard]] double reach_of(const std::string& parameter) const;
};

/// Distances between signatures in units of what models leave where nothing is hidden.
class SignatureMetric {
 public:
  /// @param there  (entries) NaN where the site has no such signature.
  SignatureMetric(const SignatureNull& null, const Eigen::VectorXd& there);

  /// Signatures that count.
  [[nodiscard]] Eigen::Index count() const { return spread_.size(); }
  /// @param changes  (entries x k) of signatures; no number counts as zero.
  /// @param most     Clipped there, in spreads.
  /// @return (count x k) as if all were independent, with variance one.
  [[nodiscard]] Eigen::MatrixXd whiten(const Eigen::Ref<const Eigen::MatrixXd>& changes,
                                       double most = 1e9) const;

  /// (entries) How many spreads a change of signatures is, clipped as in `whiten`; no number is
  /// zero.
  [[nodiscard]] Eigen::VectorXd in_spreads(const Eigen::VectorXd& change, double most) const;

  /// Widens the spread of each meter by what the model leaves of its signatures beyond what the
  /// null leaves: a meter that a model gets wrong must not make the others' evidence worthless.
  /// @param left  (count) of a fitted model, whitened.
  void widen(const Eigen::VectorXd& left);

 private:
  std::vector<Eigen::Index> there_;
  Eigen::Index per_meter_;  ///< Entries of one meter.
  Eigen::VectorXd spread_;
  Eigen::MatrixXd root_;  ///< L of the covariance L L'.
};

}  // namespace recald::diagnosis
