#include "core/drift/inquiries.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace recald::drift {
namespace {

constexpr int kMonthsToAsk = 12;
constexpr int kSameTime = 2;  // months between a change and what is seen of a meter
constexpr int kMonthsToKnowAUnit = 6;

/// The first month that the record's model still believes.
int began_at(const SiteDrift& drift) {
  int month = 0;
  for (const ExplainedAlarm& one : drift.alarms) {
    if (one.consequence == Consequence::began_anew) month = one.alarm.since;
  }
  return month;
}

/// Days that are so far off what was expected may be in another unit, which takes months to tell
/// from a plant that stands still.
bool could_be_a_unit(const Alarm& alarm) {
  constexpr double least_factor = 8.0;
  if (!alarm.days) return false;
  const double ratio = 1.0 + alarm.days->excess;
  return ratio >= least_factor || ratio <= 1.0 / least_factor;
}

/// That the building has changed, in whatever: it is learnt anew all the same.
double of_building(const std::vector<Cause>& causes) {
  double sum = 0.0;
  for (const Cause& cause : causes) {
    if (cause.kind != CauseKind::nothing && cause.kind != CauseKind::meter)
      sum += cause.probability;
  }
  return sum;
}

/// A meter that is known to have changed explains whatever it alone shows, even or uneven.
void blame_meter(ExplainedAlarm& alarm, const MeterChange& change) {
  const auto of_output = [&](CauseKind kind) {
    return std::ranges::find_if(alarm.causes, [&](const Cause& cause) {
      return cause.kind == kind && cause.index == alarm.alarm.output;
    });
  };
  const auto meter = of_output(CauseKind::meter);
  const auto alone = of_output(CauseKind::unknown);
  if (meter == alarm.causes.end() || alone == alarm.causes.end()) return;
  meter->probability += alone->probability;
  alone->probability = 0.0;
  // The refit seeks no factor as far off as a unit's.
  if (change.kind == MeterChangeKind::unit) {
    meter->mean = meter->q05 = meter->q95 = change.factor;
  }
  std::ranges::stable_sort(alarm.causes, std::ranges::greater{}, &Cause::probability);
}

}  // namespace

