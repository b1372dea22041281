/// A site followed from month to month: what was forecast, what came, what has moved.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/display/unit.hpp"
#include "core/display/warning.hpp"
#include "core/drift/cause.hpp"
#include "core/drift/prequential.hpp"
#include "core/drift/shift.hpp"
#include "core/drift/watch/daily_watches.hpp"
#include "core/drift/watch/excess.hpp"
#include "core/drift/watch/watch.hpp"
#include "core/model/model_kind.hpp"
#include "core/model/parameter.hpp"
#include "core/tariff/tariff.hpp"

namespace recald::drift {

/// One output, in the order of the model's.
struct FollowedOutput {
  std::string name;   ///< "steam_daily_kWh"
  std::string meter;  ///< Its id.
  std::string unit;
  metering::Utility utility;
  bool by_level;                 ///< No parameter moves it: forecast by its own months alone.
  std::vector<double> measured;  ///< (months) NaN: none.
  WatchState state;              ///< After the last month.
  std::optional<DailyState> daily = {};  ///< Its days', likewise; absent: not watched.
  tariff::Rates rates = {};              ///< For words; the caller of `follow` may fill them in.
};

/// What a window believed of a parameter after each month.
struct ParameterPath {
  std::vector<double> mean;  ///< (months) NaN before there is a posterior.
  std::vector<double> q05;
  std::vector<double> q95;
};

struct FollowedWindow {
  std::string name;
  double log_score = 0.0;            ///< Of all months after the learning ones; larger is better.
  std::vector<ParameterPath> paths;  ///< (q)
  std::vector<MonthTaken> taken;
};

/// What an alarm may come from, and what was done about it.
struct ExplainedAlarm {
  Alarm alarm;
  std::vector<Cause> causes;  ///< The likeliest first; empty: too little was known before.
  int explained_until = 0;    ///< The last month that the causes were weighed with.
  Consequence consequence = Consequence::none;
  std::optional<Excess> excess = {};  ///< Of a meter whose days are watched.
};

/// What is seen in a meter's readings, without any model.
struct MeterChange {
  MeterChangeKind kind;
  std::string meter;
  std::string since;  ///< "2018-06"
  std::string seen;   ///< The month that settled it; with a unit its first one.
  double factor;      ///< Of its figures, or of the time with usable readings.
  std::string sentence;
};

struct SiteDrift {
  ModelKind model;
  display::UnitSystem units;        ///< Of its words.
  std::string currency = {};        ///< Of its outputs' rates.
  std::vector<std::string> months;  ///< "2019-03", ascending, the learning ones first.
  int learning_months;
  std::vector<Parameter> parameters;  ///< (q)
  std::vector<FollowedOutput> outputs;
  std::vector<PrequentialMonth> record;  ///< Of the months after the learning ones.
  std::vector<ExplainedAlarm> alarms;    ///< Of the record, in order of time.
  std::vector<MeterChange> meter_changes;
  std::vector<Direction> directions;    ///< That causes speak of.
  std::vector<FollowedWindow> windows;  ///< Expanding first: it makes the record.
  /// (q) From the last year but one to the last; empty before there are two years to compare.
  std::vector<Shift> last_year;
  display::Warnings warnings;

  [[nodiscard]] const std::string& month_name(int month) const {
    return months[static_cast<std::size_t>(month)];
  }
};

}  // namespace recald::drift
