/// The prequential record: each month forecast before it is looked at, then scored and taken in.
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/assessment/forecast.hpp"
#include "core/assessment/level_forecast.hpp"
#include "core/assessment/spread.hpp"
#include "core/drift/sequential.hpp"
#include "core/drift/watch/watch.hpp"

namespace recald::drift {

using assessment::LevelForecast;
using assessment::Spread;
using assessment::Surprise;

/// One output of one month, in the output's unit.
struct ForecastRecord {
  double mean;
  double sd;  ///< Of the mixture; where tails are heavy, quantiles say more.
  double q05;
  double q50;
  double q95;
  double measured;
  Surprise surprise;
};

struct PrequentialMonth {
  int month;
  /// (outputs) Nothing where an output is not measured, or before there is a posterior.
  std::vector<std::optional<ForecastRecord>> outputs;
  MonthTaken taken;
  std::vector<Alarm> alarms;
};

/// An output that no parameter moves. (months) each; NaN: not measured.
struct LevelOutput {
  int output;                    ///< Index among the outputs; it has no points.
  std::vector<double> modelled;  ///< > 0
  std::vector<double> measured;
};

/// Dawid's prequential principle: a model is judged by what it said beforehand and by nothing else.
/// Months are conditional on their weather, which is known by the time their figures are.
class Prequential {
 public:
  /// @param calibration  Before its first month.
  /// @param all          The points it was made with.
  /// @param levels       Outputs that are forecast by themselves.
  Prequential(SequentialCalibration calibration, calibration::PosteriorData all,
              std::vector<LevelOutput> levels, const WatchOptions& options);

  /// The first months, which the model was made from: they are no test of it.
  [[nodiscard]] Result<MonthTaken> learn(std::vector<int> months,
                                         const std::function<bool()>& proceed = {}) {
    return calibration_.learn(std::move(months), proceed);
  }

  /// @param proceed  Asked now and then; false gives `cancelled`.
  /// @return or an error of forecasting or taking; then nothing has happened.
  /// @pre months ascend
  [[nodiscard]] Result<PrequentialMonth> step(int month, const std::function<bool()>& proceed = {});

  /// As SequentialCalibration's: an alarm was found to be the building's …
  Result<void> begin_at(int month, const std::function<bool()>& proceed = {});
  /// … or a meter's, which is forecast no more.
  Result<void> set_aside(int output, int since, const std::function<bool()>& proceed = {});

  [[nodiscard]] const SequentialCalibration& calibration() const { return calibration_; }
  /// Those that are not set aside.
  [[nodiscard]] const calibration::PosteriorData& data() const { return all_; }
  [[nodiscard]] std::vector<LevelOutput> levels() const;
  [[nodiscard]] const Watch& watch() const { return watch_; }

 private:
  SequentialCalibration calibration_;
  /// What the points say of a month. @return or an error of forecasting.
  [[nodiscard]] Result<void> evaluate_points(PrequentialMonth& record);
  void evaluate_levels(PrequentialMonth& record);

  struct Level {
    LevelOutput output;
    LevelForecast forecast;
  };

  calibration::PosteriorData all_;
  std::vector<Spread> spreads_;  ///< (outputs) Of those that have points.
  std::vector<Level> levels_;
  int last_ = 0;  ///< Month looked at.
  Watch watch_;
};

}  // namespace recald::drift
