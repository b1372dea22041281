/// A calibrated model as savings ask it: a building of the simulator's own, or runs of EnergyPlus.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/model/prior.hpp"
#include "core/random/rng.hpp"
#include "core/result.hpp"
#include "core/savings/drawn_errors.hpp"
#include "core/savings/measure.hpp"

namespace recald::daemon {

/// What each change of each measure achieves: (measures) (changes) (draws).
using AchievedDraws = std::vector<std::vector<Eigen::VectorXd>>;

class MeasuredModel {
 public:
  virtual ~MeasuredModel() = default;

  /// The building as each draw has it: what was calibrated, then what the measures change beside
  /// it, drawn. (draws x columns)
  /// @param theta  (draws x q) Of the posterior.
  [[nodiscard]] virtual Eigen::MatrixXd buildings(const Eigen::MatrixXd& theta, Rng& rng) const = 0;

  /// How many of the leading columns of `buildings` are theta's.
  [[nodiscard]] virtual Eigen::Index calibrated() const = 0;
  /// (q) How far each of theta may be from what was drawn of it.
  [[nodiscard]] virtual std::vector<savings::Limits> limits() const = 0;

  /// Without measures. (draws x outputs * months), output-major, the calibration's months.
  [[nodiscard]] virtual Result<Eigen::MatrixXd> run(const Eigen::MatrixXd& buildings) const = 0;

  /// With one measure, or with all of them. Its own errors are drawn.
  /// @param before    As `run` gives it.
  /// @param measure   Of those that the model was made for; absent: all.
  [[nodiscard]] virtual Result<Eigen::MatrixXd> run_with(const Eigen::MatrixXd& buildings,
                                                         const Eigen::MatrixXd& before,
                                                         const AchievedDraws& achieved,
                                                         std::optional<std::size_t> measure,
                                                         Rng& rng) const = 0;

  /// What the calibration cannot know of a measure; sentences.
  [[nodiscard]] virtual std::vector<std::string> unknowns(
      const savings::Measure& measure) const = 0;
};

/// Sentences that models share. @param label  Of a quantity, as a sentence begins with it.
[[nodiscard]] std::string prior_stands(const std::string& label);
[[nodiscard]] std::string drawn_from(const std::string& label, const Prior& prior);

}  // namespace recald::daemon
