/// Forecasts of an output by its level against what the model has of it.
#pragma once

#include <Eigen/Core>

#include "core/assessment/forecast.hpp"

namespace recald::assessment {

/// A main electricity meter is met by the profile that was fitted to it: what is left to learn is
/// by which factor its months differ from the profile, and how much they scatter.
///
///     y_t / f_t - 1 ~ N(mu, s^2),   mu | s^2 ~ N(0, s^2 / kappa),   s^2 ~ inverse gamma
///
/// The forecast is Student's t with the sums of all months taken, written as the mixture of normals
/// that it is.
class LevelForecast {
 public:
  struct Prior {
    double level_sd = 0.03;       ///< Of the factor, relative.
    double scatter = 0.04;        ///< sd of a month, relative …
    double scatter_months = 6.0;  ///< … known as well as after so many months.
  };

  LevelForecast() : LevelForecast(Prior{}) {}
  explicit LevelForecast(const Prior& prior);

  /// @pre modelled > 0
  [[nodiscard]] Forecast forecast(double modelled) const;
  /// Of the weighted mean of several months that are still to come: they share the level, and each
  /// scatters by itself. @param weights  (months) sum 1. @pre modelled > 0
  [[nodiscard]] Forecast forecast_mean(const Eigen::VectorXd& modelled,
                                       const Eigen::VectorXd& weights) const;
  void take(double modelled, double measured);

  /// Of the factor, less 1, and of a month: relative, as known by now.
  [[nodiscard]] double level() const { return sum_ / (kappa_ + months_); }
  [[nodiscard]] double scatter() const;
  [[nodiscard]] double level_sd() const;

 private:
  /// @param modelled    What the level multiplies.
  /// @param scattering  What a month's scatter multiplies.
  [[nodiscard]] Forecast mixture(double modelled, double scattering) const;
  [[nodiscard]] double shape() const { return shape_ + 0.5 * months_; }
  [[nodiscard]] double rate() const;

  double kappa_;  ///< Months that the prior of the factor is worth.
  double shape_;  ///< Of the inverse gamma, before any month.
  double rate_;
  double months_ = 0.0;
  double sum_ = 0.0;      ///< Of the relative differences …
  double squares_ = 0.0;  ///< … and of their squares.
};

/// Of a meter whose lights and plugs the model takes from the meter itself.
inline constexpr LevelForecast::Prior kProfiledLevel{
    .level_sd = 0.03, .scatter = 0.02, .scatter_months = 3.0};

}  // namespace recald::assessment
