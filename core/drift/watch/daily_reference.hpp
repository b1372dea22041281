/// What a meter's day should have been: a regression on the hourly model and the weather.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/metering/civil_time.hpp"

namespace recald::drift {

/// One local day of one meter.
struct WatchedDay {
  metering::Day date;
  int month;  ///< Index among the months followed.
  bool is_workday;
  double dry_bulb_C;      ///< Means over the day.
  double humidity_ratio;  ///< kg/kg
  double modelled_kW;  ///< Mean of the hours that were measured, by the drawings' hourly model …
  double measured_kW;  ///< … and as measured; NaN where too few were.
};

/// What a regression believes of its coefficients: normal about `mean`, in units of the days'
/// scatter.
struct Coefficients {
  Eigen::VectorXd mean;       ///< (p)
  Eigen::MatrixXd precision;  ///< (p, p) Days that it is worth.
};

/// Workdays and others apart, each by the modelled day, heating and cooling degrees in two slopes
/// and moisture: what the model has wrong with the weather, every year the same, is learnt and is
/// no news.
class DailyReference {
 public:
  /// Hardly anything known.
  [[nodiscard]] static Coefficients vague();

  /// @param days   Measured ones, in any number; may be none.
  /// @param scale  kW that count as one, > 0.
  DailyReference(const std::vector<WatchedDay>& days, double scale, const Coefficients& before);

  struct Expected {
    double mean_kW;
    double sd_kW;  ///< By how days at this level scatter, and how far from the others the day is.
  };
  [[nodiscard]] Expected expect(const WatchedDay& day) const;

  [[nodiscard]] const Coefficients& coefficients() const { return coefficients_; }

  /// What still holds when something has changed: all of it to a `share` of its worth, times a
  /// factor that nobody knows, so that the days of one season tell of the others.
  [[nodiscard]] Coefficients after_a_change(double share, double factor_sd) const;

 private:
  [[nodiscard]] double scatter_at(double level, bool is_workday) const;

  double scale_;
  Coefficients coefficients_;
  Eigen::MatrixXd covariance_;  ///< (p, p) In units of the scatter.
  double scatter_;              ///< sd of all days.
  struct Fitted {
    double level;
    double square;
    bool is_workday;
  };
  std::vector<Fitted> fitted_;
};

}  // namespace recald::drift
