#include "tests/blind/scoring/drift_scores.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace recald::blind {
namespace {

constexpr std::string_view kMeters = "meters";
constexpr double kSureCause = 0.8;

/// Effects that a parameter of the model stands for.
struct Stands {
  std::string_view effect;
  std::string_view parameter;
};
constexpr auto kParameters = std::to_array<Stands>({
    {"outdoor_air_amount", "outdoor_airflow"},
    {"demand_ventilation", "outdoor_airflow"},
    {"night_setback_missing", "heating_setpoint"},
    {"setpoint_raised", "heating_setpoint"},
    {"setpoint_raised", "cooling_setpoint"},
    {"vacancy", "occupancy_density"},
    {"hybrid_work", "occupancy_density"},
    {"chiller_part_load", "cooling_cop"},
    {"solar_gain_change", "shgc_scale"},
    {"wind_infiltration", "leakage_area"},
    {"stack_infiltration", "leakage_area"},
    {"seasonal_hot_water", "hot_water_volume"},
    {"steam_trap_leak", "base_heat"},
    {"ground_coupling", "ground_temperature"},
    {"thermal_mass", "specific_heat_scale"},
});

/// Effects that are loads of electricity, in the rooms or beside them.
constexpr auto kUses = std::to_array<std::string_view>(
    {"plug_growth", "equipment_step", "server_room", "exterior_lighting", "vacancy", "hybrid_work",
     "after_hours", "weekend_operation", "missing_holidays", "semester_calendar", "ev_charging",
     "solar_panels", "irrigation_pumps", "cooking", "event_evenings", "data_backup_nights"});

bool is_use(std::string_view effect) { return std::ranges::find(kUses, effect) != kUses.end(); }

bool stands_for(std::string_view effect, std::string_view parameter) {
  return std::ranges::any_of(kParameters, [&](const Stands& stands) {
    return stands.effect == effect && stands.parameter == parameter;
  });
}

/// Both are the same thing to a person who looks for it.
bool are_of_a_kind(std::string_view effect, std::string_view other) {
  return effect == other || (is_use(effect) && is_use(other)) ||
         std::ranges::any_of(kParameters, [&](const Stands& stands) {
           return stands.effect == effect && stands_for(other, stands.parameter);
         });
}

/// Months from the first to the second, both "2022-03…".
int months_between(std::string_view from, std::string_view to) {
  const auto count = [](std::string_view month) {
    return 12 * std::atoi(std::string(month.substr(0, 4)).c_str()) +
           std::atoi(std::string(month.substr(5, 2)).c_str());
  };
  return count(to) - count(from);
}

const HiddenEffect* dated_effect(const Answer& answer, const Drift& drift) {
  if (answer.effects.size() != 1 || !answer.effects.front().from) return nullptr;
  const HiddenEffect& hidden = answer.effects.front();
  const bool is_watched =
      months_between(drift.from, *hidden.from) >= 0 && months_between(*hidden.from, drift.to) >= 0;
  return is_watched ? &hidden : nullptr;
}

struct Count {
  int hits = 0;
  int of = 0;
  void add(bool hit) {
    hits += hit ? 1 : 0;
    ++of;
  }
  [[nodiscard]] std::optional<Score> score() const { return share_score(hits, of); }
};

}  // namespace

Drifts drifts_of(std::span<const CaseResult> results) {
  Drifts drifts;
  for (const CaseResult& result : results) {
    if (result.method == kDrift && result.drift) drifts[result.case_id] = *result.drift;
  }
  return drifts;
}

bool is_right_cause(const HiddenEffect& hidden, const DriftCause& cause) {
  if (hidden.effect_class == kMeters) {
    Answer alone;
    alone.effects = {hidden};
    return cause.kind == "meter" && cause.subject.starts_with(most_affected_meter(alone));
  }
  if (cause.kind == "effect") return are_of_a_kind(hidden.effect, cause.subject);
  if (cause.kind == "parameter") return stands_for(hidden.effect, cause.subject);
  if (cause.kind == "use") return is_use(hidden.effect);
  const bool has_parameter =
      std::ranges::find(kParameters, hidden.effect, &Stands::effect) != kParameters.end();
  return cause.kind == "unknown" && !has_parameter && !is_use(hidden.effect);
}

bool is_right_side(const HiddenEffect& hidden, const DriftCause& cause) {
  if (cause.kind == "nothing") return false;
  return (hidden.effect_class == kMeters) == (cause.kind == "meter");
}

DriftScores drift_scores(const ScoredCases& cases, const Drifts& drifts) {
  Count found, large, early, right, side, sure, false_alarms;
  std::vector<double> delays;
  for (const ScoredCase& scored : cases) {
    const auto followed = drifts.find(scored.answer->case_id);
    if (followed == drifts.end()) continue;
    const Drift& drift = followed->second;
    if (scored.answer->effects.empty()) false_alarms.add(!drift.alarms.empty());
    const HiddenEffect* const hidden = dated_effect(*scored.answer, drift);
    if (hidden == nullptr) continue;
    const DriftCause* first = nullptr;
    bool is_early = false;
    for (const DriftCause& alarm : drift.alarms) {
      const int after = months_between(*hidden->from, alarm.month);
      is_early |= after < 0;
      if (after < 0 || (first != nullptr && months_between(first->month, alarm.month) >= 0))
        continue;
      first = &alarm;
    }
    early.add(is_early);
    found.add(first != nullptr);
    if (is_large(*scored.answer)) large.add(first != nullptr);
    if (first == nullptr) continue;
    delays.push_back(months_between(*hidden->from, first->month));
    const bool is_right = is_right_cause(*hidden, *first);
    right.add(is_right);
    side.add(is_right_side(*hidden, *first));
    if (first->probability >= kSureCause) sure.add(is_right);
  }
  return {.found = found.score(),
          .found_large = large.score(),
          .delay_months = median_score(std::move(delays)),
          .early = early.score(),
          .cause_right = right.score(),
          .side_right = side.score(),
          .sure_right = sure.score(),
          .false_alarms = false_alarms.score()};
}

}  // namespace recald::blind
