/// All outputs of a site watched together, month after month.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/drift/watch/calibration_check.hpp"
#include "core/drift/watch/detectors.hpp"
#include "core/metering/civil_time.hpp"

namespace recald::drift {

struct WatchOptions {
  /// One false alarm in so many months of a site, however many outputs it has: 20 years.
  double months_between_false_alarms = 240.0;
  /// Below it surprises are not what forecasts promise, and alarms say so.
  double calibrated_pvalue_min = 0.01;
};

/// To the day, where days were watched.
struct AlarmDays {
  metering::Day raised;
  metering::Day since;  ///< Likeliest first day of the change …
  metering::Day since_earliest;
  metering::Day since_latest;  ///< … and its 90 % interval.
  double excess;  ///< Of what was measured since then over what was expected, relative.
};

/// What was noticed of one output.
struct Alarm {
  int month;   ///< In which it was raised.
  int output;  ///< Index.
  /// Which way the measured value left the forecast: +1 more than expected, -1 less.
  int direction;
  double evidence;  ///< e-value: how many times likelier a change makes these months.
  int since;        ///< Likeliest first month of the change …
  int since_earliest;
  int since_latest;                    ///< … and its 90 % interval.
  bool is_calibrated;                  ///< Whether the stated rate of false alarms may be believed.
  std::optional<AlarmDays> days = {};  ///< Raised by its days; absent: by its months.
};

/// How one output stands, for a page or a metric.
struct WatchState {
  double log_evidence = 0.0;
  double log_threshold = 0.0;
  double cusum_upper = 0.0;
  double cusum_lower = 0.0;
  double change_within_year = 0.0;  ///< Probability.
  std::optional<CalibrationCheck> calibration;
};

/// One e-detector an output at alpha / outputs (Bonferroni: any dependence between outputs), which
/// alone raises alarms; beside it a CUSUM, and change points, which date the change.
///
/// A value: observing the same surprises again leads to the same state, so nothing but the
/// prequential record needs to outlive a process.
class Watch {
 public:
  /// @pre outputs > 0
  Watch(int outputs, const WatchOptions& options);

  /// A month's standardised surprises, nothing where an output has none (a missing month, or too
  /// few before it). A month without any counts as time for nobody.
  /// @param surprises  (outputs)
  /// @return the alarms of this month, in order of output. A detector begins anew after its alarm.
  [[nodiscard]] std::vector<Alarm> observe(int month,
                                           const std::vector<std::optional<double>>& surprises);

  [[nodiscard]] WatchState state(int output) const;

  /// Forecasts come from another model now: what was noticed of the old one says nothing of it.
  void begin_anew();

 private:
  struct Watched {
    EDetector detector;
    Cusum cusum;
    ChangePoint change;
    std::vector<double> surprises;
    std::vector<int> months;  ///< Of the surprises.
  };
  [[nodiscard]] bool is_calibrated(const Watched& watched) const;
  [[nodiscard]] static Watched watched(int outputs, const WatchOptions& options);

  WatchOptions options_;
  std::vector<Watched> outputs_;
};

}  // namespace recald::drift
