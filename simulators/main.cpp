/// recald-sim: simulates buildings, weather, feeds and meters to test recald with.
#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <optional>

#include "core/metering/trial_clock.hpp"
#include "simulators/climate/climate_statistics.hpp"
#include "simulators/devices/device_plan.hpp"
#include "simulators/devices/device_service.hpp"
#include "simulators/energyplus/model_files.hpp"
#include "simulators/energyplus/run_readings.hpp"
#include "simulators/feed/write_file.hpp"
#include "simulators/footprint/footprint_figures.hpp"
#include "simulators/scenario/building_feed.hpp"
#include "simulators/scenario/scenario_file.hpp"

namespace {

using namespace recald::simulators;

constexpr int kExitFailure = 1;
constexpr int kExitUsage = 2;

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

int failed(const std::string& sentence, int code = kExitFailure) {
  std::cerr << "recald-sim: " << sentence << '\n';
  return code;
}

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

struct MetersArguments {
  std::string plan;
  std::string clock;
  std::string faults;
};

recald::metering::TrialClock real_time() {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return {now, now, 1.0};
}

int run_meters(const MetersArguments& given) {
  recald::metering::TrialClock clock = real_time();
  if (!given.clock.empty()) {
    const auto parsed = recald::metering::parse_trial_clock(given.clock);
    if (!parsed) return failed(parsed.error().message, kExitUsage);
    clock = *parsed;
  }
  FaultScript faults;
  if (!given.faults.empty()) {
    auto script = read_fault_script(given.faults);
    if (!script) return failed(script.error().message);
    faults = std::move(*script);
  }
  auto plan = read_device_plan(given.plan, faults);
  if (!plan) return failed(plan.error().message);
  const auto totals = serve_devices(std::move(*plan), clock, std::cout);
  if (!totals) return failed(totals.error().message);
  std::cout << totals->requests << " requests, " << totals->writes << " writes seen\n";
  return 0;
}

CLI::App* add_meters(CLI::App& app, MetersArguments& given) {
  CLI::App* meters = app.add_subcommand(
      "meters", "simulated Modbus devices on loopback ports and pseudo-terminals, until Ctrl-C");
  meters->add_option("plan", given.plan, "TOML file: endpoints, devices, loads")->required();
  meters->add_option("--clock", given.clock,
                     "START@ANCHORxSPEED, such as 2026-01-30T00:00:00Z@1769900000x600; without it "
                     "real time, and counters that begin now");
  meters->add_option("--faults", given.faults, "script of what goes wrong, and when");
  return meters;
}

int run_eplus(const energyplus::ModelFileOptions& options) {
  const auto written = energyplus::write_model_files(options);
  if (!written) return failed(written.error().message);
  std::cout << "wrote the EnergyPlus model of a " << options.kind << " to " << options.out.string()
            << '\n';
  return 0;
}

CLI::App* add_eplus(CLI::App& app, energyplus::ModelFileOptions& options) {
  CLI::App* eplus = app.add_subcommand(
      "eplus", "an EnergyPlus model of an invented building, and what is true of it");
  eplus->add_option("--kind", options.kind, "laboratory or small_office")->required();
  eplus->add_option("--out", options.out, "folder for the files; made if absent")->required();
  eplus->add_flag("--true", options.with_truth, "also the building as it is: truth.epJSON");
  eplus->add_option("--years", options.years, "calendar years of weather and of people's habits")
      ->check(CLI::Range(1, 20));
  eplus->add_option("--start", options.first_year, "first of these years, 2021 unless given")
      ->check(CLI::Range(1972, 2036));
  eplus->add_option("--seed", options.seed, "decides what is hidden, and the weather")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  return eplus;
}

struct ReadingArguments {
  std::string out;
  std::string zone = energyplus::kTimeZone;
  std::vector<std::string> meters;
  energyplus::ReadingOptions options;
};

int run_eplus_readings(ReadingArguments& given) {
  energyplus::ReadingOptions& options = given.options;
  options.meters =
      given.meters.empty() ? energyplus::district_meters() : std::vector<energyplus::RunMeter>{};
  for (const std::string& meter : given.meters) {
    const auto equals = meter.find('=');
    if (equals == std::string::npos) {
      return failed("--meter " + meter +
                        " is not of the form ID=METER, such as "
                        "electricity=Electricity:Facility",
                    kExitUsage);
    }
    options.meters.push_back({meter.substr(0, equals), meter.substr(equals + 1)});
  }
  const auto calendar = recald::metering::LocalCalendar::open(given.zone);
  if (!calendar) return failed(calendar.error().message);
  options.standard_offset = calendar->standard_offset(std::chrono::year{2021});
  const auto text = energyplus::readings_csv(options);
  if (!text) return failed(text.error().message);
  const auto written = write_file(given.out, *text);
  return written ? 0 : failed(written.error().message);
}

CLI::App* add_eplus_readings(CLI::App& app, ReadingArguments& given) {
  CLI::App* readings = app.add_subcommand(
      "eplus-readings", "what meters would have recorded of finished EnergyPlus runs");
  readings->add_option("runs", given.options.runs, "eplusout.sql of each year")->required();
  readings->add_option("--out", given.out, "CSV file to write")->required();
  readings->add_option("--meter", given.meters,
                       "ID=METER, repeatable; without it electricity, chilled_water and heat of "
                       "the models that `eplus` writes");
  readings->add_option("--zone", given.zone, "time zone of the building")->capture_default_str();
  readings->add_option("--noise", given.options.noise_share, "one standard deviation, as a share")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  readings->add_option("--lost", given.options.lost_share, "share of the rows that is missing")
      ->check(CLI::Range(0.0, 0.5))
      ->capture_default_str();
  readings->add_option("--seed", given.options.seed, "decides noise and gaps")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  return readings;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Makes buildings, weather, meter feeds and meters for recald to be judged by.",
               "recald-sim"};
  app.require_subcommand(1);
  BuildingArguments given;
  const CLI::App* building = add_building(app, given);
  MetersArguments metered;
  const CLI::App* meters = add_meters(app, metered);
  energyplus::ModelFileOptions eplus_options;
  const CLI::App* eplus = add_eplus(app, eplus_options);
  ReadingArguments read;
  const CLI::App* eplus_readings = add_eplus_readings(app, read);
  std::string figures;
  CLI::App* footprints =
      app.add_subcommand("footprints", "draw what each effect does to the meters");
  footprints->add_option("--out", figures, "folder for the figures; made if absent")->required();
  int climate_years = 10;
  CLI::App* climates = app.add_subcommand("climates", "simulated against published climates");
  climates->add_option("--years", climate_years, "calendar years each")->check(CLI::Range(1, 100));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  if (building->parsed()) return run_building(given);
  if (meters->parsed()) return run_meters(metered);
  if (eplus->parsed()) return run_eplus(eplus_options);
  if (eplus_readings->parsed()) return run_eplus_readings(read);
  if (climates->parsed()) {
    std::cout << climate_table(climate_years, 1);
    return 0;
  }
  const auto drawn = draw_footprints(figures);
  if (!drawn) return failed(drawn.error().message);
  std::cout << "drew " << *drawn << " figures into " << figures << '\n';
  return 0;
}
