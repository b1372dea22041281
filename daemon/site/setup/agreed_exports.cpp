#include "daemon/site/setup/agreed_exports.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "daemon/site/setup/clock_evidence.hpp"

namespace recald::daemon {
namespace {

using Kind = std::vector<std::size_t>;  // exports that are written alike

bool are_alike(const SurveyedExport& a, const SurveyedExport& b) {
  if (!a.table || !b.table) return false;
  const table::TableShape& one = a.table->shape;
  const table::TableShape& other = b.table->shape;
  return one.container == other.container && one.layout == other.layout &&
         one.separator == other.separator && one.time_column == other.time_column &&
         one.clock_column == other.clock_column && one.meter_column == other.meter_column &&
         one.unit_column == other.unit_column;
}

std::vector<Kind> kinds_of(std::span<const SurveyedExport> exports) {
  std::vector<Kind> kinds;
  for (std::size_t i = 0; i < exports.size(); ++i) {
    const auto known = std::ranges::find_if(
        kinds, [&](const Kind& kind) { return are_alike(exports[kind.front()], exports[i]); });
    if (known != kinds.end()) {
      known->push_back(i);
    } else {
      kinds.push_back({i});
    }
  }
  return kinds;
}

/// What those agree on that are certain; nothing where none is, or two contradict each other.
template <class T, class IsCertain, class ValueOf>
std::optional<T> certain_value(std::span<const SurveyedExport> exports, const Kind& kind,
                               IsCertain is_certain, ValueOf value_of) {
  std::optional<T> agreed;
  for (const std::size_t i : kind) {
    const table::TableGuess& guess = *exports[i].table;
    if (!is_certain(guess)) continue;
    if (agreed && *agreed != value_of(guess)) return {};
    agreed = value_of(guess);
  }
  return agreed;
}

void take_larger(table::ClockChange::Counts& known, const table::ClockChange::Counts& counts) {
  known.skipped = std::max(known.skipped, counts.skipped);
  known.skipped_ends = std::max(known.skipped_ends, counts.skipped_ends);
  known.first = std::max(known.first, counts.first);
  known.second = std::max(known.second, counts.second);
}

/// A clock that stays on winter time, by the changes of all files together.
struct JoinedClock {
  table::ClockFacts facts;
  std::optional<metering::TimeSpan> span;
  double per_hour = 1.0;
};

/// What all files of a kind show; nothing where a clock is known or stamps have offsets.
std::optional<JoinedClock> joined_clock(std::span<const SurveyedExport> exports, const Kind& kind) {
  JoinedClock joined;
  auto& [facts, span, per_hour] = joined;
  for (const std::size_t i : kind) {
    const SurveyedExport& one = exports[i];
    if (one.table->has_offsets || !one.table->shape.timezone.empty()) return {};
    for (const auto& [day, change] : one.clock.changes) {
      table::ClockChange& known = facts.changes[day];
      take_larger(known.rows, change.rows);
      take_larger(known.values, change.values);
    }
    facts.put_back.insert(one.clock.put_back.begin(), one.clock.put_back.end());
    for (const SurveyedMeter& meter : one.meters) {
      per_hour = 3600.0 / static_cast<double>(meter.interval.count());
      if (!span) span = meter.span;
      span->begin = std::min(span->begin, meter.span.begin);
      span->end = std::max(span->end, meter.span.end);
    }
  }
  return span ? std::optional{joined} : std::nullopt;
}

bool is_of_rows(const SurveyedMeter& meter) { return !meter.is_register; }

using MeterKey = std::pair<std::string, std::string>;  // row and column

std::uint64_t moves(const RegisterVerdict& verdict) { return verdict.rises + verdict.falls; }

/// Registers of a kind, as the file shows them that has most of each. What in a short file passes
/// for one is none if a much longer one shows amounts.
std::map<MeterKey, RegisterVerdict> registers_of(std::span<const SurveyedExport> exports,
                                                 const Kind& kind) {
  constexpr std::uint64_t kMuchLonger = 4;
  std::map<MeterKey, RegisterVerdict> known;
  std::map<MeterKey, std::uint64_t> amounts;  // how often they move in the longest file
  for (const std::size_t i : kind) {
    for (const SurveyedMeter& meter : exports[i].meters) {
      const RegisterVerdict& shown = meter.as_register;
      if (!meter.is_register) {
        std::uint64_t& most = amounts[{meter.name_in_file, meter.column}];
        most = std::max(most, moves(shown));
      }
      if (!meter.is_register || !shown.is_register) continue;
      const auto [at, is_new] = known.try_emplace({meter.name_in_file, meter.column}, shown);
      const double rated_kW = std::max(at->second.rated_kW, shown.rated_kW);
      if (moves(shown) > moves(at->second)) at->second = shown;
      at->second.rated_kW = rated_kW;
    }
  }
  for (auto& [key, shown] : known) {
    if (amounts[key] > kMuchLonger * moves(shown)) shown = {};
  }
  return known;
}

/// Whether a file is too short to contradict what another shows of the meter.
bool may_be_as(const SurveyedMeter& meter, const RegisterVerdict& shown) {
  constexpr std::uint64_t kFewFalls = 3;
  if (meter.is_told_kind) return false;
  if (!shown.is_register) return meter.is_register;
  if (meter.is_register) {
    return meter.as_register.resets != shown.resets && meter.as_register.falls <= kFewFalls;
  }
  return meter.as_register.falls <= kFewFalls;
}

/// What a clock column counts, as the days of 23 and 25 hours of some files show.
std::optional<table::ClockFormat> clock_format_of(std::span<const SurveyedExport> exports,
                                                  const Kind& kind) {
  std::optional<table::ClockFormat> agreed;
  for (const std::size_t i : kind) {
    if (!exports[i].clock_format_because.starts_with("as on")) continue;
    const table::ClockFormat shown = exports[i].table->shape.clock_format;
    if (agreed && *agreed != shown) return {};
    agreed = shown;
  }
  return agreed;
}

/// Gives a file hints where it has a clock column that counts, or registers.
template <class Hint>
void hint_of_rows(const SurveyedExport& one, const std::map<MeterKey, RegisterVerdict>& registers,
                  std::optional<table::ClockFormat> clock_format, Hint hint) {
  if (clock_format && one.table->labels_a_day > 0 &&
      one.table->shape.clock_format != *clock_format) {
    hint().clock_format = *clock_format;
  }
  for (const SurveyedMeter& meter : one.meters) {
    const MeterKey key{meter.name_in_file, meter.column};
    const auto known = registers.find(key);
    if (known == registers.end() || !may_be_as(meter, known->second)) continue;
    hint().registers[key] = known->second;
  }
}

void agree_on_stamps(std::span<SurveyedExport> exports, const Kind& kind) {
  std::array<int, 2> weights{};  // of starts and ends
  const SurveyedMeter* strongest = nullptr;
  for (const std::size_t i : kind) {
    for (const SurveyedMeter& meter : exports[i].meters) {
      if (!is_of_rows(meter)) continue;
      weights[meter.stamps.value == csv::Stamps::end ? 1 : 0] += meter.stamps_weight;
    }
  }
  if (weights[0] + weights[1] == 0) return;
  const csv::Stamps agreed = weights[1] > weights[0] ? csv::Stamps::end : csv::Stamps::start;
  for (const std::size_t i : kind) {
    for (const SurveyedMeter& meter : exports[i].meters) {
      if (!is_of_rows(meter) || meter.stamps.value != agreed) continue;
      if (strongest == nullptr || meter.stamps_weight > strongest->stamps_weight) {
        strongest = &meter;
      }
    }
  }
  Guess<csv::Stamps> stamps = strongest->stamps;
  if (weights[0] == weights[1]) stamps.because = "guessed; its files contradict each other";
  for (const std::size_t i : kind) {
    for (SurveyedMeter& meter : exports[i].meters) {
      if (!is_of_rows(meter) || meter.stamps_weight == kCertainStamps) continue;
      if (meter.stamps.value != agreed) {
        const auto shift = agreed == csv::Stamps::end ? -meter.interval : meter.interval;
        meter.span = {meter.span.begin + shift, meter.span.end + shift};
      }
      meter.stamps = stamps;
    }
  }
}

void agree_on_flags(std::span<SurveyedExport> exports, const Kind& kind) {
  std::string column;
  std::set<std::string> missing;
  std::set<std::string> estimated;
  for (const std::size_t i : kind) {
    const table::TableShape& shape = exports[i].table->shape;
    if (!shape.flag_column.empty()) column = shape.flag_column;
    missing.insert(shape.missing_flags.begin(), shape.missing_flags.end());
    estimated.insert(shape.estimated_flags.begin(), shape.estimated_flags.end());
  }
  if (column.empty()) return;
  for (const std::string& flag : missing) estimated.erase(flag);
  for (const std::size_t i : kind) {
    table::TableShape& shape = exports[i].table->shape;
    const bool has_it = exports[i].table->flag_column == column || shape.flag_column == column;
    if (!has_it) return;  // a file without the column cannot be read with it
  }
  for (const std::size_t i : kind) {
    table::TableShape& shape = exports[i].table->shape;
    shape.flag_column = column;
    shape.missing_flags.assign(missing.begin(), missing.end());
    shape.estimated_flags.assign(estimated.begin(), estimated.end());
  }
}

}  // namespace

std::vector<std::optional<SurveyHints>> hints_of_others(
    std::span<const SurveyedExport> exports, std::span<const SurveyHints> hints,
    const std::optional<metering::LocalCalendar>& calendar) {
  std::vector<std::optional<SurveyHints>> more(exports.size());
  const auto hint = [&](std::size_t i) -> SurveyHints& {
    if (!more[i]) more[i] = hints[i];
    return *more[i];
  };
  for (const Kind& kind : kinds_of(exports)) {
    if (kind.size() < 2 || !exports[kind.front()].table) continue;
    const auto dates = certain_value<table::TimeFormat>(
        exports, kind, [](const table::TableGuess& guess) { return !guess.is_time_format_open; },
        [](const table::TableGuess& guess) { return guess.shape.time_format; });
    const auto decimal = certain_value<char>(
        exports, kind,
        [](const table::TableGuess& guess) { return guess.decimal_because.starts_with("as in"); },
        [](const table::TableGuess& guess) { return guess.shape.decimal; });
    std::optional<std::string> because;
    std::optional<std::string> clock;
    const auto joined = joined_clock(exports, kind);
    if (joined && calendar && hints[kind.front()].clock.empty()) {
      because = fixed_clock_because(joined->facts, *joined->span, joined->per_hour, *calendar);
      if (because) clock = fixed_zone(*calendar, joined->span->begin);
    }
    const auto registers = registers_of(exports, kind);
    const auto clock_format = clock_format_of(exports, kind);
    for (const std::size_t i : kind) {
      hint_of_rows(exports[i], registers, clock_format, [&]() -> SurveyHints& { return hint(i); });
      const table::TableGuess& guess = *exports[i].table;
      if (dates && guess.is_time_format_open) hint(i).table.dates = *dates;
      if (decimal && guess.shape.decimal != *decimal) hint(i).table.decimal = *decimal;
      if (clock) {
        hint(i).clock = *clock;
        hint(i).clock_because = *because;
      }
    }
  }
  return more;
}

void ask_together(std::span<SurveyedExport> exports, std::span<const SurveyHints> hints,
                  const metering::LocalCalendar& calendar) {
  for (const Kind& kind : kinds_of(exports)) {
    if (kind.size() < 2 || !exports[kind.front()].table) continue;
    const auto joined = joined_clock(exports, kind);
    if (!joined || !hints[kind.front()].clock.empty()) continue;
    SurveyedExport& first = exports[kind.front()];
    const auto question = winter_time_question(first.files.front(), joined->facts, *joined->span,
                                               joined->per_hour, calendar);
    if (question) first.questions.push_back(*question);
  }
}

void agree(std::span<SurveyedExport> exports) {
  for (const Kind& kind : kinds_of(exports)) {
    if (kind.size() < 2 || !exports[kind.front()].table) continue;
    agree_on_stamps(exports, kind);
    agree_on_flags(exports, kind);
  }
}

}  // namespace recald::daemon
