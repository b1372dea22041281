#include "adapters/views/drift/drift_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

#include "adapters/views/frame/cost_words.hpp"
#include "core/absent.hpp"
#include "core/diagnosis/effects/support/effect.hpp"
#include "core/display/id_words.hpp"
#include "core/display/prose.hpp"
#include "core/display/unit.hpp"
#include "core/display/warning.hpp"

namespace recald::views {
namespace {

/// Means of an output from the change to the alarm, in its unit.
struct SinceChange {
  double measured = 0.0;
  double expected = 0.0;
  int months = 0;
};

SinceChange since_change(const drift::SiteDrift& drift, const drift::Alarm& alarm) {
  SinceChange since;
  for (const drift::PrequentialMonth& month : drift.record) {
    const auto& output = month.outputs[static_cast<std::size_t>(alarm.output)];
    if (!output || month.month < alarm.since || month.month > alarm.month) continue;
    since.measured += output->measured;
    since.expected += output->q50;
    ++since.months;
  }
  return since;
}

/// What a month's figure stands for in money: its kWh, or its kW.
double amount_of(const drift::SiteDrift& drift, int month, double figure, bool is_peak) {
  const auto name = metering::parse_month(drift.month_name(month));
  if (is_peak || !name) return figure;
  return figure * metering::days_in(*name);
}

/// (measured - forecast) of the months since the change, all together: kWh, or kW of months.
double excess_so_far(const drift::SiteDrift& drift, const drift::Alarm& alarm, bool is_peak) {
  double sum = 0.0;
  for (const drift::PrequentialMonth& month : drift.record) {
    const auto& output = month.outputs[static_cast<std::size_t>(alarm.output)];
    if (!output || month.month < alarm.since || month.month > alarm.month) continue;
    sum += amount_of(drift, month.month, output->measured - output->q50, is_peak);
  }
  return sum;
}

/// What a year would be without the change, in its own season: of each month of the calendar the
/// latest that is known, its forecast or, before the change, its figure. Absent while one is not.
std::optional<double> expected_year(const drift::SiteDrift& drift, const drift::Alarm& alarm,
                                    bool is_peak) {
  const auto k = static_cast<std::size_t>(alarm.output);
  std::vector<double> expected(drift.months.size(), kAbsent);
  const std::vector<double>& measured = drift.outputs[k].measured;
  for (std::size_t i = 0; i < measured.size() && static_cast<int>(i) < alarm.since; ++i) {
    expected[i] = measured[i];
  }
  for (const drift::PrequentialMonth& month : drift.record) {
    if (month.outputs[k]) expected[static_cast<std::size_t>(month.month)] = month.outputs[k]->q50;
  }
  std::array<double, 12> of_calendar{};
  of_calendar.fill(kAbsent);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto name = metering::parse_month(drift.months[i]);
    if (!name || std::isnan(expected[i])) continue;
    of_calendar[static_cast<unsigned>(name->month()) - 1] =
        amount_of(drift, static_cast<int>(i), expected[i], is_peak);
  }
  const double sum = std::accumulate(of_calendar.begin(), of_calendar.end(), 0.0);
  return std::isnan(sum) ? std::nullopt : std::optional{sum};
}

/// Mean of (measured - forecast) / forecast from the change to the alarm.
double relative_excess(const drift::SiteDrift& drift, const drift::Alarm& alarm) {
  if (alarm.days) return alarm.days->excess;
  const SinceChange since = since_change(drift, alarm);
  return since.measured / since.expected - 1.0;
}

/// kWh, or kW of months.
struct Added {
  double so_far;
  std::optional<double> a_year;
};

/// By the meter's days where they are known, else by its months until the alarm.
Added added_by(const drift::SiteDrift& drift, const drift::ExplainedAlarm& explained,
               bool is_peak) {
  if (const auto& excess = explained.excess) return {excess->so_far_kWh, excess->year_kWh};
  Added added{excess_so_far(drift, explained.alarm, is_peak), std::nullopt};
  if (const auto year = expected_year(drift, explained.alarm, is_peak)) {
    added.a_year = relative_excess(drift, explained.alarm) * *year;
  }
  return added;
}

/// Of what an alarm has cost: "so far", or "from 2022-02-28" where another alarm was the first of
/// the same change, and " to 2023-03-01" where that has ended.
std::string period_words(const drift::ExplainedAlarm& explained) {
  const auto& excess = explained.excess;
  if (!excess) return "so far";
  const bool is_first = explained.alarm.days && explained.alarm.days->since == excess->since;
  if (excess->has_ended) {
    return fmt::format("from {} to {}", metering::to_string(excess->since),
                       metering::to_string(excess->until));
  }
  return is_first ? "so far" : fmt::format("so far, since {}", metering::to_string(excess->since));
}

/// Months of an output inside the 90 % interval of their forecasts, and how many there are.
std::pair<int, int> inside_90(const drift::SiteDrift& drift, std::size_t output) {
  int inside = 0;
  int all = 0;
  for (const drift::PrequentialMonth& month : drift.record) {
    const auto& record = month.outputs[output];
    if (!record) continue;
    ++all;
    inside += record->q05 <= record->measured && record->measured <= record->q95 ? 1 : 0;
  }
  return {inside, all};
}

/// "2020-04 (90 %: 2020-03 to 2020-05)", to the day where days were watched.
std::string since_words(const drift::SiteDrift& drift, const drift::Alarm& alarm) {
  if (const auto& days = alarm.days) {
    return fmt::format("{} (90 %: {} to {})", metering::to_string(days->since),
                       metering::to_string(days->since_earliest),
                       metering::to_string(days->since_latest));
  }
  return fmt::format("{} (90 %: {} to {})", drift.month_name(alarm.since),
                     drift.month_name(alarm.since_earliest), drift.month_name(alarm.since_latest));
}

/// A cause that is as likely as this is settled.
constexpr double kSettled = 0.8;

/// The measurement that tells an effect from another, as the catalogue has it for either; empty: it
/// has none.
std::string_view separated_by(std::string_view effect, std::string_view other) {
  for (const auto& [own, rival] : {std::pair{effect, other}, std::pair{other, effect}}) {
    const diagnosis::Effect* known = diagnosis::find_effect(own);
    if (known == nullptr) continue;
    const auto found = std::ranges::find(known->confusable, rival, &diagnosis::Confusable::effect);
    if (found != known->confusable.end()) return found->separated_by;
  }
  return {};
}

/// What would tell the two likeliest causes apart; empty: nobody knows.
std::string distinguishing_words(const drift::SiteDrift& drift,
                                 const std::vector<drift::Cause>& causes) {
  const std::string_view measurement = separated_by(causes[0].effect, causes[1].effect);
  if (measurement.empty()) return "";
  return " What tells them apart: " +
         display::with_temperatures_in(drift.units, std::string{measurement});
}

/// "heating", "cooling"; empty: a meter that works all year.
std::string season_of(metering::Utility utility) {
  switch (utility) {
    case metering::Utility::heating:
    case metering::Utility::steam:
    case metering::Utility::gas:
      return "heating";
    case metering::Utility::chilled_water:
      return "cooling";
    case metering::Utility::electricity:
    case metering::Utility::water:
      break;
  }
  return "";
}

/// Of the months from one to the one before another; NaN: none was measured.
double mean_of(const drift::FollowedOutput& output, int from, int to) {
  double sum = 0.0;
  int count = 0;
  for (int month = from; month < to; ++month) {
    const double measured = output.measured[static_cast<std::size_t>(month)];
    if (std::isnan(measured)) continue;
    sum += measured;
    ++count;
  }
  return count > 0 ? sum / count : kAbsent;
}

/// A plant that has been at rest since the change says nothing of it yet.
std::string wait_words(const drift::SiteDrift& drift, const drift::ExplainedAlarm& alarm) {
  constexpr double kAtRest = 0.15;  // Of the mean of the months before.
  for (std::size_t k = 0; k < drift.outputs.size(); ++k) {
    const drift::FollowedOutput& output = drift.outputs[k];
    const std::string season = season_of(output.utility);
    const bool has_changed = static_cast<int>(k) == alarm.alarm.output;  // a dead meter is at rest
    if (season.empty() || has_changed || output.name.ends_with("_peak_kW")) continue;
    const double since = mean_of(output, alarm.alarm.since, alarm.explained_until + 1);
    if (since < kAtRest * mean_of(output, 0, alarm.alarm.since)) {
      return fmt::format(" Wait until {} begins: its months will tell more.", season);
    }
  }
  return "";
}

std::string look_at_words(drift::CauseKind kind) {
  switch (kind) {
    case drift::CauseKind::nothing:
      return "Wait for another month.";
    case drift::CauseKind::parameter:
    case drift::CauseKind::direction:
    case drift::CauseKind::effect:
      return "Find out what changed in the building around that time.";
    case drift::CauseKind::meter:
      return "Check the meter: its transformers, its unit, its register map.";
    case drift::CauseKind::unknown:
      return "Run `recald diagnose` to find out what it is.";
  }
  return "";
}

}  // namespace

