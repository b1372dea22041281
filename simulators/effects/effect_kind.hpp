/// The kinds of hidden effects: their names, needs and strengths.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulators/building/drawings.hpp"
#include "simulators/building/hidden_effect.hpp"

namespace recald::simulators {

enum class EffectClass {
  schedules,
  outdoor_air,
  air_system,
  envelope,
  plant,
  electrical,
  meters,
  operators,          ///< Equivalent to a calibration parameter: a drift, not a missing effect.
  outside_catalogue,  ///< Real, but unknown to the diagnosis.
};

[[nodiscard]] std::string_view to_string(EffectClass group);

/// Strength 0 means absent. At `typical`, an engineer would call the effect obvious.
struct StrengthRange {
  double min;
  double typical;
  double max;
  std::string_view unit;
};

/// What a building must have for the effect to exist and to be visible.
struct EffectNeeds {
  bool cooling_meter = false;
  bool heat_meter = false;
  bool own_chiller = false;
  bool heat_pump = false;
  bool fuel = false;  ///< A boiler's gas meter.
  bool economiser = false;
  bool timetable = false;  ///< Rooms whose air handlers stop at night.
  bool skylight = false;
};

/// One effect of one scenario.
struct EffectSettings {
  double strength = 0.0;
  std::optional<metering::Day> from;  ///< First local day; absent: from the beginning.
  std::optional<metering::Day> to;    ///< Last local day; absent: to the end.
  std::optional<Utility> meter;       ///< For effects of one meter.
  const metering::LocalCalendar* calendar = nullptr;
  Rng rng{0, 0};  ///< The effect's own random stream.

  /// Whether the effect is active on this day.
  [[nodiscard]] bool covers(metering::Day day) const {
    return (!from || day >= *from) && (!to || day <= *to);
  }
};

/// Defined with designated initialisers in the effect's own file.
struct EffectKind {
  std::string_view id;     ///< snake_case, as in scenario files and answers.
  std::string_view title;  ///< "Night set-back missing".
  EffectClass group;
  std::string_view sentence;  ///< For people who run the building: what happens and what shows.
  StrengthRange strength;
  EffectNeeds needs = {};
  /// What it changes; two effects that change the same thing contradict each other.
  std::string_view turns;
  bool dated = false;           ///< Starts (or is confined) at a date: scenarios give `from`.
  bool of_one_meter = false;    ///< Scenarios give `meter`.
  bool all_or_nothing = false;  ///< Present or absent: populations do not scale it.
  /// Of an effect without state: its change of a step, on the days that its settings cover.
  void (*operate)(const EffectSettings&, const Moment&, Operation&) = nullptr;
  /// Of every other.
  std::unique_ptr<HiddenEffect> (*make)(const EffectSettings&, const Drawings&) = nullptr;
};

/// The base of effects that have a state or another hook than `operate`.
class EffectWithSettings : public HiddenEffect {
 public:
  EffectWithSettings(const EffectSettings& settings, const Drawings& /*drawings*/)
      : settings_(settings) {}

 protected:
  EffectSettings settings_;
};

/// Makes `EffectKind::make` for an effect constructed from its settings and the drawings.
template <class Effect>
std::unique_ptr<HiddenEffect> make_effect(const EffectSettings& settings,
                                          const Drawings& drawings) {
  return std::make_unique<Effect>(settings, drawings);
}

/// The effect of one scenario, whichever of the two its kind has.
[[nodiscard]] std::unique_ptr<HiddenEffect> make(const EffectKind& kind,
                                                 const EffectSettings& settings,
                                                 const Drawings& drawings);

/// The text of `--list-effects` for one kind: name, class, sentence, strengths, needs.
[[nodiscard]] std::string explain(const EffectKind& kind);

/// All kinds, by class and then by id. Each is defined in the file of its name.
[[nodiscard]] std::span<const EffectKind> effect_kinds();
/// @return nullptr if no effect has this id.
[[nodiscard]] const EffectKind* find_effect_kind(std::string_view id);

}  // namespace recald::simulators
