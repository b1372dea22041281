/// One meter watched day after day: what a month's figure shows late or never.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/drift/watch/daily_reference.hpp"
#include "core/drift/watch/detectors.hpp"

namespace recald::drift {

struct DailyWatchOptions {
  double days_between_false_alarms = 40.0 * 365.25;
  /// A day counts as so many sd at most: a strike or a storm is no change.
  double surprise_max = 2.5;
  /// Months scatter by more than their days explain, at first by this much (a variance), known as
  /// well as after so many months.
  double month_variance = 4.0;
  double month_variance_months = 4.0;
  int days_to_learn = 120;     ///< Measured ones of the learning months; fewer: nothing is watched.
  double days_carried = 60.0;  ///< What is known from before a change is worth after it …
  int days_to_learn_anew = 45;  ///< … and days without a judgement.
};

/// What was noticed of a meter's days.
struct DailyAlarm {
  metering::Day raised;
  int month;            ///< Of `raised`.
  metering::Day since;  ///< Likeliest first day of the change …
  metering::Day since_earliest;
  metering::Day since_latest;  ///< … and its 90 % interval.
  int direction;               ///< +1 more than expected, -1 less.
  double evidence;             ///< e-value.
  double excess;               ///< Of the measured over the expected energy since then, relative.
  bool operator==(const DailyAlarm&) const = default;
};

/// Residuals of the reference, standardised by their scatter, whitened by one lag, and shrunk by
/// what months scatter beyond that, which is learnt by leaving each of the learning months out and
/// goes on being learnt. An e-detector raises alarms; the days since it began date them.
///
/// A value; the same days lead to the same alarms.
class DailyWatch {
 public:
  /// @param days  In order of time, of all months; `learning_months` of them to learn from.
  DailyWatch(std::vector<WatchedDay> days, int learning_months, const DailyWatchOptions& options);

  /// Looks at a month's days. After an alarm the reference is learned again from the change on.
  /// @pre months ascend, the learning ones left out
  [[nodiscard]] std::optional<DailyAlarm> evaluate(int month);

  /// The building has become another one; what was known of it is worth little, and true but for a
  /// factor of the whole that nobody knows better than to `level_sd`.
  void begin_at(metering::Day since, double level_sd);

  /// Whether there was enough to learn from.
  [[nodiscard]] bool is_able() const { return is_able_; }
  [[nodiscard]] double log_evidence() const { return detector_.log_evidence(); }
  [[nodiscard]] double log_threshold() const { return detector_.log_threshold(); }
  [[nodiscard]] double lag_one() const { return lag_one_; }
  /// By what the residuals of whole months scatter beyond their days': a factor of the sd.
  [[nodiscard]] double month_factor() const;

 private:
  struct Seen {
    metering::Day date;
    double measured_kW;
    double expected_kW;
    double white;
  };
  /// Indices among the days seen.
  struct ChangeDays {
    std::size_t likeliest;
    std::size_t earliest;
    std::size_t latest;
  };
  /// Measured days that `belongs` takes.
  template <class Belongs>
  [[nodiscard]] std::vector<WatchedDay> measured(Belongs belongs) const;
  [[nodiscard]] std::vector<double> whitened(const std::vector<double>& standardised) const;
  void learn(int learning_months);
  void take_month(const std::vector<double>& white);
  [[nodiscard]] ChangeDays date_change() const;
  [[nodiscard]] DailyAlarm alarm_of(int month) const;

  DailyWatchOptions options_;
  std::vector<WatchedDay> days_;
  bool is_able_ = false;
  double scale_ = 1.0;  ///< kW, mean of the learning months.
  Coefficients before_ = DailyReference::vague();
  std::optional<metering::Day> begun_;  ///< The first day that the reference learns from.
  double lag_one_ = 0.0;
  double squares_ = 0.0;  ///< Of months' sums over sqrt(days) …
  double months_ = 0.0;   ///< … and how many.
  EDetector detector_;
  std::vector<Seen> seen_;  ///< Since the detector began.
};

}  // namespace recald::drift