std::string alarm_sentence(const drift::SiteDrift& drift, const drift::Alarm& alarm) {
  const drift::FollowedOutput& output = drift.outputs[static_cast<std::size_t>(alarm.output)];
  std::string sentence = fmt::format(
      "{} has been {} than forecast since {}, by {:+.0f} %; alarm raised {}, evidence {:.3g} to 1.",
      display::capitalised(display::output_words(output.name)),
      alarm.direction > 0 ? "more" : "less", since_words(drift, alarm),
      100.0 * relative_excess(drift, alarm),
      alarm.days ? "by the daily watch on " + metering::to_string(alarm.days->raised)
                 : "after " + drift.month_name(alarm.month),
      alarm.evidence);
  if (!alarm.is_calibrated) {
    sentence +=
        " The earlier forecasts did not match their own bands, so false alarms are more frequent "
        "than stated.";
  }
  return sentence;
}

std::string alarm_cost_words(const drift::SiteDrift& drift,
                             const drift::ExplainedAlarm& explained) {
  const drift::FollowedOutput& output =
      drift.outputs[static_cast<std::size_t>(explained.alarm.output)];
  const bool is_peak = output.name.ends_with("_peak_kW");
  const auto words = [&](double amount, std::string_view period) {
    const auto times = [&](const std::optional<double>& rate) {
      return rate ? std::optional{*rate * amount} : std::nullopt;
    };
    return is_peak ? cost_words(times(output.rates.per_kW_month), {}, drift.currency, period)
                   : cost_words(times(output.rates.per_kWh),
                                times(output.rates.emissions_kg_per_kWh), drift.currency, period);
  };
  const Added added = added_by(drift, explained, is_peak);
  std::string sentences = words(added.so_far, period_words(explained));
  const std::string of_a_year = added.a_year ? words(*added.a_year, "a year") : std::string{};
  if (of_a_year.empty()) return sentences;
  if (!sentences.empty()) sentences += " ";
  return sentences + "If it goes on, " + display::uncapitalised(of_a_year);
}

