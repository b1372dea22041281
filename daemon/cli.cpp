#include "daemon/cli.hpp"

#include <CLI/CLI.hpp>

#include "core/calibration/samplers.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/version.hpp"

namespace recald::daemon {
namespace {

void add_site(CLI::App& command, SiteArguments& arguments) {
  command.add_option("site", arguments.site, "Site file (TOML)")->required();
  command.add_flag("--json", arguments.json, "One JSON object on standard output");
}

void add_sampling(CLI::App& command, SamplingArguments& arguments) {
  std::vector<std::string> samplers{"auto"};
  for (const calibration::Sampler& sampler : calibration::samplers()) {
    samplers.emplace_back(sampler.name);
  }
  command.add_option("--sampler", arguments.sampler, "How to sample the posterior")
      ->check(CLI::IsMember(samplers))
      ->capture_default_str();
  command
      .add_option(
          "--hyper-prior", arguments.hyper_prior,
          "Beliefs about discrepancy and error: scaled, seed, stan2018, tight or a .toml file")
      ->capture_default_str();
  command
      .add_option("--draws", arguments.iterations,
                  "Iterations of a chain, burn-in included; smc: particles")
      ->check(CLI::Range(100, 100'000'000));
  command.add_option("--burn-in", arguments.burn_in, "Iterations dropped at the start of a chain")
      ->check(CLI::Range(1, 100'000'000));
  command.add_option("--chains", arguments.chains, "Chains")
      ->check(CLI::Range(2, 64))
      ->capture_default_str();
  command.add_option("--seed", arguments.seed, "Seed of all random numbers")->capture_default_str();
  command.add_option("--threads", arguments.threads, "Threads; 0: one a core")
      ->capture_default_str();
  command.add_flag("--prior-sensitivity", arguments.prior_sensitivity,
                   "Calibrate twice more with other beliefs about the discrepancy");
}

void add_calibration(CLI::App& command, CalibrateArguments& arguments) {
  command.add_flag("--json", arguments.json, "One JSON object on standard output");
  command.add_option("--design-runs", arguments.design_runs, "Runs of a site's Latin hypercube")
      ->check(CLI::Range(20, 100'000))
      ->capture_default_str();
  add_sampling(command, arguments);
}

void add_design(CLI::App& command, DesignArguments& arguments) {
  command
      .add_option("--design", arguments.design,
                  "Read NAME_priors.csv, NAME_inputs.csv and NAME_outputs.csv of the folder")
      ->option_text("NAME");
}

void add_form(CLI::App& command, DesignArguments& arguments) {
  command
      .add_option("--form", arguments.form,
                  "One regression for all months, or one a month; without it the better one")
      ->check(CLI::IsMember({"seed", "monthly"}));
  command
      .add_option("--wind-direction", arguments.wind_direction,
                  "How the seed's form takes a wind direction")
      ->check(CLI::IsMember({"sincos", "degrees"}))
      ->capture_default_str();
}

/// `calibrate` takes a site file or a design folder in its place.
void add_calibrate(CLI::App& command, CalibrateArguments& arguments) {
  CLI::Option* site = command.add_option("site", arguments.site, "Site file (TOML)");
  CLI::Option* doe =
      command.add_option("--doe", arguments.design.folder, "Design folder instead of a site");
  site->excludes(doe);
  command.add_option("--model", arguments.model, "Model to calibrate")
      ->check(CLI::IsMember({"epc", "metamodel"}));
  add_design(command, arguments.design);
  add_form(command, arguments.design);
  command.add_option("--metamodel", arguments.metamodel,
                     "A regression to take as it is (term,coef), instead of fitting one");
  command.add_option("--measurements", arguments.measurements,
                     "Measured figures instead of the folder's measurements.csv");
  command.add_option("--parameters", arguments.parameters,
                     "What to calibrate: screened, all, or names separated by commas");
  for (const char* name : {"--design", "--form", "--wind-direction", "--metamodel",
                           "--measurements", "--parameters"}) {
    command.get_option(name)->needs(doe);
  }
  add_calibration(command, arguments);
  command.add_option("--out", arguments.out,
                     "Folder for calibration.json, draws, figures and report");
}

void add_screen(CLI::App& command, ScreenArguments& arguments) {
  command.add_option("--doe", arguments.design.folder, "Design folder")->required();
  add_design(command, arguments.design);
  command.add_option("--out", arguments.out, "Folder for the result");
  command.add_option("--seed", arguments.seed, "Seed of all random numbers")->capture_default_str();
  command.add_flag("--json", arguments.json, "One JSON object on standard output");
}

void add_doe(CLI::App& command, DoeArguments& arguments) {
  add_site(command, arguments);
  command.add_option("--runs", arguments.runs, "Runs of the Latin hypercube")
      ->check(CLI::Range(20, 100'000))
      ->capture_default_str();
  command
      .add_option("--out", arguments.out, "Design folder; one that is not finished is gone on with")
      ->required();
  command.add_option("--seed", arguments.seed, "Seed of all random numbers")->capture_default_str();
  command.add_option("--threads", arguments.threads, "Threads; 0: one a core")
      ->capture_default_str();
}

/// What CLI11 cannot say of two options at once; empty where all is well.
std::string misuse_of(const CalibrateArguments& arguments) {
  const bool has_design = !arguments.design.folder.empty();
  if (!has_design && arguments.site.empty()) {
    return "calibrate needs a site file or --doe with a design folder; see recald calibrate --help";
  }
  if (has_design && !arguments.model.empty() && arguments.model != "metamodel") {
    return "a design folder has no model but its meta-model; leave --model " + arguments.model +
           " out";
  }
  if (!has_design && arguments.model == "metamodel") {
    return "a meta-model needs a design: make one with recald doe, then calibrate with --doe";
  }
  if (!arguments.metamodel.empty() && !arguments.parameters.empty()) {
    return "a given meta-model is calibrated in all its parameters; leave --parameters out";
  }
  if (!arguments.metamodel.empty() && !arguments.design.form.empty()) {
    return "a given meta-model has its form already; leave --form out";
  }
  return "";
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
  ScreenArguments screen;
  MetamodelArguments metamodel;
  DoeArguments doe;

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
  add_calibrate(*calibrate_command, calibrate);

  CLI::App* report_command = app.add_subcommand("report", "Calibrate and write the page");
  report_command->add_option("site", report.site, "Site file (TOML)")->required();
  add_calibration(*report_command, report);
  report_command->add_option("--out", report.out, "The page, such as report.html")->required();

  CLI::App* doe_command =
      app.add_subcommand("doe", "Run the site's model over a Latin hypercube of its parameters");
  add_doe(*doe_command, doe);

  CLI::App* screen_command =
      app.add_subcommand("screen", "Which parameters of a design matter to its outputs");
  add_screen(*screen_command, screen);

  CLI::App* metamodel_command =
      app.add_subcommand("metamodel", "A regression in the place of a design's simulation");
  add_screen(*metamodel_command, metamodel);
  add_form(*metamodel_command, metamodel.design);
  metamodel_command
      ->add_option("--parameters", metamodel.parameters, "all, or names separated by commas")
      ->capture_default_str();

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // CLI11 prints help and version through the same door, with exit code 0.
    return app.exit(error, console.out, console.err) == 0 ? kSuccess : kUsage;
  }
  if (check_command->parsed()) return run_check(check, console);
  if (replay_command->parsed()) return run_replay(replay, console);
  if (profile_command->parsed()) return run_profile(profile, console);
  if (calibrate_command->parsed()) {
    if (const std::string why = misuse_of(calibrate); !why.empty()) return console.misused(why);
    return run_calibrate(calibrate, console);
  }
  if (doe_command->parsed()) return run_doe(doe, console);
  if (screen_command->parsed()) return run_screen(screen, console);
  if (metamodel_command->parsed()) return run_metamodel(metamodel, console);
  return run_report(report, console);
}

}  // namespace recald::daemon
