#include "daemon/commands/cli.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "core/calibration/samplers.hpp"
#include "core/text/nearest.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/interrupt.hpp"
#include "daemon/version.hpp"

namespace recald::daemon {
namespace {

void add_site(CLI::App& command, SiteArguments& arguments) {
  command.add_option("site", arguments.site, "Site file (TOML)")->required();
  command.add_flag("--json", arguments.json, "One JSON object on standard output");
}

/// @param of_building_alone  Kinds that need no design.
void add_model(CLI::App& command, std::optional<ModelKind>& kind, const std::string& text,
               bool of_building_alone) {
  std::vector<std::string> names;
  for (const std::string_view name : model_kind_names(of_building_alone)) names.emplace_back(name);
  command
      .add_option_function<std::string>(
          "--model", [&kind](const std::string& name) { kind = find_model_kind(name); }, text)
      ->check(CLI::IsMember(names));
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
  command
      .add_option("--discrepancy", arguments.discrepancy,
                  "sound: with the model's own errors; seed: the paper's discrepancy alone")
      ->check(CLI::IsMember({"sound", "seed"}))
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
  add_model(command, arguments.model, "Model to calibrate", false);
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
  add_model(command, arguments.model, "Model to run instead of the site file's", true);
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
  if (has_design && arguments.model.value_or(ModelKind::metamodel) != ModelKind::metamodel) {
    return "a design folder has no model but its meta-model; leave --model " +
           std::string{name_of(*arguments.model)} + " out";
  }
  if (!has_design && arguments.model == ModelKind::metamodel) {
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

void add_decode(CLI::App& command, DecodeArguments& arguments) {
  command.add_option("--map", arguments.map, "Register map: a shipped one, or a .toml file")
      ->required();
  command.add_option("--hex", arguments.hex, "The reply: a TCP or RTU frame, or bare registers")
      ->required();
  command.add_option("--request", arguments.request, "The request that it answers");
  command.add_option("--at", arguments.at, "Address of its first register on the wire, base 0");
  command.add_option("--as", arguments.as, "What it is, if that is misjudged")
      ->check(CLI::IsMember({"tcp", "rtu", "registers"}));
  command.add_flag("--json", arguments.json, "One JSON object on standard output");
}

void add_status(CLI::App& command, StatusArguments& arguments) {
  CLI::Option* site = command.add_option("site", arguments.site, "Site file (TOML) of the daemon");
  CLI::Option* url =
      command.add_option("--url", arguments.url, "Where it listens, such as http://127.0.0.1:8080");
  command.add_option("--token-file", arguments.token_file, "File with the token it asks for")
      ->needs(url);
  command.add_flag("--json", arguments.json, "One JSON object on standard output");
  site->excludes(url);
}

void add_export(CLI::App& command, ExportArguments& arguments) {
  add_site(command, arguments);
  command.add_option("--from", arguments.from, "First local day, YYYY-MM-DD");
  command.add_option("--to", arguments.to, "Last local day, YYYY-MM-DD");
  command.add_flag("--months", arguments.months, "Closed months in the place of readings");
  command.add_option("--out", arguments.out, "File; without it standard output");
}

void add_import(CLI::App& command, ImportArguments& arguments) {
  add_site(command, arguments);
  command.add_option("file", arguments.file, "Readings CSV: timestamp,meter,value,unit")
      ->required();
  command.add_option("--reason", arguments.reason, "Why, for those who find them later")
      ->required();
  command.add_option("--stamps", arguments.stamps, "What the file's stamps name of an interval")
      ->check(CLI::IsMember({"start", "end"}))
      ->capture_default_str();
  command.add_flag("--supersede", arguments.supersede, "Replace good readings too");
  command.add_flag("--dry-run", arguments.dry_run, "Say what would happen, change nothing");
}

/// What every command was given on the command line; only one of them is run.
struct Arguments {
  CheckArguments check;
  ScanArguments scan;
  RunArguments run;
  DecodeArguments decode;
  ReplayArguments replay;
  ProfileArguments profile;
  SiteArguments verify;
  ExportArguments exported;
  ImportArguments imported;
  CalibrateArguments calibrate;
  CalibrateArguments report;
  ScreenArguments screen;
  MetamodelArguments metamodel;
  DoeArguments doe;
  DiagnoseArguments diagnose;
  DriftArguments drift;
  DetectabilityArguments detectability;
  StatusArguments status;
  ModelArguments model;
};

struct Verb {
  CLI::App* command;
  std::function<int(const Console&)> run;
};

void add_site_verbs(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* check = app.add_subcommand("check", "Explain what a site file gets wrong");
  add_site(*check, given.check);
  check->add_flag("--meters", given.check.meters, "Read each live meter once");
  verbs.push_back({check, [&](const Console& console) { return run_check(given.check, console); }});

  CLI::App* run = app.add_subcommand("run", "Poll the meters, until told to end");
  run->add_option("site", given.run.site, "Site file (TOML)")->required();
  run->add_option("--clock", given.run.clock,
                  "For trials with simulated meters: START@ANCHORxSPEED, such as "
                  "2026-01-30T00:00:00Z@1769900000x600");
  verbs.push_back({run, [&](const Console& console) { return run_run(given.run, console); }});

  CLI::App* status = app.add_subcommand("status", "What a running daemon says of itself");
  add_status(*status, given.status);
  verbs.push_back({status, [&](const Console& console) {
                     const bool names_one = !given.status.site.empty() || !given.status.url.empty();
                     return names_one ? run_status(given.status, console)
                                      : console.misused("status needs a site file or --url");
                   }});

  CLI::App* replay =
      app.add_subcommand("replay", "Recorded readings to monthly figures, on a virtual clock");
  add_site(*replay, given.replay);
  replay->add_option("--from", given.replay.from, "First local day, YYYY-MM-DD");
  replay->add_option("--to", given.replay.to, "Last local day, YYYY-MM-DD");
  replay->add_option("--out", given.replay.out, "Folder for months.csv");
  verbs.push_back(
      {replay, [&](const Console& console) { return run_replay(given.replay, console); }});

  CLI::App* profile =
      app.add_subcommand("profile", "Lighting and plug schedules from the electricity meter");
  add_site(*profile, given.profile);
  profile->add_option("--out", given.profile.out, "Folder for profile.json");
  verbs.push_back(
      {profile, [&](const Console& console) { return run_profile(given.profile, console); }});
}

void add_store_verbs(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* verify = app.add_subcommand("verify", "Check the store against itself");
  add_site(*verify, given.verify);
  verbs.push_back(
      {verify, [&](const Console& console) { return run_verify(given.verify, console); }});

  CLI::App* exported = app.add_subcommand("export", "The store's readings or months as CSV");
  add_export(*exported, given.exported);
  verbs.push_back(
      {exported, [&](const Console& console) { return run_export(given.exported, console); }});

  CLI::App* imported = app.add_subcommand("import", "Readings into the store, with a reason");
  add_import(*imported, given.imported);
  verbs.push_back(
      {imported, [&](const Console& console) { return run_import(given.imported, console); }});
}

void add_device_verbs(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* scan = app.add_subcommand("scan", "Which units of a bus answer, and what they are");
  add_site(*scan, given.scan);
  scan->add_option("--bus", given.scan.bus, "Name of the [bus.NAME] to scan")->required();
  scan->add_option("--units", given.scan.units, "Modbus addresses, A-B or one")
      ->capture_default_str();
  verbs.push_back({scan, [&](const Console& console) { return run_scan(given.scan, console); }});

  CLI::App* decode = app.add_subcommand("decode", "Explain a Modbus frame byte by byte");
  add_decode(*decode, given.decode);
  verbs.push_back(
      {decode, [&](const Console& console) { return run_decode(given.decode, console); }});
}

void add_calibration_verbs(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* calibrate = app.add_subcommand("calibrate", "One calibration now");
  add_calibrate(*calibrate, given.calibrate);
  verbs.push_back({calibrate, [&](const Console& console) {
                     const std::string why = misuse_of(given.calibrate);
                     return why.empty() ? run_calibrate(given.calibrate, console)
                                        : console.misused(why);
                   }});

  CLI::App* report = app.add_subcommand("report", "Calibrate and write the page");
  report->add_option("site", given.report.site, "Site file (TOML)")->required();
  add_calibration(*report, given.report);
  report->add_option("--out", given.report.out, "The page, such as report.html")->required();
  verbs.push_back(
      {report, [&](const Console& console) { return run_report(given.report, console); }});
}

void add_design_verbs(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* doe =
      app.add_subcommand("doe", "Run the site's model over a Latin hypercube of its parameters");
  add_doe(*doe, given.doe);
  verbs.push_back({doe, [&](const Console& console) { return run_doe(given.doe, console); }});

  CLI::App* screen =
      app.add_subcommand("screen", "Which parameters of a design matter to its outputs");
  add_screen(*screen, given.screen);
  verbs.push_back(
      {screen, [&](const Console& console) { return run_screen(given.screen, console); }});

  CLI::App* metamodel =
      app.add_subcommand("metamodel", "A regression in the place of a design's simulation");
  add_screen(*metamodel, given.metamodel);
  add_form(*metamodel, given.metamodel.design);
  metamodel
      ->add_option("--parameters", given.metamodel.parameters, "all, or names separated by commas")
      ->capture_default_str();
  verbs.push_back(
      {metamodel, [&](const Console& console) { return run_metamodel(given.metamodel, console); }});
}

void add_model_verbs(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* diagnose =
      app.add_subcommand("diagnose", "Find the physical effect that the model lacks");
  add_site(*diagnose, given.diagnose);
  diagnose->add_option("--out", given.diagnose.out, "Folder for diagnosis.json");
  diagnose->add_option("--seed", given.diagnose.seed, "Seed of all random numbers")
      ->capture_default_str();
  diagnose->add_flag("--apply", given.diagnose.apply, "Put what is named in force");
  diagnose->add_option("--assume", given.diagnose.assumed,
                       "An effect that is known to be there, EFFECT or EFFECT:METER: added without "
                       "asking how probable it is, and nothing else");
  verbs.push_back(
      {diagnose, [&](const Console& console) { return run_diagnose(given.diagnose, console); }});

  CLI::App* drift =
      app.add_subcommand("drift", "Forecast each month from those before: what has changed?");
  add_site(*drift, given.drift);
  drift->add_option("--out", given.drift.out, "Folder for drift.json and the page drift.html");
  add_model(*drift, given.drift.model, "epc or hourly; else as the site file says", true);
  drift->add_option("--learn", given.drift.learning_months, "Months that the model is made from")
      ->check(CLI::Range(6, 60))
      ->capture_default_str();
  drift
      ->add_option("--anew-every", given.drift.anew_every_months,
                   "Months after which the posterior is sampled from the prior again")
      ->check(CLI::Range(1, 120))
      ->capture_default_str();
  drift->add_option("--particles", given.drift.particles, "That carry the posterior along")
      ->check(CLI::Range(64, 100'000))
      ->capture_default_str();
  drift->add_option("--seed", given.drift.seed, "Seed of all random numbers")
      ->capture_default_str();
  drift->add_option("--threads", given.drift.threads, "0: as many as there are processors");
  verbs.push_back({drift, [&](const Console& console) { return run_drift(given.drift, console); }});

  CLI::App* detectability = app.add_subcommand(
      "detectability", "How visible an effect of a given footprint is at a site without it");
  add_site(*detectability, given.detectability);
  detectability
      ->add_option("--footprint", given.detectability.footprint,
                   "What the effect adds to the meters: timestamp,meter,value,unit")
      ->required();
  detectability->add_option("--out", given.detectability.out, "Folder for detectability.json");
  verbs.push_back({detectability, [&](const Console& console) {
                     return run_detectability(given.detectability, console);
                   }});

  CLI::App* model = app.add_subcommand("model", "Versions of the site's model");
  model->require_subcommand(1);
  const auto add = [&](const char* name, const char* help, auto run) {
    CLI::App* command = model->add_subcommand(name, help);
    add_site(*command, given.model);
    verbs.push_back(
        {command, [&given, run](const Console& console) { return run(given.model, console); }});
    return command;
  };
  add("list", "All versions, the one in force marked", run_model_list);
  add("show", "One version and what it was accepted on", run_model_show)
      ->add_option("version", given.model.version, "Version; without it the one in force");
  add("revert", "Go back to an earlier version", run_model_revert)
      ->add_option("version", given.model.version, "Version; without it the parent");
}

/// What is wrong with the first word of a command line, if it is no command; else empty. CLI11
/// would answer `--help` before it looks at it.
std::string unknown_command(const CLI::App& app, std::span<const char* const> words) {
  if (words.empty() || std::string_view{words.front()}.starts_with('-')) return {};
  const std::string_view word{words.front()};
  std::vector<std::string_view> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == word) return unknown_command(*command, words.subspan(1));
    names.push_back(command->get_name());
  }
  if (names.empty()) return {};  // a file's name, or whatever the command takes
  const std::string_view nearest = nearest_name(word, names);
  const std::string above = app.get_parent() == nullptr ? "" : app.get_name() + " ";
  return fmt::format("there is no command '{}{}'; {}", above, word,
                     nearest.empty() ? fmt::format("see recald {}--help", above)
                                     : fmt::format("did you mean '{}'?", nearest));
}

}  // namespace

int run_cli(int argc, const char* const* argv, const Console& console) {
  CLI::App app{"Keeps a building's energy model calibrated to its meters.", "recald"};
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);
  Arguments given;
  std::vector<Verb> verbs;
  add_site_verbs(app, given, verbs);
  add_store_verbs(app, given, verbs);
  add_device_verbs(app, given, verbs);
  add_calibration_verbs(app, given, verbs);
  add_design_verbs(app, given, verbs);
  add_model_verbs(app, given, verbs);
  const std::span words{argv, static_cast<std::size_t>(argc)};
  if (const auto why = unknown_command(app, words.subspan(std::min<std::size_t>(1, words.size())));
      !why.empty()) {
    return console.misused(why);
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // CLI11 prints help and version through the same door, with exit code 0.
    return app.exit(error, console.out, console.err) == 0 ? kSuccess : kUsage;
  }
  const auto verb =
      std::ranges::find_if(verbs, [](const Verb& one) { return one.command->parsed(); });
  const EndSignals signals;
  return signals.exit_code(verb->run(console));  // CLI11 saw to it that there is one
}

}  // namespace recald::daemon
