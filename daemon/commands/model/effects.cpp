#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "core/diagnosis/effects/support/effect.hpp"
#include "core/text/ascii.hpp"
#include "core/text/nearest.hpp"
#include "core/text/printable.hpp"
#include "daemon/commands/commands.hpp"

namespace recald::daemon {
namespace {

using diagnosis::Dating;
using diagnosis::Effect;
using diagnosis::EffectClass;
using diagnosis::EffectNeeds;

constexpr std::size_t kListColumns = 100;

constexpr std::array kClassesInOrder{std::pair{EffectClass::schedule, "Schedules and people"},
                                     std::pair{EffectClass::outdoor_air, "Outdoor air"},
                                     std::pair{EffectClass::air_system, "Air handlers and pumps"},
                                     std::pair{EffectClass::envelope, "Envelope"},
                                     std::pair{EffectClass::plant, "Heating and cooling plant"},
                                     std::pair{EffectClass::electrical, "Electrical loads"},
                                     std::pair{EffectClass::meter, "Meters"}};

std::string_view dating_words(Dating dating) {
  switch (dating) {
    case Dating::always:
      return "A property of the building, all the time.";
    case Dating::may_begin:
      return "All the time, or from a date on that diagnose finds.";
    case Dating::must_begin:
      return "From a date on that diagnose finds.";
    case Dating::window:
      return "Between two dates that diagnose finds.";
  }
  return "";
}

std::string needs_words(const Effect& effect) {
  const EffectNeeds& needs = effect.needs;
  std::string words;
  const auto add = [&](bool is_needed, std::string_view what) {
    if (is_needed) words += fmt::format("{}{}", words.empty() ? "" : ", ", what);
  };
  add(needs.air_system, "air handlers");
  add(needs.reheat_boxes, "boxes that reheat");
  add(needs.own_chiller, "a chiller of the building's own");
  add(needs.heat_pump, "a heat pump");
  add(needs.economiser, "an economiser");
  add(needs.night_set_back, "a night set-back");
  add(needs.humidity, "measured humidity");
  add(needs.wind, "measured wind");
  add(needs.sun, "measured sun");
  if (effect.of_one_meter) {
    add(true, effect.meter_utilities.empty() ? "any meter" : "an electricity meter");
  }
  return words;
}

/// Lines of at most `kListColumns` columns, each behind so many blanks.
std::string folded(std::string_view text, std::size_t indent) {
  const auto width_of = [](std::string_view word) {  // a byte that goes on has no column
    return static_cast<std::size_t>(
        std::ranges::count_if(word, [](char c) { return (c & 0xC0) != 0x80; }));
  };
  std::string out(indent, ' ');
  std::size_t column = indent;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    if (column > indent && column + 1 + width_of(word) > kListColumns) {
      out += '\n' + std::string(indent, ' ');
      column = indent;
    }
    if (column > indent) {
      out += ' ';
      ++column;
    }
    out += word;
    column += width_of(word);
  }
  return out + "\n";
}

nlohmann::ordered_json effect_json(const Effect& effect) {
  auto confusable = nlohmann::ordered_json::array();
  for (const diagnosis::Confusable& rival : effect.confusable) {
    confusable.push_back({{"effect", rival.effect}, {"separated_by", rival.separated_by}});
  }
  return {{"effect", effect.id},
          {"title", effect.title},
          {"class", to_string(effect.effect_class)},
          {"meaning", effect.meaning},
          {"on_meters", effect.on_meters},
          {"check", effect.check},
          {"physics", effect.physics},
          {"when", dating_words(effect.dating)},
          {"needs", needs_words(effect)},
          {"confusable", confusable}};
}

void print_effect(const Effect& effect, const Console& console) {
  const auto part = [&](std::string_view head, std::string_view text) {
    if (!text.empty()) console.out << "\n" << head << "\n" << folded(text, 2);
  };
  console.out << fmt::format("{} ({})\n", effect.title, effect.id) << folded(effect.meaning, 2);
  part("On the meters", effect.on_meters);
  part("What to check in the building", effect.check);
  if (!effect.confusable.empty()) console.out << "\nWhat tells it from effects like it\n";
  for (const diagnosis::Confusable& rival : effect.confusable) {
    console.out << fmt::format("  {}\n", rival.effect) << folded(rival.separated_by, 4);
  }
  part("In the model", effect.physics);
  part("When", dating_words(effect.dating));
  part("Needs", needs_words(effect));
}

void print_effects(const Console& console) {
  for (const auto& [effect_class, title] : kClassesInOrder) {
    console.out << title << "\n";
    for (const Effect& effect : diagnosis::catalogue()) {
      if (effect.effect_class != effect_class) continue;
      console.out << fmt::format("  {:<28}  {}\n", effect.id, effect.title);
      if (console.detail != Console::Detail::all) continue;
      console.out << folded(effect.on_meters, 6) << folded(effect.check, 6);
    }
    console.out << "\n";
  }
  if (console.detail == Console::Detail::little) return;
  console.out << "recald effects NAME says what one does to the meters and what to check in the "
                 "building.\n";
}

/// Weekend-Operation is weekend_operation.
std::string effect_id_of(std::string_view name) {
  std::string id = to_lower(name);
  std::ranges::replace_if(
      id, [](char c) { return c == '-' || c == ' '; }, '_');
  return id;
}

}  // namespace

int run_effects(const EffectsArguments& arguments, const Console& console) {
  if (arguments.name.empty()) {
    if (!arguments.json) {
      print_effects(console);
      return kSuccess;
    }
    auto list = nlohmann::ordered_json::array();
    for (const Effect& effect : diagnosis::catalogue()) list.push_back(effect_json(effect));
    console.out << nlohmann::ordered_json{{"effects", list}}.dump(2) << "\n";
    return kSuccess;
  }
  const Effect* effect = diagnosis::find_effect(effect_id_of(arguments.name));
  if (effect == nullptr) return console.misused(no_such_effect(arguments.name));
  if (arguments.json) {
    console.out << effect_json(*effect).dump(2) << "\n";
  } else {
    print_effect(*effect, console);
  }
  return kSuccess;
}

std::string no_such_effect(std::string_view name) {
  std::vector<std::string_view> ids;
  for (const Effect& effect : diagnosis::catalogue()) ids.push_back(effect.id);
  const std::string_view nearest = nearest_name(effect_id_of(name), ids);
  return fmt::format(
      "there is no effect '{}'; {}", printable(name),
      nearest.empty() ? "recald effects lists them" : fmt::format("did you mean '{}'?", nearest));
}

}  // namespace recald::daemon
