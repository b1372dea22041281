/// Forecasts of an output that no calibration parameter moves.
#pragma once

#include "core/drift/forecast.hpp"

namespace recald::drift {

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
  void take(double modelled, double measured);

  /// Of the factor, less 1, and of a month: relative, as known by now.
  [[nodiscard]] double level() const { return sum_ / (kappa_ + months_); }
  [[nodiscard]] double scatter() const;
  [[nodiscard]] double level_sd() const;

 private:
  [[nodiscard]] double shape() const { return shape_ + 0.5 * months_; }
  [[nodiscard]] double rate() const;

  double kappa_;  ///< Months that the prior of the factor is worth.
  double shape_;  ///< Of the inverse gamma, before any month.
  double rate_;
  double months_ = 0.0;
  double sum_ = 0.0;      ///< Of the relative differences …
  double squares_ = 0.0;  ///< … and of their squares.
};

}  // namespace recald::drift
