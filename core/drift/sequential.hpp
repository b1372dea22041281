/// The posterior as months come in: each month is forecast, looked at and taken in.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/absent.hpp"
#include "core/assessment/forecast.hpp"
#include "core/calibration/posterior/posterior.hpp"
#include "core/calibration/samplers/particles.hpp"
#include "core/random/rng.hpp"
#include "core/result.hpp"

namespace recald::drift {

using assessment::Forecast;

/// Which months a posterior believes, seen from the newest.
struct Window {
  std::string name = "expanding";  ///< "expanding", "24 months", "12 months", "forgetting"
  int months = 0;                  ///< The last so many; 0: all.
  /// Months after which half of a month's information is forgotten; 0: nothing is.
  double half_life_months = 0.0;
};

struct SequentialOptions {
  int particles = 2048;
  double effective_share = 0.5;  ///< Below it the population is resampled and moved.
  double acceptance_min = 0.10;  ///< Moves that stall: the population begins anew at the prior.
  int anew_every_months = 12;
  int forecast_particles = 128;  ///< That a forecast is made of, evenly from the population.
};

/// The points with these indices. @param rows  Ascending.
[[nodiscard]] calibration::PosteriorData select_points(const calibration::PosteriorData& data,
                                                       const std::vector<Eigen::Index>& rows);

/// All but an output's from `since` on: its meter is doubted.
[[nodiscard]] std::vector<Eigen::Index> rows_without(const calibration::PosteriorData& data,
                                                     int output, int since);

/// How a month was taken in.
struct MonthTaken {
  int month;
  double log_score = 0.0;        ///< log p(y_t | y of the window before): of all outputs together.
  double effective_share = 1.0;  ///< Of the population after weighting, before moves.
  bool moved = false;
  bool anew = false;                 ///< Sampled from the prior, not carried over.
  double acceptance_rate = kAbsent;  ///< Of the last move.
};

/// Particles {theta, phi} carried from month to month (IBIS):
///
///     w <- w p(y_t | y_1 … y_(t-1), theta, phi),  resampled and moved when too few are effective.
///
/// The prior is always the original one: a window that slides drops a month's likelihood and takes
/// another's in, and no posterior becomes a prior for data it has seen.
///
/// Forgetting adds to a point of age a the independent error (2^(a/h) - 1) S, with S its variance
/// under the hyper-parameters' prior means. That is the power prior's weight for independent points
/// (a variance divided by the power), stays a covariance where points are correlated, and needs no
/// order of them.
///
/// @see Chopin (2002), Biometrika 89(3); Ibrahim, Chen (2000), Stat. Sci. 15(1) for power priors.
class SequentialCalibration {
 public:
  /// @param model  Of all months that will ever be asked for; cloned.
  /// @param all    The measured points of all of them, on one fixed scale, in order of output and
  ///               month. Points of a month are not looked at before it is taken.
  SequentialCalibration(const MonthlyModel& model, std::vector<Parameter> parameters,
                        calibration::PosteriorData all, calibration::HyperPrior prior,
                        Window window, const SequentialOptions& options, std::uint64_t seed);

  /// What each measured output of a month is expected to be, on the normalised scale, from the
  /// months taken so far: one forecast a point of it, in order of output.
  /// @return or an error of the model. @pre some month is taken; `month` is not
  [[nodiscard]] Result<std::vector<Forecast>> forecast(int month);

  /// Takes several months in at once, the first ones: what the model was made from.
  /// @return as `take`. @pre months ascend; none is taken yet
  [[nodiscard]] Result<MonthTaken> learn(std::vector<int> months,
                                         const std::function<bool()>& proceed = {});

  /// Takes a month in, whether it has points or not. The first ones are sampled together: before
  /// `q + 2` points there is no posterior, and nothing is sampled; a window that has fewer again
  /// has none again.
  /// @param proceed  Asked now and then; false gives `cancelled`.
  /// @return or an error of the model or of sampling; then everything is as it was.
  [[nodiscard]] Result<MonthTaken> take(int month, const std::function<bool()>& proceed = {});

  /// From now on nothing before `month` counts: the building has changed.
  /// @return as `take`. @pre some month is taken
  Result<void> begin_at(int month, const std::function<bool()>& proceed = {});

  /// Takes an output's points out from `since` on, those to come as well: its meter is doubted.
  /// @return as `take`. @pre some month is taken
  Result<void> set_aside(int output, int since, const std::function<bool()>& proceed = {});

  /// Whether there is a posterior.
  [[nodiscard]] bool has_begun() const { return particles_.has_value(); }
  [[nodiscard]] const calibration::Particles& particles() const { return *particles_; }
  /// Natural values of the calibration parameters, (count x q), evenly weighted.
  [[nodiscard]] Eigen::MatrixXd draw_parameters(int count) const;
  /// `count` particles in unconstrained coordinates, evenly by weight.
  [[nodiscard]] std::vector<Eigen::VectorXd> spread(int count) const;
  [[nodiscard]] const Window& window() const { return window_; }

 private:
  [[nodiscard]] bool forgets() const {
    return window_.months > 0 || window_.half_life_months > 0.0;
  }
  /// Points of the months taken that the window holds when `newest` is the newest, and of `added`.
  [[nodiscard]] calibration::PosteriorData points_seen_from(int newest, int added) const;
  [[nodiscard]] Result<calibration::Posterior> posterior_of(calibration::PosteriorData data) const;
  /// From the prior, on the months taken.
  [[nodiscard]] Result<MonthTaken> learn_again(const std::function<bool()>& proceed);
  [[nodiscard]] Result<void> begin_anew(calibration::Posterior& posterior, MonthTaken& taken,
                                        const std::function<bool()>& proceed);

  std::shared_ptr<const MonthlyModel> model_;  ///< Cloned by whoever evaluates it.
  std::vector<Parameter> parameters_;
  calibration::PosteriorData all_;
  calibration::HyperPrior prior_;
  Window window_;
  SequentialOptions options_;
  std::uint64_t seed_;
  Eigen::VectorXd prior_variances_;  ///< (all points) under the prior means.
  std::vector<int> taken_;           ///< Months, ascending.
  int months_since_anew_ = 0;
  int oldest_ = std::numeric_limits<int>::min();  ///< Month that is still believed.
  std::optional<calibration::Particles> particles_;
};

}  // namespace recald::drift
