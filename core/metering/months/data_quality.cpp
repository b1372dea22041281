#include "core/metering/months/data_quality.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <map>

namespace recald::metering {
namespace {

constexpr std::chrono::hours kLongZeroRun{72};
constexpr int kMonthsNamed = 2;  // a line of a terminal has room for; tables have them all

std::string span_words(const TimeSpan& span) {
  const double length_h = static_cast<double>(span.length().count()) / 3600.0;
  std::array<char, 32> text{};
  if (length_h < 1.0) {
    std::snprintf(text.data(), text.size(), "%.0f minutes", 60.0 * length_h);
  } else if (length_h == 1.0) {
    return "1 hour";
  } else if (length_h < 72.0) {
    std::snprintf(text.data(), text.size(), "%.4g hours", length_h);
  } else {
    std::snprintf(text.data(), text.size(), "%.1f days", length_h / 24.0);
  }
  return text.data();
}

/// "2017-11-21 09:00" in local time.
std::string local_words(Instant t, const LocalCalendar& calendar) {
  const LocalTime local = calendar.local_time(t);
  std::array<char, 16> clock{};
  std::snprintf(clock.data(), clock.size(), " %02d:%02d", local.minute_of_day / 60,
                local.minute_of_day % 60);
  return to_string(local.date) + clock.data();
}

std::string plural(int count, std::string_view one, std::string_view many) {
  return std::to_string(count) + " " + std::string{count == 1 ? one : many};
}

/// The meaning of a set of reasons for the person responsible for the meter.
std::string reason_words(const Episode& episode, bool is_rated) {
  const Reason r = episode.reasons;
  if (!episode.suspect && r == Reason::none) return "without readings";
  std::string words;
  const auto add = [&](Reason reason, std::string_view text) {
    if (!has(r, reason)) return;
    words += words.empty() ? "" : ", ";
    words += text;
  };
  add(Reason::zero_run,
      "exactly zero for longer than this meter's load can be, treated as no data");
  add(Reason::stuck, "frozen at one value");
  add(Reason::negative, "negative, which this meter cannot be");
  add(Reason::range, is_rated ? "beyond what this meter can measure"
                              : "far above all others, and no rated_kW says that they can be");
  add(Reason::spike, "single values far above the rest of their day");
  add(Reason::nan, "listed as blank by the source");
  add(Reason::mismatch, "given twice with different values");
  add(Reason::jump, "not counted after a jump of the register");
  add(Reason::reset, "not counted around a reset of the register");
  add(Reason::wrap, "not counted because the register may have rolled over");
  if (words.empty()) words = to_string(r);
  return words;
}

DataFinding describe_kind(std::string_view meter, const std::vector<Episode>& alike,
                          const LocalCalendar& calendar, bool is_rated) {
  int slots = 0;
  for (const Episode& episode : alike) slots += episode.slots;
  const Episode& longest = *std::ranges::max_element(alike, {}, &Episode::slots);
  std::string sentence =
      plural(slots, "interval ", "intervals ") + reason_words(alike.front(), is_rated);
  sentence += alike.size() == 1
                  ? ", in one stretch of "
                  : ", in " + std::to_string(alike.size()) + " stretches, the longest of ";
  sentence += span_words(longest.span) + " from " + local_words(longest.span.begin, calendar) + ".";
  return {std::string{meter},
          sentence,
          {alike.front().span.begin, alike.back().span.end},
          slots,
          alike.front().suspect ? DataFinding::Grade::warning : DataFinding::Grade::note};
}

void describe_unusable(std::string_view meter, const std::vector<MonthlyFigure>& figures,
                       const LocalCalendar& calendar, std::vector<DataFinding>& findings) {
  std::string months;
  const MonthlyFigure* first = nullptr;
  const MonthlyFigure* last = nullptr;
  int count = 0;
  int slots = 0;
  for (const MonthlyFigure& figure : figures) {
    if (figure.usable) continue;
    if (++count <= kMonthsNamed) {
      months += (months.empty() ? "" : ", ") + to_string(figure.month) + " (" +
                figure.unusable_because + ")";
    }
    if (first == nullptr) first = &figure;
    last = &figure;
    slots += figure.slots;
  }
  if (first == nullptr) return;
  if (count > kMonthsNamed) months += " and " + std::to_string(count - kMonthsNamed) + " more";
  findings.push_back(
      {std::string{meter},
       "Not used for calibration, too few readings: " + months + ".",
       {calendar.month_span(first->month).begin, calendar.month_span(last->month).end},
       slots,
       DataFinding::Grade::warning});
}

/// Removes the meter's name from the start, because a finding shows it beside its sentence.
std::string without_name(std::string words, std::string_view meter) {
  if (words.starts_with(meter) && words.size() > meter.size() + 1) {
    words.erase(0, meter.size() + 1);
    words.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(words.front())));
  }
  return words.ends_with('.') ? words : words + ".";
}

