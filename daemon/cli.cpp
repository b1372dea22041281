#include "daemon/cli.hpp"

#include <CLI/CLI.hpp>

#include "daemon/commands/commands.hpp"
#include "daemon/version.hpp"

namespace recald::daemon {
namespace {

void add_site(CLI::App& command, SiteArguments& arguments) {
  command.add_option("site", arguments.site, "Site file (TOML)")->required();
  command.add_flag("--json", arguments.json, "One JSON object on standard output");
}

void add_calibration(CLI::App& command, CalibrateArguments& arguments) {
  add_site(command, arguments);
  command.add_option("--model", arguments.model, "Model to calibrate")
      ->check(CLI::IsMember({"epc"}))
      ->capture_default_str();
  command.add_option("--sampler", arguments.sampler, "How to sample the posterior")
      ->check(CLI::IsMember({"seed_rwm"}))
      ->capture_default_str();
  command.add_option("--hyper-prior", arguments.hyper_prior, "Beliefs about discrepancy and error")
      ->check(CLI::IsMember({"scaled", "seed", "stan2018", "wide", "tight"}))
      ->capture_default_str();
  command.add_option("--draws", arguments.iterations, "Iterations of a chain, burn-in included")
      ->check(CLI::Range(100, 100'000'000))
      ->capture_default_str();
  command.add_option("--burn-in", arguments.burn_in, "Iterations dropped at the start of a chain")
      ->check(CLI::Range(1, 100'000'000))
      ->capture_default_str();
  command.add_option("--chains", arguments.chains, "Chains")
      ->check(CLI::Range(2, 64))
      ->capture_default_str();
  command.add_option("--design-runs", arguments.design_runs, "Runs of the Latin hypercube")
      ->check(CLI::Range(20, 100'000))
      ->capture_default_str();
  command.add_option("--seed", arguments.seed, "Seed of all random numbers")->capture_default_str();
  command.add_option("--threads", arguments.threads, "Threads; 0: one a core")
      ->capture_default_str();
  command.add_flag("--prior-sensitivity", arguments.prior_sensitivity,
                   "Calibrate twice more with other beliefs about the discrepancy");
}

}  // namespace

int run_cli(int argc, const char* const* argv, const Console& console) {
  CLI::App app{"Keeps a building's energy model calibrated to its meters.", "recald"};
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);

  SiteArguments check;
  ReplayArguments replay;
  ProfileArguments profile;
  CalibrateArguments calibrate;
  CalibrateArguments report;

  CLI::App* check_command = app.add_subcommand("check", "Explain what a site file gets wrong");
  add_site(*check_command, check);

  CLI::App* replay_command =
      app.add_subcommand("replay", "Recorded readings to monthly figures, on a virtual clock");
  add_site(*replay_command, replay);
  replay_command->add_option("--from", replay.from, "First local day, YYYY-MM-DD");
  replay_command->add_option("--to", replay.to, "Last local day, YYYY-MM-DD");
  replay_command->add_option("--out", replay.out, "Folder for months.csv");

  CLI::App* profile_command =
      app.add_subcommand("profile", "Lighting and plug schedules from the electricity meter");
  add_site(*profile_command, profile);
  profile_command->add_option("--out", profile.out, "Folder for profile.json");

  CLI::App* calibrate_command = app.add_subcommand("calibrate", "One calibration now");
  add_calibration(*calibrate_command, calibrate);
  calibrate_command->add_option("--out", calibrate.out,
                                "Folder for calibration.json, draws, figures and report");

  CLI::App* report_command = app.add_subcommand("report", "Calibrate and write the page");
  add_calibration(*report_command, report);
  report_command->add_option("--out", report.out, "The page, such as report.html")->required();

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // CLI11 prints help and version through the same door, with exit code 0.
    return app.exit(error, console.out, console.err) == 0 ? kSuccess : kUsage;
  }
  if (check_command->parsed()) return run_check(check, console);
  if (replay_command->parsed()) return run_replay(replay, console);
  if (profile_command->parsed()) return run_profile(profile, console);
  if (calibrate_command->parsed()) return run_calibrate(calibrate, console);
  return run_report(report, console);
}

}  // namespace recald::daemon
