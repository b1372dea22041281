/// The prequential record: each month forecast before it is looked at, then scored and taken in.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/drift/forecast.hpp"
#include "core/drift/sequential.hpp"
#include "core/drift/watch.hpp"

namespace recald::drift {

/// One output of one month, in the output's unit.
struct ForecastRecord {
  double mean;
  double sd;
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

/// Dawid's prequential principle: a model is judged by what it said beforehand and by nothing else.
/// Months are conditional on their weather, which is known by the time their figures are.
class Prequential {
 public:
  /// @param calibration  Before its first month.
  /// @param all          The points it was made with.
  Prequential(SequentialCalibration calibration, calibration::PosteriorData all,
              const WatchOptions& options);

  /// @param proceed  Asked now and then; false gives `cancelled`.
  /// @return or an error of forecasting or taking; then nothing has happened.
  /// @pre months ascend
  [[nodiscard]] Result<PrequentialMonth> step(int month, const std::function<bool()>& proceed = {});

  [[nodiscard]] const SequentialCalibration& calibration() const { return calibration_; }
  [[nodiscard]] const Watch& watch() const { return watch_; }

 private:
  SequentialCalibration calibration_;
  calibration::PosteriorData all_;
  Watch watch_;
};

}  // namespace recald::drift
