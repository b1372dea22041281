/// All meters of a site watched by the day, beside their months.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/drift/watch/daily_watch.hpp"
#include "core/drift/watch/watch.hpp"

namespace recald::drift {

/// How a meter's daily watch stands.
struct DailyState {
  double log_evidence;
  double log_threshold;
  double lag_one;       ///< Correlation of a day's surprise with the day before.
  double month_factor;  ///< By which whole months scatter more than their days explain.
};

class DailyWatches {
 public:
  struct Output {
    int output;
    std::vector<WatchedDay> days;
  };
  /// @param months_between_false_alarms  Of all meters together.
  DailyWatches(std::vector<Output> outputs, std::vector<std::string> months, int learning_months,
               double months_between_false_alarms);

  /// Whether any meter is watched.
  [[nodiscard]] bool is_able() const;

  /// Alarms of a month's days, in order of output.
  [[nodiscard]] std::vector<Alarm> evaluate(int month);

  /// The building is another one since that month; meters that know of it by their own alarm go on.
  void begin_at(int month);
  /// Its meter is no longer trusted.
  void set_aside(int output);

  /// Nothing where it is not watched.
  [[nodiscard]] std::optional<DailyState> state(int output) const;

 private:
  struct Watched {
    int output;
    DailyWatch watch;
    std::optional<metering::Day> begun = {};
  };
  [[nodiscard]] Alarm alarm_of(const Watched& watched, const DailyAlarm& alarm) const;
  [[nodiscard]] int month_of_change(metering::Day day, int latest) const;

  std::vector<std::string> months_;
  std::vector<Watched> watched_;
};

}  // namespace recald::drift
