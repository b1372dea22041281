#include "simulators/more_commands.hpp"

#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>

#include "core/metering/registers/trial_clock.hpp"
#include "simulators/devices/device_plan.hpp"
#include "simulators/devices/device_service.hpp"
#include "simulators/exit.hpp"
#include "simulators/feed/write_file.hpp"

namespace recald::simulators {
namespace {

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

void add_more_commands(CLI::App& app, MoreArguments& given, std::function<int()>& run) {
  add_meters(app, given.meters)->callback([&] { run = [&] { return run_meters(given.meters); }; });
  add_eplus(app, given.eplus)->callback([&] { run = [&] { return run_eplus(given.eplus); }; });
  add_eplus_readings(app, given.readings)->callback([&] {
    run = [&] { return run_eplus_readings(given.readings); };
  });
}

}  // namespace recald::simulators