std::string cause_words(const drift::SiteDrift& drift, const drift::Cause& cause) {
  const auto at = static_cast<std::size_t>(cause.index);
  switch (cause.kind) {
    case drift::CauseKind::nothing:
      return "chance: nothing has changed";
    case drift::CauseKind::unknown:
      if (cause.index < 0) return "something missing from the model";
      return fmt::format("something missing from the model that only {} shows",
                         display::id_words(drift.outputs[at].meter));
    case drift::CauseKind::parameter: {
      const display::Unit unit = display::unit_of(drift.units, drift.parameters[at].unit);
      return fmt::format("{} has been {:.3g}{}{} since then (90 %: {:.3g} to {:.3g})",
                         display::parameter_words(drift.parameters[at].name),
                         unit.shown(cause.mean), unit.name.empty() ? "" : " ", unit.name,
                         unit.shown(cause.q05), unit.shown(cause.q95));
    }
    case drift::CauseKind::direction:
      return fmt::format("{} has changed by {:+.0f} % since then (90 %: {:+.0f} to {:+.0f} %)",
                         drift.directions[at].name, 100.0 * (cause.mean - 1.0),
                         100.0 * (cause.q05 - 1.0), 100.0 * (cause.q95 - 1.0));
    case drift::CauseKind::meter:
      return fmt::format(
          "the {} meter shows {:.3g} times what it should (90 %: {:.3g} to {:.3g}){}",
          display::id_words(drift.outputs[at].meter), cause.mean, cause.q05, cause.q95,
          cause.title.empty() ? "" : "; by its hours: " + cause.title);
    case drift::CauseKind::effect:
      return cause.title;
  }
  return "";
}

