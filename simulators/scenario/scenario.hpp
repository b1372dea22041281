/// One building as described by a scenario: its design, place, period and hidden effects.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "simulators/effects/effect_kind.hpp"
#include "simulators/feed/meters.hpp"

namespace recald::simulators {

struct HiddenChoice {
  const EffectKind* kind;
  double strength;
  std::optional<metering::Day> from;
  std::optional<metering::Day> to;
  std::optional<Utility> meter;
};

/// Columns that look relevant and are not.
enum class Decoy {
  wind_of_another_year,  ///< The weather file's wind is that of another year of the same climate.
  neighbour_meter,       ///< The readings hold a meter of the building next door.
};

struct Scenario {
  Drawings drawings;
  Period period;
  std::chrono::seconds step = kStep;
  MeterCare care = MeterCare::usual;
  std::vector<HiddenChoice> effects;
  std::vector<Decoy> decoys;
};

/// Checks that the effects are possible, alone and together.
/// @return invalid_input: a strength out of range, something that an effect needs and the building
///         lacks, a missing date, two effects that contradict each other.
[[nodiscard]] Result<void> check_effects(const Scenario& scenario);

/// Creates the effects, each with its own random stream.
/// @param calendar  Must outlive them.
[[nodiscard]] HiddenEffects make_effects(const Scenario& scenario, std::uint64_t seed,
                                         const metering::LocalCalendar& calendar);

[[nodiscard]] std::string_view to_string(Decoy decoy);
[[nodiscard]] bool has_decoy(const Scenario& scenario, Decoy decoy);

}  // namespace recald::simulators