Result<void> Inquiries::evaluate(const PrequentialMonth& month) {
  for (const Alarm& alarm : daily_.evaluate(month.month)) {
    if (auto opened = open(alarm, month.month); !opened) return opened;
  }
  for (const Alarm& alarm : month.alarms) {
    if (auto opened = open(alarm, month.month); !opened) return opened;
  }
  for (std::size_t i = 0; i < open_.size();) {
    const auto is_over = TRY(weigh(open_[i], month.month));
    if (drift_.alarms[open_[i].alarm].consequence != Consequence::none) {
      // What was believed before has changed: the others are asked anew if they go on.
      open_.clear();
    } else if (is_over) {
      open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
  return {};
}

Result<void> Inquiries::open(const Alarm& alarm, int month) {
  if (is_known(alarm)) return {};
  auto before = known_before(case_of(alarm, month), options_.causes, seed_, proceed_);
  if (!before && before.error().code != ErrorCode::not_enough_data) {
    return tl::unexpected(before.error());
  }
  drift_.alarms.push_back({.alarm = alarm, .causes = {}, .explained_until = month});
  if (before) open_.push_back({drift_.alarms.size() - 1, std::move(*before)});
  return {};
}

/// The same output's alarm is still being looked into, or was raised by this month's days: it is
/// one change, not two.
bool Inquiries::is_known(const Alarm& alarm) const {
  const auto is_same = [&](const ExplainedAlarm& one) { return one.alarm.output == alarm.output; };
  return std::ranges::any_of(open_,
                             [&](const Open& one) { return is_same(drift_.alarms[one.alarm]); }) ||
         std::ranges::any_of(drift_.alarms, [&](const ExplainedAlarm& one) {
           return is_same(one) && one.alarm.month == alarm.month;
         });
}

ChangeCase Inquiries::case_of(const Alarm& alarm, int until) const {
  return {.model = model_,
          .parameters = drift_.parameters,
          .data = prequential_.data(),
          .prior = prior_,
          .levels = prequential_.levels(),
          .directions = drift_.directions,
          .learning_months = drift_.learning_months,
          .first = began_at(drift_),
          .since = alarm.since,
          .until = until};
}

/// That the alarm's meter began to lose readings or changed its unit about then, as far as is
/// known after `month`; null: nothing is known.
const MeterChange* Inquiries::change_of_meter(const Alarm& alarm, int month) const {
  const auto& meter = drift_.outputs[static_cast<std::size_t>(alarm.output)].meter;
  const auto found = std::ranges::find_if(drift_.meter_changes, [&](const MeterChange& change) {
    if (change.meter != meter) return false;
    const auto since = std::ranges::lower_bound(drift_.months, change.since);
    const auto off = (since - drift_.months.begin()) - alarm.since;
    return change.seen <= drift_.month_name(month) && std::abs(off) <= kSameTime;
  });
  return found == drift_.meter_changes.end() ? nullptr : &*found;
}

/// Hours take seconds to ask: when something may be done about it, and again with twice as many.
void Inquiries::ask_hours(Open& open, int month) {
  const Alarm& alarm = drift_.alarms[open.alarm].alarm;
  const int months = month - alarm.since + 1;
  const bool is_due = months >= options_.months_to_act &&
                      (!open.is_asked || std::has_single_bit(static_cast<unsigned>(months)));
  if (!ask_hours_ || !is_due) return;
  open.is_asked = true;
  auto names = ask_hours_(alarm, began_at(drift_), month, proceed_);
  if (names) open.names = std::move(names);
}

/// What is done must not depend on where the record ends, so this comes after it.
void Inquiries::name_newest(ExplainedAlarm& alarm, std::vector<Cause> causes, int month) {
  if (!ask_hours_ || month + 1 != std::ssize(drift_.months)) return;
  const auto names = ask_hours_(alarm.alarm, began_at(drift_), month, proceed_);
  if (names) alarm.causes = with_names(std::move(causes), *names);
}

Result<bool> Inquiries::weigh(Open& open, int month) {
  ExplainedAlarm& alarm = drift_.alarms[open.alarm];
  auto causes = TRY(weigh_causes(case_of(alarm.alarm, month), open.before, options_.causes, seed_));
  alarm.causes = causes;
  const MeterChange* change = change_of_meter(alarm.alarm, month);
  if (change) {
    blame_meter(alarm, *change);
  } else {
    ask_hours(open, month);
    if (open.names) alarm.causes = with_names(std::move(alarm.causes), *open.names);
  }
  alarm.explained_until = month;
  const int months = month - alarm.alarm.since + 1;
  const int months_to_act = could_be_a_unit(alarm.alarm) && !change
                                ? std::max(options_.months_to_act, kMonthsToKnowAUnit)
                                : options_.months_to_act;
  if (months < months_to_act) {
    if (!change) name_newest(alarm, std::move(causes), month);
    return false;
  }
  const Cause first = alarm.causes.front();
  Result<void> done;
  if (first.kind == CauseKind::meter && first.probability >= options_.act_at) {
    done = prequential_.set_aside(first.index, alarm.alarm.since, proceed_);
    daily_.set_aside(first.index);
    alarm.consequence = Consequence::meter_set_aside;
  } else if (of_building(alarm.causes) >= options_.act_at) {
    done = prequential_.begin_at(alarm.alarm.since, proceed_);
    daily_.begin_at(alarm.alarm.since);
    alarm.consequence = Consequence::began_anew;
  } else {
    const bool is_chance = first.kind == CauseKind::nothing && first.probability >= options_.act_at;
    if (!change) name_newest(alarm, std::move(causes), month);
    return is_chance || months >= kMonthsToAsk;
  }
  if (!done) return tl::unexpected(done.error());
  return true;
}

}  // namespace recald::drift
