#include "simulators/scenario/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace recald::simulators {
namespace {

tl::unexpected<Error> refuse(std::string sentence) {
  return failure(ErrorCode::invalid_value, std::move(sentence));
}

bool has_heat_meter(const Drawings& drawings) {
  return drawings.heating != HeatingPlant::heat_pump;
}

bool has_chilled_water_meter(const Drawings& drawings) {
  return drawings.cooling != CoolingPlant::packaged;
}

/// What the building lacks for the effect, as the end of a sentence; empty if nothing is missing.
std::string missing_for(const EffectNeeds& needs, const Drawings& drawings) {
  const auto lacks = [](bool needed, bool there) { return needed && !there; };
  if (lacks(needs.heat_meter, has_heat_meter(drawings))) {
    return "a heat meter, and a heat pump's heat is not metered: choose another [plant] heating";
  }
  if (lacks(needs.cooling_meter, has_chilled_water_meter(drawings))) {
    return "a chilled-water meter, and packaged units have none: choose another [plant] cooling";
  }
  if (lacks(needs.timetable, !drawings.never_stops())) {
    return "air handlers that stop at night: choose another use in [building]";
  }
  if (lacks(needs.own_chiller, drawings.cooling == CoolingPlant::chiller)) {
    return "an own chiller: set cooling = \"chiller\" in [plant]";
  }
  if (lacks(needs.heat_pump, drawings.heating == HeatingPlant::heat_pump)) {
    return "a heat pump: set heating = \"heat_pump\" in [plant]";
  }
  if (lacks(needs.fuel, drawings.heating == HeatingPlant::boiler)) {
    return "a gas meter: set heating = \"boiler\" in [plant]";
  }
  if (lacks(needs.economiser, drawings.economiser_limit_C.has_value())) {
    return "an economiser: set economiser_limit_C in [controls]";
  }
  if (lacks(needs.skylight, drawings.skylight_m2() > 0.0)) {
    return "a skylight: set skylight_share in [building]";
  }
  return "";
}

Result<void> check_dates(const HiddenChoice& choice, const Period& period) {
  const EffectKind& kind = *choice.kind;
  if (kind.dated && !choice.from) {
    return refuse(fmt::format("effect {} begins at a date: give from = \"YYYY-MM-DD\"", kind.id));
  }
  if (choice.from && choice.to && *choice.to < *choice.from) {
    return refuse(fmt::format("effect {}: to {} lies before from {}", kind.id,
                              metering::to_string(*choice.to), metering::to_string(*choice.from)));
  }
  const int last_year = period.start_year + period.years - 1;
  const bool after_all = choice.from && static_cast<int>(choice.from->year()) > last_year;
  const bool before_all = choice.to && static_cast<int>(choice.to->year()) < period.start_year;
  if (after_all || before_all) {
    return refuse(fmt::format("effect {} lies outside the period {} to {}", kind.id,
                              period.start_year, last_year));
  }
  return {};
}

Result<void> check_alone(const HiddenChoice& choice, const Drawings& drawings) {
  const EffectKind& kind = *choice.kind;
  if (!(choice.strength >= kind.strength.min && choice.strength <= kind.strength.max)) {
    return refuse(fmt::format("effect {}: strength {} is outside {} to {} ({})", kind.id,
                              choice.strength, kind.strength.min, kind.strength.max,
                              kind.strength.unit));
  }
  if (const std::string missing = missing_for(kind.needs, drawings); !missing.empty()) {
    return refuse(fmt::format("effect {} needs {}", kind.id, missing));
  }
  if (kind.of_one_meter && !choice.meter) {
    return refuse(
        fmt::format("effect {} is in one meter: give meter = \"electricity\" or another", kind.id));
  }
  if (choice.meter && !kind.of_one_meter) {
    return refuse(fmt::format("effect {} is not in one meter: leave meter out", kind.id));
  }
  if (choice.meter == Utility::heat && !has_heat_meter(drawings)) {
    return refuse(fmt::format("effect {}: this building has no heat meter", kind.id));
  }
  if (choice.meter == Utility::cooling && !has_chilled_water_meter(drawings)) {
    return refuse(fmt::format("effect {}: this building has no chilled-water meter", kind.id));
  }
  return {};
}

/// Two effects must not change the same thing, unless on two different meters.
bool contradict(const HiddenChoice& one, const HiddenChoice& other) {
  const bool of_other_meters = one.meter && other.meter && *one.meter != *other.meter;
  return one.kind->turns == other.kind->turns && !of_other_meters;
}

/// FNV-1a of the name, so that this effect's random stream does not depend on other effects.
std::uint64_t number_of(const EffectKind& kind) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : kind.id) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  }
  return hash >> 1U;  // leaves room for the offset of the streams
}

}  // namespace

Result<void> check_effects(const Scenario& scenario) {
  for (std::size_t i = 0; i < scenario.effects.size(); ++i) {
    const HiddenChoice& choice = scenario.effects[i];
    if (const auto alone = check_alone(choice, scenario.drawings); !alone) return alone;
    if (const auto dated = check_dates(choice, scenario.period); !dated) return dated;
    for (std::size_t j = 0; j < i; ++j) {
      const HiddenChoice& earlier = scenario.effects[j];
      if (!contradict(choice, earlier)) continue;
      return refuse(
          fmt::format("effects {} and {} contradict each other: both turn {}; leave one out",
                      earlier.kind->id, choice.kind->id, choice.kind->turns));
    }
  }
  return {};
}

HiddenEffects make_effects(const Scenario& scenario, std::uint64_t seed,
                           const metering::LocalCalendar& calendar) {
  HiddenEffects effects;
  for (const HiddenChoice& choice : scenario.effects) {
    effects.push_back(make(*choice.kind,
                           {.strength = choice.strength,
                            .from = choice.from,
                            .to = choice.to,
                            .meter = choice.meter,
                            .calendar = &calendar,
                            .rng = stream_of(seed, Stream::effects, number_of(*choice.kind))},
                           scenario.drawings));
  }
  return effects;
}

std::string_view to_string(Decoy decoy) {
  return decoy == Decoy::wind_of_another_year ? "wind_of_another_year" : "neighbour_meter";
}

bool has_decoy(const Scenario& scenario, Decoy decoy) {
  return std::ranges::find(scenario.decoys, decoy) != scenario.decoys.end();
}

}  // namespace recald::simulators