void describe_changes(std::string_view meter, const std::vector<MonthlyFigure>& figures,
                      const std::vector<LevelChange>& changes, const LocalCalendar& calendar,
                      std::vector<DataFinding>& findings) {
  for (const LevelChange& change : changes) {
    const Instant begin = calendar.month_span(change.since).begin;
    const Instant end = change.back_since ? calendar.month_span(*change.back_since).begin
                                          : calendar.month_span(figures.back().month).end;
    int slots = 0;
    for (const MonthlyFigure& figure : figures) {
      if (figure.month >= change.since &&
          (!change.back_since || figure.month < *change.back_since)) {
        slots += figure.slots;
      }
    }
    findings.push_back({std::string{meter},
                        without_name(change.words, meter),
                        {begin, end},
                        slots,
                        DataFinding::Grade::warning});
  }
}

void describe_counts(std::string_view meter, const MeterCounts& counts,
                     std::vector<DataFinding>& findings) {
  const auto add = [&](std::int64_t count, std::string_view words) {
    if (count == 0) return;
    findings.push_back(
        {std::string{meter},
         plural(static_cast<int>(count), "reading ", "readings ") + std::string{words},
         {},
         static_cast<int>(count),
         DataFinding::Grade::warning});
  };
  add(counts.conflicts, "came again with another value (the first is kept and marked suspect).");
  add(counts.duplicates, "came twice with the same value (counted once).");
  add(counts.late, "came after the month had closed (the month was reopened).");
  add(counts.too_late, "came for a month that is no longer open (refused).");
  add(counts.off_grid, "did not start on a boundary of the meter's intervals (refused).");
  add(counts.stray, "had a time stamp far from all others (refused).");
}

}  // namespace

std::vector<Episode> find_episodes(const MonthSlots& month) {
  std::vector<Episode> episodes;
  for (int slot = 0; slot < month.slots(); ++slot) {
    if (month.has_energy(slot)) continue;
    const auto i = static_cast<std::size_t>(slot);
    const TimeSpan span{month.grid->start(slot), month.grid->start(slot) + month.grid->interval()};
    const bool suspect = month.validity[i] == Validity::suspect;
    if (!episodes.empty() && episodes.back().span.end == span.begin &&
        episodes.back().suspect == suspect && episodes.back().reasons == month.reasons[i]) {
      episodes.back().span.end = span.end;
      episodes.back().slots += 1;
    } else {
      episodes.push_back({span, 1, suspect, month.reasons[i]});
    }
  }
  return episodes;
}

std::vector<Episode> join_episodes(std::vector<Episode> episodes) {
  std::vector<Episode> joined;
  for (const Episode& episode : episodes) {
    if (!joined.empty() && joined.back().span.end == episode.span.begin &&
        joined.back().suspect == episode.suspect && joined.back().reasons == episode.reasons) {
      joined.back().span.end = episode.span.end;
      joined.back().slots += episode.slots;
    } else {
      joined.push_back(episode);
    }
  }
  return joined;
}

std::vector<TimeSpan> find_believed_zero_runs(const MonthSlots& month) {
  std::vector<TimeSpan> runs;
  for (int slot = 0; slot < month.slots(); ++slot) {
    if (!month.is_ok(slot) || month.measured_kW[static_cast<std::size_t>(slot)] != 0.0) continue;
    const TimeSpan span{month.grid->start(slot), month.grid->start(slot) + month.grid->interval()};
    if (!runs.empty() && runs.back().end == span.begin) {
      runs.back().end = span.end;
    } else {
      runs.push_back(span);
    }
  }
  return runs;
}

std::vector<DataFinding> describe_data(std::string_view meter, const std::vector<Episode>& episodes,
                                       const std::vector<TimeSpan>& zero_runs,
                                       const std::vector<MonthlyFigure>& figures,
                                       const std::vector<LevelChange>& changes,
                                       const MeterCounts& counts, const LocalCalendar& calendar,
                                       bool is_rated) {
  std::vector<DataFinding> findings;
  describe_changes(meter, figures, changes, calendar, findings);
  describe_unusable(meter, figures, calendar, findings);

  std::map<std::pair<bool, std::uint32_t>, std::vector<Episode>> kinds;
  for (const Episode& episode : episodes) {
    kinds[{!episode.suspect, static_cast<std::uint32_t>(episode.reasons)}].push_back(episode);
  }
  for (const auto& [kind, alike] : kinds) {
    findings.push_back(describe_kind(meter, alike, calendar, is_rated));
  }

  for (const TimeSpan& run : zero_runs) {
    if (run.length() < kLongZeroRun) continue;
    findings.push_back({std::string{meter},
                        "Exactly zero for " + span_words(run) + " from " +
                            local_words(run.begin, calendar) +
                            ": treated as a load of zero. If it means no data, set zero_run_max.",
                        run, 0, DataFinding::Grade::warning});
  }
  describe_counts(meter, counts, findings);
  return findings;
}

}  // namespace recald::metering
