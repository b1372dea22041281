#include "daemon/gateway/registers/register_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "core/diagnosis/effects/support/effect.hpp"
#include "daemon/gateway/registers/register_table.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;

struct AlarmWords {
  AlarmCode code;
  std::string_view words;
};

constexpr AlarmWords kCauses[] = {
    {AlarmCode::none, "none"},
    {AlarmCode::nothing, "a false alarm is likeliest"},
    {AlarmCode::parameter, "a parameter of the building's model has another value"},
    {AlarmCode::use, "the building is used more or less"},
    {AlarmCode::meter, "the meter, not the building"},
    {AlarmCode::unknown, "something that the model lacks, without a name"},
};

/// Calls `take(number, words)` for each.
template <class Take>
void for_each_alarm_code(Take take) {
  for (const auto& [code, words] : kCauses) take(static_cast<int>(code), std::string{words});
  for (const EffectCode& code : effect_codes()) {
    const diagnosis::Effect* const effect = diagnosis::find_effect(code.effect);
    const std::string_view title = effect == nullptr ? "no longer known" : effect->title;
    take(int{code.number}, fmt::format("{} (`{}`)", title, code.effect));
  }
}

std::string words_of(std::span<const RegisterWord> words) {
  std::string text;
  for (const RegisterWord& word : words) {
    text += fmt::format("{}{} {}", text.empty() ? ": " : ", ", word.number, word.words);
  }
  return text;
}

/// One register of a site, at its address.
struct PlacedRegister {
  int at;
  RegisterType type;
  std::string meter;  ///< Empty: the site's.
  std::string_view name;
  std::string_view unit;
  std::string meaning;
};

template <class Facts>
void place(std::span<const RegisterEntry<Facts>> entries, int block, const std::string& meter,
           std::vector<PlacedRegister>& placed) {
  for (const auto& entry : entries) {
    placed.push_back({block + entry.at, entry.type, meter, entry.name, entry.unit,
                      std::string{entry.meaning} + words_of(entry.words)});
  }
}

std::vector<PlacedRegister> placed_registers(const SiteConfig& site) {
  std::vector<PlacedRegister> placed;
  place(site_registers(), 0, "", placed);
  const std::size_t meters = std::min<std::size_t>(site.meters.size(), kMetersMax);
  for (std::size_t i = 0; i < meters; ++i) {
    place(meter_registers(), meter_at(i), site.meters[i].meter.id, placed);
  }
  return placed;
}

template <class Facts>
std::string page_table(std::span<const RegisterEntry<Facts>> entries, std::string_view at) {
  std::string text =
      fmt::format("| {} | type | name | unit | meaning |\n| --- | --- | --- | --- | --- |\n", at);
  for (const auto& entry : entries) {
    text += fmt::format("| {} | {} | `{}` | {} | {}{} |\n", entry.at, name_of(entry.type),
                        entry.name, entry.unit, entry.meaning, words_of(entry.words));
  }
  return text;
}

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

}  // namespace

std::string words_of(AlarmCode code) {
  std::string found;
  for_each_alarm_code([&](int number, std::string words) {
    if (number == static_cast<int>(code)) found = std::move(words);
  });
  return found;
}

std::string register_page() {
  std::string page = fmt::format(
      "# The map of the registers, version {}\n\n"
      "Made by `recald registers > daemon/gateway/registers/registers.md`; a test holds it against "
      "the program.\n"
      "`recald registers SITE.toml` (`--csv`, `--json`) lists those of a site with their "
      "addresses.\n\n"
      "- Input registers, function 4. Function 3 reads the same ones, for clients that know "
      "holding registers alone. Any unit is answered.\n"
      "- Addresses are those on the wire, from 0. A document that counts from 1 calls address 0 "
      "register 1, 30001 or 40001.\n"
      "- f32: IEEE 754, high register first (ABCD); NaN (0x7FC0 0000) is \"no value\". u32: high "
      "register first.\n"
      "- Read both registers of a value in one request. An answer has values of one moment.\n"
      "- What is unused reads 0. Exceptions: 1 for any other function, 2 beyond the last meter, 3 "
      "for a count outside 1 to 125.\n"
      "- The map version changes when a register moves or means something else. Numbers of codes "
      "never change.\n\n",
      kMapVersion);
  page += "## Site\n\n" + page_table(site_registers(), "address");
  page += fmt::format(
      "\n## Meters\n\nMeter n of the site file, counted from 1, has its block at {} + {} × (n − "
      "1): {}, {}, {} and so on, at most {} meters.\n"
      "Weather sensors have none. A meter that is put between others in the site file moves those "
      "after it, so put it last.\n\n",
      kFirstMeterAt, kMeterBlock, meter_at(0), meter_at(1), meter_at(2), kMetersMax);
  page += page_table(meter_registers(), "block +");
  page += "\n## Alarm codes\n\n| code | cause |\n| --- | --- |\n";
  for_each_alarm_code([&](int number, const std::string& words) {
    page += fmt::format("| {} | {} |\n", number, words);
  });
  return page;
}

std::string registers_csv(const SiteConfig& site) {
  std::string text = "address,registers,type,meter,name,unit,meaning\n";
  for (const PlacedRegister& one : placed_registers(site)) {
    text += fmt::format("{},{},{},{},{},{},{}\n", one.at, registers_of(one.type), name_of(one.type),
                        one.meter, one.name, one.unit, in_quotes(one.meaning));
  }
  return text;
}

Json registers_json(const SiteConfig& site) {
  Json registers = Json::array();
  for (const PlacedRegister& one : placed_registers(site)) {
    registers.push_back({{"address", one.at},
                         {"registers", registers_of(one.type)},
                         {"type", name_of(one.type)},
                         {"meter", one.meter.empty() ? Json() : Json(one.meter)},
                         {"name", one.name},
                         {"unit", one.unit},
                         {"meaning", one.meaning}});
  }
  Json codes = Json::array();
  for_each_alarm_code([&](int number, const std::string& words) {
    codes.push_back({{"code", number}, {"cause", words}});
  });
  return {{"map_version", kMapVersion},
          {"meters_left_out",
           site.meters.size() - std::min<std::size_t>(site.meters.size(), kMetersMax)},
          {"registers", registers},
          {"alarm_codes", codes}};
}

std::string registers_text(const SiteConfig& site) {
  std::string text = fmt::format("{:>7}  {:<4} {:<24} {:<22} {:<6} {}\n", "address", "type",
                                 "meter", "name", "unit", "meaning");
  for (const PlacedRegister& one : placed_registers(site)) {
    text += fmt::format("{:>7}  {:<4} {:<24} {:<22} {:<6} {}\n", one.at, name_of(one.type),
                        one.meter.empty() ? "-" : one.meter, one.name, one.unit, one.meaning);
  }
  return text;
}

}  // namespace recald::daemon