std::string advice_words(const drift::SiteDrift& drift, const drift::ExplainedAlarm& alarm) {
  std::string words = look_at_words(alarm.causes.front().kind);
  const bool is_open =
      alarm.consequence == drift::Consequence::none && alarm.causes.front().probability < kSettled;
  if (is_open) words += distinguishing_words(drift, alarm.causes) + wait_words(drift, alarm);
  return words;
}

std::string trust_words(const drift::SiteDrift& drift, std::size_t output) {
  const auto [inside, all] = inside_90(drift, output);
  if (all == 0) return "No month to compare with.";
  const auto& check = drift.outputs[output].state.calibration;
  return fmt::format("{} of {} months within the 90 % band; {}.", inside, all,
                     check ? fmt::format("check of the forecasts: p = {:.2g}", check->pvalue)
                           : "too few months since the last change to check");
}

std::string meter_change_words(const drift::MeterChange& change) {
  return change.sentence + (change.kind == drift::MeterChangeKind::unit
                                ? ". Its months since then are not compared."
                                : ". Check the meter and its connection.");
}

std::string explained_sentence(const drift::SiteDrift& drift, const drift::ExplainedAlarm& alarm) {
  std::string sentence = alarm_sentence(drift, alarm.alarm);
  if (const std::string cost = alarm_cost_words(drift, alarm); !cost.empty()) {
    sentence += " " + cost;
  }
  if (alarm.causes.empty())
    return sentence + " The record before the change is too short to say why.";
  const drift::Cause& first = alarm.causes.front();
  const drift::Cause& second = alarm.causes[1];
  sentence += fmt::format(" Likeliest cause ({:.0f} %): {}", 100.0 * first.probability,
                          cause_words(drift, first));
  if (second.probability >= 0.1) {
    sentence += fmt::format("; next ({:.0f} %): {}", 100.0 * second.probability,
                            cause_words(drift, second));
  }
  return sentence + ". " + advice_words(drift, alarm);
}

std::string drift_words(const drift::SiteDrift& drift) {
  std::string words =
      fmt::format("{} months from {} to {}; the first {} are for learning.\n", drift.months.size(),
                  drift.months.front(), drift.months.back(), drift.learning_months);
  for (std::size_t k = 0; k < drift.outputs.size(); ++k) {
    words += fmt::format("{:<36} {}\n",
                         display::capitalised(display::output_words(drift.outputs[k].name)),
                         trust_words(drift, k));
  }
  for (const drift::ExplainedAlarm& alarm : drift.alarms) {
    words += explained_sentence(drift, alarm) + "\n";
  }
  if (drift.alarms.empty()) words += "No alarm.\n";
  for (const drift::MeterChange& change : drift.meter_changes) {
    words += meter_change_words(change) + "\n";
  }
  for (std::size_t j = 0; j < drift.last_year.size(); ++j) {
    const drift::Shift& shift = drift.last_year[j];
    const drift::ParameterPath& path = drift.windows.front().paths[j];
    const display::Unit unit = display::unit_of(drift.units, drift.parameters[j].unit);
    words += fmt::format(
        "{:<36} {:.4g}{}{}; change from the year before last to last year {:+.2f} sd (p {:.2f})\n",
        display::capitalised(display::parameter_words(drift.parameters[j].name)),
        unit.shown(path.mean.back()), unit.name.empty() ? "" : " ", unit.name, shift.standardised,
        shift.pvalue);
  }
  return words + display::warning_lines(drift.warnings);
}

}  // namespace recald::views
