#include "core/diagnosis/signature_fit.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "core/diagnosis/joint_fit.hpp"

namespace recald::diagnosis {
namespace {

constexpr double kAlike = 12.0;    // Signatures repeat each other.
constexpr double kVanished = 4.0;  // Of the spread: what has no value any more.
constexpr int kIterations = 10;
constexpr double kFarthest = 3.0;  // Scores.

Eigen::VectorXd flat(const Eigen::MatrixXd& signatures) {
  return Eigen::Map<const Eigen::VectorXd>(signatures.data(), signatures.size());
}

/// Standard deviations to find the mode with: powers, times in hours, shares of days.
Eigen::VectorXd rough_spread() {
  const auto& names = signature_names();
  Eigen::VectorXd spread(std::ssize(names));
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool is_time = names[i].find("of the day, ") != std::string::npos;
    const bool is_share = names[i].find("that have one") != std::string::npos;
    spread[static_cast<Eigen::Index>(i)] = is_share ? 0.3 : is_time ? 0.7 : 0.1;
  }
  return spread.replicate(static_cast<Eigen::Index>(kSignatureMeters), 1);
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
    fit_.theta = theta_;
    fit_.hours_kW = predictor_.hours_kW();
    return std::move(fit_);
  }

 private:
  Eigen::VectorXd at(const Eigen::VectorXd& scores) {
    theta_ = values_at(priors_, scores);
    predictor_.parts_kW(theta_);
    return flat(reader_.read(predictor_.hours_kW()));
  }

  [[nodiscard]] double objective_of(const Eigen::VectorXd& read,
                                    const Eigen::VectorXd& scores) const {
    double sum = scores.squaredNorm();
    for (Eigen::Index i = 0; i < read.size(); ++i) {
      if (!std::isfinite(fit_.measured[i]) || !std::isfinite(fit_.nominal[i])) continue;
      const double off = (fit_.measured[i] - read[i]) / spread_[i];
      // What vanishes, such as the start of a day without one, must not count as a good fit.
      sum += (std::isfinite(off) ? off * off : kVanished * kVanished) / kAlike;
    }
    return sum;
  }

  void linearise() {
    constexpr double kStep = 0.15;
    fit_.jacobian.resize(fit_.measured.size(), fit_.scores.size());
    for (Eigen::Index j = 0; j < fit_.scores.size(); ++j) {
      Eigen::VectorXd there = fit_.scores;
      const double step = there[j] > 0.0 ? -kStep : kStep;
      there[j] += step;
      fit_.jacobian.col(j) = ((at(there) - fit_.fitted) / step).unaryExpr([](double slope) {
        return std::isfinite(slope) ? slope : 0.0;
      });
    }
  }

  /// One step, as long as it helps. @return whether any length did.
  bool improve() {
    const Eigen::VectorXd weight = (spread_ * std::sqrt(kAlike)).cwiseInverse();
    Eigen::MatrixXd slopes = weight.asDiagonal() * fit_.jacobian;
    Eigen::VectorXd off = (fit_.measured - fit_.fitted).cwiseProduct(weight);
    for (Eigen::Index i = 0; i < off.size(); ++i) {
      if (std::isfinite(off[i])) continue;
      off[i] = 0.0;
      slopes.row(i).setZero();
    }
    off += slopes * fit_.scores;
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
  Eigen::VectorXd spread_ = rough_spread();
  std::vector<double> theta_;
  SignatureFit fit_;
};

}  // namespace

SignatureFit fit_signatures(const SiteProblem& site, const SignatureReader& reader,
                            Predictor& predictor) {
  return Fitter(site, reader, predictor).run();
}

}  // namespace recald::diagnosis
