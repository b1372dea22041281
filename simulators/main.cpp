/// recald-sim: makes buildings, weather and feeds for recald to be judged by.
#include <CLI/CLI.hpp>
#include <iostream>

#include "simulators/feed/building_feed.hpp"

namespace {

constexpr int kExitFailure = 1;
constexpr int kExitUsage = 2;

int run_building(const recald::simulators::BuildingFeedOptions& options) {
  const auto intervals = recald::simulators::write_building_feed(options);
  if (!intervals) {
    std::cerr << "recald-sim: " << intervals.error().message << '\n';
    return kExitFailure;
  }
  std::cout << "wrote " << *intervals << " intervals of seed " << options.seed << " to "
            << options.out.string() << ": readings.csv weather.csv site.toml truth.json\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Makes buildings, weather and meter feeds for recald to be judged by.",
               "recald-sim"};
  app.require_subcommand(1);

  recald::simulators::BuildingFeedOptions options;
  std::string out;
  bool no_faults = false;
  CLI::App* building = app.add_subcommand(
      "building", "three years of 15-minute feeds of a campus laboratory building");
  building->add_option("--out", out, "folder for the files; made if absent")->required();
  building->add_option("--years", options.period.years, "calendar years")
      ->capture_default_str()
      ->check(CLI::Range(1, 20));
  building->add_option("--start", options.period.start_year, "first calendar year")
      ->capture_default_str()
      ->check(CLI::Range(1972, 2036));
  building->add_option("--seed", options.seed, "decides everything that the site file hides")
      ->capture_default_str();
  building->add_flag("--no-faults", no_faults, "noise and resolution only, no gaps or bad values");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  options.out = out;
  options.with_faults = !no_faults;
  if (options.period.start_year + options.period.years > 2037) {
    std::cerr << "recald-sim: the feed would end after 2036, where time-zone rules are unknown; "
                 "lower --start or --years\n";
    return kExitUsage;
  }
  return run_building(options);
}
