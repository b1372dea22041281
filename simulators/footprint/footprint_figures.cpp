#include "simulators/footprint/footprint_figures.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>

#include "simulators/feed/write_file.hpp"
#include "simulators/footprint/effect_figure.hpp"
#include "simulators/footprint/meter_key.hpp"
#include "simulators/footprint/showcase.hpp"
#include "simulators/footprint/week_figure.hpp"
#include "simulators/scenario/twin.hpp"

namespace recald::simulators {
namespace {

/// A building without effects and its simulated year.
struct Shown {
  Scenario scenario;
  metering::LocalCalendar calendar;
  Simulated plain;
};

/// Simulates each building once without effects, however many effects are shown in it.
class ShownBuildings {
 public:
  Result<const Shown*> get(ShowBuilding building) {
    auto& shown = shown_[static_cast<std::size_t>(building)];
    if (shown) return &*shown;
    Scenario scenario = show_scenario(building);
    auto calendar = metering::LocalCalendar::open(scenario.drawings.time_zone);
    if (!calendar) return tl::unexpected(calendar.error());
    auto plain = simulate(scenario, kShowSeed, *calendar);
    if (!plain) return tl::unexpected(plain.error());
    shown.emplace(Shown{std::move(scenario), std::move(*calendar), std::move(*plain)});
    return &*shown;
  }

 private:
  std::array<std::optional<Shown>, kShowBuildings> shown_;
};

Result<Footprint> footprint_of(const EffectKind& kind, const Shown& shown) {
  Scenario scenario = shown.scenario;
  scenario.effects.push_back(show_choice(kind));
  if (const auto checked = check_effects(scenario); !checked) {
    return tl::unexpected(checked.error());
  }
  const auto with = simulate(scenario, kShowSeed, shown.calendar);
  if (!with) return tl::unexpected(with.error());
  auto added_kW = footprint_kW(*with, shown.plain, shown.calendar);
  Footprint footprint{
      scenario.effects.front(), describe_scenario(scenario), shown.plain.recording.begin, {}};
  for (const MeterPlate& plate : plates_of(scenario.drawings)) {
    footprint.meters.push_back(
        {plate.utility, in_words(plate.kind),
         metered_kW(shown.plain.recording, plate.utility, {}, shown.calendar),
         std::move(added_kW[footprint.meters.size()])});
  }
  return footprint;
}

/// Draws into one folder and records its contents.
class Gallery {
 public:
  explicit Gallery(std::filesystem::path folder) : folder_(std::move(folder)) {}

  Result<void> add_week(Use use, ShowBuilding building) {
    const auto shown = buildings_.get(building);
    if (!shown) return tl::unexpected(shown.error());
    const std::string name = fmt::format("week_{}", to_string(use));
    list_ += fmt::format("\n![A week in winter and one in summer: {}]({}.svg)\n",
                         describe_scenario((*shown)->scenario), name);
    return add(name, week_figure((*shown)->scenario, (*shown)->plain, (*shown)->calendar));
  }

  Result<void> add_effect(const EffectKind& kind) {
    const auto shown = buildings_.get(show_building_of(kind));
    if (!shown) return tl::unexpected(shown.error());
    const auto footprint = footprint_of(kind, **shown);
    if (!footprint) return tl::unexpected(footprint.error());
    list_ += fmt::format("\n![{}: {}]({}.svg)\n", kind.title, share_text(*footprint), kind.id);
    return add(kind.id, effect_figure(*footprint, (*shown)->calendar));
  }

  void add_heading(std::string_view words) { list_ += fmt::format("\n## {}\n", words); }

  Result<void> write_list() const { return write_file(folder_ / "README.md", list_); }

  [[nodiscard]] std::size_t figures() const { return figures_; }

 private:
  Result<void> add(std::string_view name, const std::string& svg) {
    ++figures_;
    return write_file(folder_ / fmt::format("{}.svg", name), svg);
  }

  std::filesystem::path folder_;
  ShownBuildings buildings_;
  std::size_t figures_ = 0;
  std::string list_ =
      "# Footprints of the hidden effects\n\n"
      "What each effect adds to the meters of a building when nothing else changes: weather and\n"
      "people are the same. The curves are its mean day. The bars are its months, as shares of\n"
      "the meter's mean month without the effect, so their mean is the share of the year.\n\n"
      "Made by `recald-sim footprints --out FOLDER`.\n";
};

Result<void> draw_all(Gallery& gallery, std::span<const EffectKind> kinds) {
  gallery.add_heading("Buildings without effects");
  constexpr std::array<std::pair<Use, ShowBuilding>, kUses.size()> weeks{
      {{Use::office, ShowBuilding::office},
       {Use::laboratory, ShowBuilding::laboratory},
       {Use::school, ShowBuilding::school},
       {Use::shop, ShowBuilding::shop},
       {Use::hotel, ShowBuilding::hotel},
       {Use::clinic, ShowBuilding::clinic},
       {Use::warehouse, ShowBuilding::warehouse},
       {Use::restaurant, ShowBuilding::restaurant},
       {Use::gym, ShowBuilding::gym}}};
  for (const auto& [use, building] : weeks) {
    if (const auto drawn = gallery.add_week(use, building); !drawn) return drawn;
  }
  std::optional<EffectClass> group;
  for (const EffectKind& kind : kinds) {
    if (kind.group != group) {
      group = kind.group;
      gallery.add_heading(in_words(to_string(kind.group)));
    }
    if (const auto drawn = gallery.add_effect(kind); !drawn) return drawn;
  }
  return gallery.write_list();
}

}  // namespace

Result<std::size_t> draw_footprints(const std::filesystem::path& folder,
                                    std::span<const EffectKind> kinds) {
  if (const auto made = make_folder(folder); !made) return tl::unexpected(made.error());
  Gallery gallery(folder);
  if (const auto drawn = draw_all(gallery, kinds); !drawn) return tl::unexpected(drawn.error());
  return gallery.figures();
}

}  // namespace recald::simulators
