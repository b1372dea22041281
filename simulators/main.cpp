/// recald-sim: simulates buildings, weather, feeds and meters to test recald with.
#include <CLI/CLI.hpp>
#include <functional>
#include <iostream>
#include <optional>

#include "simulators/climate/climate_statistics.hpp"
#include "simulators/exit.hpp"
#include "simulators/scenario/building_feed.hpp"
#include "simulators/scenario/scenario_file.hpp"
#ifdef RECALD_SIM_WHOLE
#include "simulators/more_commands.hpp"
#endif

namespace {

using namespace recald::simulators;

struct BuildingArguments {
  std::string out;
  std::string scenario;
  std::optional<int> years;
  std::optional<int> start;
  std::uint64_t seed = 1;
  bool no_faults = false;
  bool twin = false;
  bool list_effects = false;
};

int list_effects() {
  for (const EffectKind& kind : effect_kinds()) std::cout << explain(kind) << '\n';
  return 0;
}

int run_building(const BuildingArguments& given) {
  if (given.list_effects) return list_effects();
  if (given.out.empty()) return failed("building needs --out, a folder for the files", kExitUsage);
  BuildingFeedOptions options{
      .out = given.out, .scenario = {}, .seed = given.seed, .twin = given.twin};
  if (!given.scenario.empty()) {
    auto scenario = read_scenario(given.scenario);
    if (!scenario) return failed(scenario.error().message);
    options.scenario = std::move(*scenario);
  }
  Period& period = options.scenario.period;
  period.years = given.years.value_or(period.years);
  period.start_year = given.start.value_or(period.start_year);
  if (period.start_year + period.years > 2037) {
    return failed(
        "the feed would end after 2036, where time-zone rules are unknown; lower --start "
        "or --years",
        kExitUsage);
  }
  if (given.no_faults) options.scenario.care = MeterCare::perfect;
  const auto intervals = write_building_feed(options);
  if (!intervals) return failed(intervals.error().message);
  std::cout << "wrote " << *intervals << " intervals of seed " << options.seed << " to "
            << options.out.string() << ": readings.csv weather.csv site.toml truth.json"
            << (options.twin ? " twin_readings.csv footprint.csv" : "") << '\n';
  return 0;
}

CLI::App* add_building(CLI::App& app, BuildingArguments& given) {
  CLI::App* building = app.add_subcommand("building", "15-minute feeds of one invented building");
  building->add_option("--out", given.out, "folder for the files; made if absent");
  building->add_option(
      "--scenario", given.scenario,
      "TOML file: what stands where, and what is hidden in it; without it a campus "
      "laboratory");
  building->add_option("--years", given.years, "calendar years, 3 unless the scenario says")
      ->check(CLI::Range(1, 20));
  building->add_option("--start", given.start, "first calendar year, 2021 unless it says")
      ->check(CLI::Range(1972, 2036));
  building->add_option("--seed", given.seed, "decides everything that the site file hides")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  building->add_flag("--no-faults", given.no_faults,
                     "noise and resolution only, no gaps or bad values");
  building->add_flag("--twin", given.twin,
                     "also the feed without the hidden effects, and what they add");
  building->add_flag("--list-effects", given.list_effects, "explain what can be hidden, and stop");
  return building;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Makes buildings, weather, meter feeds and meters for recald to be judged by.",
               "recald-sim"};
  app.set_version_flag("--version", RECALD_VERSION);
  app.require_subcommand(1);
  std::function<int()> run;
  BuildingArguments given;
  add_building(app, given)->callback([&] { run = [&] { return run_building(given); }; });
  int climate_years = 10;
  CLI::App* climates = app.add_subcommand("climates", "simulated against published climates");
  climates->add_option("--years", climate_years, "calendar years each")->check(CLI::Range(1, 100));
  climates->callback([&] {
    run = [&] {
      std::cout << climate_table(climate_years, 1);
      return 0;
    };
  });
#ifdef RECALD_SIM_WHOLE
  MoreArguments more;
  add_more_commands(app, more, run);
#endif
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  return run();
}
