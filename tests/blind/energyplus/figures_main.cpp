// What each hidden change does to the meters of EnergyPlus buildings, as figures to be looked at.
//
//   blind_figures --out DIR [--effect NAME]

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include "adapters/system/write_file.hpp"
#include "simulators/footprint/effect_figure.hpp"
#include "tests/blind/energyplus/simulated_building.hpp"

namespace {

using namespace recald;
using namespace recald::blind;
using simulators::Utility;
using simulators::energyplus::hidden_changes;
using simulators::energyplus::HiddenChange;

constexpr int kYear = 2021;

std::string name_of(Utility utility) {
  switch (utility) {
    case Utility::electricity:
      return "electricity";
    case Utility::cooling:
      return "chilled water";
    case Utility::heat:
      break;
  }
  return "heat";
}

/// Buildings of the learning family, as many as are needed to find some that could have each
/// change.
class Buildings {
 public:
  Buildings(const Engine& engine, std::filesystem::path scratch)
      : engine_(engine), scratch_(std::move(scratch)) {}

  /// The first that could have it from the `passed`-th building on, which then points behind it.
  /// @return null where none is left
  Result<const SimulatedBuilding*> for_change(const HiddenChange& change, std::size_t& passed,
                                              std::string& words) {
    constexpr std::uint64_t kMost = 24;
    for (std::size_t& i = passed;; ++i) {
      while (made_.size() <= i) {
        if (drawn_ == kMost) return nullptr;
        auto made = draw();
        if (!made && made.error().code != ErrorCode::invalid_value) {
          return tl::unexpected(made.error());
        }
      }
      if (!made_[i].building->could_have(change)) continue;
      words = made_[i].words;
      return made_[i++].building.get();
    }
  }

 private:
  struct Made {
    std::string words;
    std::unique_ptr<SimulatedBuilding> building;
  };

  Result<void> draw() {
    Rng rng{++drawn_, 1};
    const EplusPlan plan{.id = fmt::format("figure-{}", drawn_),
                         .seed = drawn_,
                         .building = draw_eplus_building(Family::learning, rng),
                         .first_year = kYear,
                         .years = 1};
    auto made = SimulatedBuilding::make(plan, engine_, scratch_ / plan.id);
    if (!made) return tl::unexpected(made.error());
    const auto& built = plan.building;
    made_.push_back({fmt::format("{}, {} plan, {}, {} climate", to_string(built.drawings.use),
                                 to_string(built.shape), to_string(built.system),
                                 name_of(built.drawings.climate)),
                     std::make_unique<SimulatedBuilding>(std::move(*made))});
    return {};
  }

  static std::string name_of(simulators::ClimateKind kind) {
    return std::string{simulators::name_of(kind)};
  }

  const Engine& engine_;
  std::filesystem::path scratch_;
  std::uint64_t drawn_ = 0;
  std::vector<Made> made_;
};

struct Figure {
  std::string svg;
  std::string building;
  double moved = 0.0;  ///< Share of the meter moved most.
};

Result<Figure> figure_of(const HiddenChange& change, const SimulatedBuilding& building,
                         const std::string& words) {
  std::optional<metering::Day> from;
  if (change.dated) from = metering::Day{std::chrono::year{kYear} / 4 / 1};
  std::optional<metering::Day> to;
  if (change.course == simulators::energyplus::Course::for_a_while) {
    to = metering::Day{std::chrono::year{kYear} / 8 / 1};
  }
  const auto loads = building.with({&change, change.most, from, to});
  if (!loads) return tl::unexpected(loads.error());
  const auto kinds = simulators::effect_kinds();
  simulators::Footprint footprint{
      .effect = {.kind = &*std::ranges::find(kinds, change.id, &simulators::EffectKind::id),
                 .strength = change.most,
                 .from = from,
                 .to = to,
                 .meter = {}},
      .building = words,
      .begin = building.recording_of(building.twin()).begin,
      .meters = {}};
  double moved = 0.0;
  for (std::size_t meter = 0; meter < building.meters().size(); ++meter) {
    const Utility utility = building.meters()[meter].utility;
    simulators::MeterFootprint& of = footprint.meters.emplace_back(
        simulators::MeterFootprint{utility, name_of(utility), building.twin()[meter], {}});
    double changed_kW = 0.0;
    double plain_kW = 0.0;
    for (std::size_t slot = 0; slot < of.plain_kW.size(); ++slot) {
      of.added_kW.push_back((*loads)[meter][slot] - of.plain_kW[slot]);
      changed_kW += std::abs(of.added_kW.back());
      plain_kW += of.plain_kW[slot];
    }
    if (plain_kW > 0.0) moved = std::max(moved, changed_kW / plain_kW);
  }
  footprint.outdoor_C = building.outdoor_C();
  return Figure{simulators::effect_figure(footprint, building.calendar()), words, moved};
}

/// Tries up to four buildings until the change moves some meter by 1 %.
Result<Figure> best_figure(const HiddenChange& change, Buildings& buildings) {
  constexpr int kTries = 4;
  constexpr double kSeen = 0.01;
  Figure best;
  std::size_t passed = 0;
  for (int attempt = 0; attempt < kTries && best.moved < kSeen; ++attempt) {
    std::string words;
    const auto building = buildings.for_change(change, passed, words);
    if (!building) return tl::unexpected(building.error());
    if (*building == nullptr) break;
    auto figure = figure_of(change, **building, words);
    if (!figure) return figure;
    if (best.svg.empty() || figure->moved > best.moved) best = std::move(*figure);
  }
  return best;
}

int failed(const std::string& sentence) {
  std::cerr << "blind_figures: " << sentence << '\n';
  return 1;
}

int draw(const std::filesystem::path& out, const std::string& only) {
  const auto engine = Engine::find();
  if (!engine) return failed(engine.error().message);
  if (const auto made = system::make_folder(out); !made) return failed(made.error().message);
  const std::filesystem::path scratch = std::filesystem::absolute(out / "scratch");
  Buildings buildings(*engine, scratch);
  for (const HiddenChange& change : hidden_changes()) {
    if (!only.empty() && only != change.id) continue;
    const auto figure = best_figure(change, buildings);
    if (!figure) return failed(fmt::format("{}: {}", change.id, figure.error().message));
    if (figure->svg.empty()) {
      std::cout << change.id << ": no building that could have it" << std::endl;
      continue;
    }
    const auto written = system::write_file(out / fmt::format("{}.svg", change.id), figure->svg);
    if (!written) return failed(written.error().message);
    std::cout << change.id << ": " << figure->building << std::endl;
  }
  std::error_code whatever;  // Files that stay cost room and nothing else.
  std::filesystem::remove_all(scratch, whatever);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Draws what each hidden change does to the meters of EnergyPlus buildings.",
               "blind_figures"};
  std::filesystem::path out;
  std::string only;
  app.add_option("--out", out, "folder for the figures; made if absent")->required();
  app.add_option("--effect", only, "only this one");
  CLI11_PARSE(app, argc, argv);
  return draw(out, only);
}
