#include "core/diagnosis/naming/signature_fit.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "core/diagnosis/evidence/joint_fit.hpp"

namespace recald::diagnosis {
namespace {

constexpr double kAlike = 12.0;  // So many count as one: signatures repeat each other.
constexpr double kSpread = 0.1;  // Standard deviation of each, in its unit.
constexpr int kIterations = 10;
constexpr double kFarthest = 3.0;  // Scores.

Eigen::VectorXd flat(const Eigen::MatrixXd& signatures) {
  return Eigen::Map<const Eigen::VectorXd>(signatures.data(), signatures.size());
}

class Fitter {
 public:
  Fitter(const SiteProblem& site, const SignatureReader& reader, Predictor& predictor)
      : reader_(reader), predictor_(predictor), priors_(priors_of(site)) {
    fit_.measured = flat(reader.read(site.measured_kW));
  }

  SignatureFit run() {
    const auto q = std::ssize(priors_);
    fit_.scores = Eigen::VectorXd::Zero(q);
    fit_.fitted = fit_.nominal = at(fit_.scores);
    fit_.objective = objective_of(fit_.fitted, fit_.scores);
    linearise();
    for (int iteration = 0; iteration < kIterations && improve(); ++iteration) linearise();
    at(fit_.scores);
    fit_.theta = values_at(priors_, fit_.scores);
    fit_.hours_kW = predictor_.hours_kW();
    return std::move(fit_);
  }

 private:
  Eigen::VectorXd at(const Eigen::VectorXd& scores) { return at(scores, predictor_); }
  [[nodiscard]] Eigen::VectorXd at(const Eigen::VectorXd& scores, Predictor& predictor) const {
    predictor.parts_kW(values_at(priors_, scores));
    return flat(reader_.read(predictor.hours_kW()));
  }

  /// In standard deviations; 0 where the site has no such signature.
  [[nodiscard]] Eigen::VectorXd off_of(const Eigen::VectorXd& read) const {
    const Eigen::VectorXd off = (fit_.measured - read) / (kSpread * std::sqrt(kAlike));
    return (fit_.measured + fit_.nominal).array().isFinite().select(off, 0.0);
  }

  [[nodiscard]] double objective_of(const Eigen::VectorXd& read,
                                    const Eigen::VectorXd& scores) const {
    return scores.squaredNorm() + off_of(read).squaredNorm();
  }

  void linearise() {
    constexpr double kStep = 0.15;
    fit_.jacobian.resize(fit_.measured.size(), fit_.scores.size());
    predictor_.for_each(priors_.size(), [&](Predictor& predictor, std::size_t index) {
      const auto j = static_cast<Eigen::Index>(index);
      Eigen::VectorXd there = fit_.scores;
      const double step = there[j] > 0.0 ? -kStep : kStep;
      there[j] += step;
      fit_.jacobian.col(j) =
          ((at(there, predictor) - fit_.fitted) / step).unaryExpr([](double slope) {
            return std::isfinite(slope) ? slope : 0.0;
          });
    });
  }

  /// One step, as long as it helps. @return whether any length did.
  bool improve() {
    const Eigen::MatrixXd slopes = fit_.jacobian / (kSpread * std::sqrt(kAlike));
    const Eigen::VectorXd off = off_of(fit_.fitted) + slopes * fit_.scores;
    const Eigen::Index q = fit_.scores.size();
    const Eigen::MatrixXd normal = slopes.transpose() * slopes + Eigen::MatrixXd::Identity(q, q);
    const Eigen::VectorXd wanted =
        normal.llt().solve(slopes.transpose() * off).cwiseMax(-kFarthest).cwiseMin(kFarthest);
    constexpr int kTrials = 4;
    double step = 1.0;
    for (int trial = 0; trial < kTrials; ++trial, step *= 0.4) {
      const Eigen::VectorXd there = fit_.scores + step * (wanted - fit_.scores);
      const Eigen::VectorXd read = at(there);
      const double objective = objective_of(read, there);
      if (!(objective < fit_.objective)) continue;
      fit_.scores = there;
      fit_.fitted = read;
      fit_.objective = objective;
      return true;
    }
    return false;
  }

  const SignatureReader& reader_;
  Predictor& predictor_;
  std::vector<Prior> priors_;
  SignatureFit fit_;
};

}  // namespace

SignatureFit fit_signatures(const SiteProblem& site, const SignatureReader& reader,
                            Predictor& predictor) {
  return Fitter(site, reader, predictor).run();
}

}  // namespace recald::diagnosis
