/// One building as a scenario asks for it: what stands there, where, for how long, what is hidden.
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

/// Columns that look as if they mattered and do not.
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

/// Whether the effects can be there at all and together.
/// @return invalid_input: a strength out of range, something the effect needs that the building
///         lacks, a date that is missing, two effects that contradict each other.
[[nodiscard]] Result<void> check_effects(const Scenario& scenario);

/// The effects at work, each with a stream of chance of its own.
/// @param calendar must outlive them
[[nodiscard]] HiddenEffects make_effects(const Scenario& scenario, std::uint64_t seed,
                                         const metering::LocalCalendar& calendar);

[[nodiscard]] std::string_view to_string(Decoy decoy);
[[nodiscard]] bool has_decoy(const Scenario& scenario, Decoy decoy);

}  // namespace recald::simulators
