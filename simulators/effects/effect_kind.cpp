#include "simulators/effects/effect_kind.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace recald::simulators {

std::string_view to_string(EffectClass group) {
  switch (group) {
    case EffectClass::schedules:
      return "schedules";
    case EffectClass::outdoor_air:
      return "outdoor_air";
    case EffectClass::air_system:
      return "air_system";
    case EffectClass::envelope:
      return "envelope";
    case EffectClass::plant:
      return "plant";
    case EffectClass::electrical:
      return "electrical";
    case EffectClass::meters:
      return "meters";
    case EffectClass::operators:
      return "operators";
    case EffectClass::outside_catalogue:
      return "outside_catalogue";
  }
  return "";
}

namespace {

class Stateless final : public EffectWithSettings {
 public:
  Stateless(const EffectKind& kind, const EffectSettings& settings, const Drawings& drawings)
      : EffectWithSettings(settings, drawings), operate_(kind.operate) {}

  void operate(const Moment& now, Operation& operation) override {
    if (settings_.covers(now.local.date)) operate_(settings_, now, operation);
  }

 private:
  void (*operate_)(const EffectSettings&, const Moment&, Operation&);
};

std::string needs_in_words(const EffectKind& kind) {
  const EffectNeeds& needs = kind.needs;
  std::string words;
  const auto add = [&](bool needed, std::string_view what) {
    if (needed) words += (words.empty() ? "" : ", ") + std::string(what);
  };
  add(needs.cooling_meter, "chilled-water meter");
  add(needs.heat_meter, "heat meter");
  add(needs.own_chiller, "own chiller");
  add(needs.heat_pump, "heat pump");
  add(needs.fuel, "gas boiler");
  add(needs.economiser, "economiser");
  add(needs.timetable, "rooms that stop at night");
  add(needs.skylight, "skylight");
  add(kind.dated, "from = \"YYYY-MM-DD\"");
  add(kind.of_one_meter, "meter = \"electricity\" or another");
  return words;
}

}  // namespace

std::unique_ptr<HiddenEffect> make(const EffectKind& kind, const EffectSettings& settings,
                                   const Drawings& drawings) {
  if (kind.make != nullptr) return kind.make(settings, drawings);
  return std::make_unique<Stateless>(kind, settings, drawings);
}

std::string explain(const EffectKind& kind) {
  std::string text =
      fmt::format("{} ({}): {}\n  {}\n  strength {:g} to {:g}, typically {:g} ({})\n", kind.id,
                  to_string(kind.group), kind.title, kind.sentence, kind.strength.min,
                  kind.strength.max, kind.strength.typical, kind.strength.unit);
  const std::string needs = needs_in_words(kind);
  return needs.empty() ? text : text + "  needs: " + needs + "\n";
}

const EffectKind* find_effect_kind(std::string_view id) {
  const auto kinds = effect_kinds();
  const auto found = std::ranges::find(kinds, id, &EffectKind::id);
  return found == kinds.end() ? nullptr : &*found;
}

}  // namespace recald::simulators
