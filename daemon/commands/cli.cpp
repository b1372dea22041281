#include "daemon/commands/cli.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/calibration/samplers.hpp"
#include "daemon/commands/command_docs.hpp"
#include "daemon/commands/command_help.hpp"
#include "daemon/commands/command_tree.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/interrupt.hpp"
#include "daemon/commands/site_schema.hpp"
#include "daemon/commands/wrong_usage.hpp"
#include "daemon/site/setup/starter_building.hpp"
#include "daemon/version.hpp"

namespace recald::daemon {
namespace {

// What people come to do, in the order in which they do it.
constexpr const char* kSetUp = "Set up a site";
constexpr const char* kRun = "Run on a gateway";
constexpr const char* kData = "Look at readings";
constexpr const char* kCalibrate = "Calibrate and forecast";
constexpr const char* kFind = "Find what the model is missing";
constexpr const char* kDesigns = "Work with simulation runs";
constexpr const char* kFleet = "Many buildings";
constexpr const char* kShell = "Help";

void add_site(CLI::App& command, SiteArguments& arguments) {
  command.add_option("site", arguments.site, "Site file (TOML)")->required();
  command.add_flag("--json", arguments.json, "Print the result as one JSON object");
}

/// @param of_building_alone  Kinds that need no design.
void add_model(CLI::App& command, std::optional<ModelKind>& kind, const std::string& text,
               bool of_building_alone) {
  std::vector<std::string> names;
  for (const std::string_view name : model_kind_names(of_building_alone)) names.emplace_back(name);
  command
      .add_option_function<std::string>(
          "--model", [&kind](const std::string& name) { kind = find_model_kind(name); }, text)
      ->check(one_of(names));
}

void add_sampling(CLI::App& command, SamplingArguments& arguments) {
  std::vector<std::string> samplers{"auto"};
  for (const calibration::Sampler& sampler : calibration::samplers()) {
    samplers.emplace_back(sampler.name);
  }
  command.add_option("--sampler", arguments.sampler, "How to sample the posterior")
      ->check(one_of(samplers))
      ->capture_default_str();
  command
      .add_option("--hyper-prior", arguments.hyper_prior,
                  "Prior of discrepancy and noise: scaled, seed, stan2018, tight or a .toml file")
      ->capture_default_str();
  command
      .add_option("--draws", arguments.iterations,
                  "Iterations of each chain, burn-in included; particles for smc")
      ->check(CLI::Range(100, 100'000'000));
  command
      .add_option("--burn-in", arguments.burn_in, "Iterations to drop at the start of each chain")
      ->check(CLI::Range(1, 100'000'000));
  command.add_option("--chains", arguments.chains, "Number of chains")
      ->check(CLI::Range(2, 64))
      ->capture_default_str();
  command.add_option("--seed", arguments.seed, "Seed of all random numbers")->capture_default_str();
  command.add_option("--threads", arguments.threads, "Number of threads; 0 for one per core")
      ->capture_default_str();
  command.add_flag("--prior-sensitivity", arguments.prior_sensitivity,
                   "Calibrate twice more, with wider and narrower priors of the discrepancy");
}

void add_calibration(CLI::App& command, CalibrateArguments& arguments) {
  command.add_flag("--json", arguments.json, "Print the result as one JSON object");
  command
      .add_option("--design-runs", arguments.design_runs,
                  "Model runs of the design (Latin hypercube)")
      ->check(CLI::Range(20, 100'000))
      ->capture_default_str();
  command
      .add_option("--discrepancy", arguments.discrepancy,
                  "sound: with the model's own errors; seed: only the discrepancy of the paper")
      ->check(one_of({"sound", "seed"}))
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
      .add_option(
          "--form", arguments.form,
          "One regression for all months (seed) or Gaussian processes of the design's (monthly); "
          "the better one by default")
      ->check(one_of({"seed", "monthly"}));
  command
      .add_option("--wind-direction", arguments.wind_direction,
                  "How the seed form uses the wind direction")
      ->check(one_of({"sincos", "degrees"}))
      ->capture_default_str();
}

/// `calibrate` takes a site file or a design folder in its place.
void add_calibrate(CLI::App& command, CalibrateArguments& arguments) {
  CLI::Option* site = command.add_option("site", arguments.site, "Site file (TOML)");
  CLI::Option* doe = command.add_option("--doe", arguments.design.folder,
                                        "Calibrate on this design folder, instead of a site");
  site->excludes(doe);
  add_model(command, arguments.model, "Model to calibrate", false);
  add_design(command, arguments.design);
  add_form(command, arguments.design);
  command.add_option("--metamodel", arguments.metamodel,
                     "Use this regression (term,coef) as it is, instead of fitting one");
  command.add_option("--measurements", arguments.measurements,
                     "Measured figures, instead of the folder's measurements.csv");
  command.add_option("--parameters", arguments.parameters,
                     "What to calibrate: screened, all, or names separated by commas");
  for (const char* name : {"--design", "--form", "--wind-direction", "--metamodel",
                           "--measurements", "--parameters"}) {
    command.get_option(name)->needs(doe);
  }
  add_calibration(command, arguments);
  CLI::Option* out = command.add_option(
      "--out", arguments.out, "Folder for calibration.json, the draws, the months and the report");
  command
      .add_flag("--predictive", arguments.predictive,
                "Also write predictive draws and log-likelihoods of the measured months (y_rep and "
                "log_lik, for ArviZ)")
      ->needs(out);
  show_first(command, {"--model", "--doe", "--out", "--seed", "--json"});
}

void add_report(CLI::App& command, ReportArguments& arguments) {
  command
      .add_option(
          "files", arguments.files,
          "Site file (TOML), or exports of meters: CSV, other delimited text, .xlsx, Green Button")
      ->required();
  add_calibration(command, arguments);
  arguments.out = "report.html";
  command.add_option("--out", arguments.out, "Page to write")->capture_default_str();
  command.add_option("--timezone", arguments.timezone,
                     "The building's zone, such as Europe/Berlin, for exports whose stamps have no "
                     "offset");
  show_first(command, {"--timezone", "--out", "--seed", "--threads", "--json"});
}

void add_screen(CLI::App& command, ScreenArguments& arguments) {
  command.add_option("--doe", arguments.design.folder, "Design folder")->required();
  add_design(command, arguments.design);
  command.add_option("--out", arguments.out, "Folder for the result");
  command.add_option("--seed", arguments.seed, "Seed of all random numbers")->capture_default_str();
  command.add_flag("--json", arguments.json, "Print the result as one JSON object");
}

void add_doe(CLI::App& command, DoeArguments& arguments) {
  add_site(command, arguments);
  add_model(command, arguments.model, "Model to run, instead of the site file's", true);
  command.add_option("--runs", arguments.runs, "Model runs of the design; 200 by default")
      ->check(CLI::Range(10, 100'000));
  command.add_option(
      "--out", arguments.out,
      "Design folder; an unfinished design is continued. An EnergyPlus model has one "
      "of its own");
  command.add_option("--seed", arguments.seed, "Seed of all random numbers")->capture_default_str();
  command.add_option("--threads", arguments.threads, "Number of threads; 0 for one per core")
      ->capture_default_str();
  CLI::Option* priors =
      command.add_flag("--priors", arguments.from_priors,
                       "Draw all runs from the priors, to check a meta-model with metamodel "
                       "--check; otherwise half are drawn evenly between the priors' ends");
  command
      .add_flag("--corners", arguments.at_corners,
                "Run random corners of the priors, where a meta-model is least sure")
      ->excludes(priors);
  show_first(command, {"--model", "--runs", "--out", "--seed", "--json"});
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
  command.add_option("--as", arguments.as, "What --hex is, if recald guesses wrong")
      ->check(one_of({"tcp", "rtu", "registers"}));
  command.add_flag("--json", arguments.json, "Print the result as one JSON object");
}

void add_status(CLI::App& command, StatusArguments& arguments) {
  CLI::Option* site = command.add_option("site", arguments.site, "Site file (TOML) of the daemon");
  CLI::Option* url = command.add_option("--url", arguments.url,
                                        "Address of the daemon, such as http://127.0.0.1:8080");
  command.add_option("--token-file", arguments.token_file, "File with the access token")
      ->needs(url);
  command.add_flag("--json", arguments.json, "Print the result as one JSON object");
  site->excludes(url);
}

void add_registers(CLI::App& command, RegistersArguments& arguments) {
  CLI::Option* site =
      command.add_option("site", arguments.site, "Site file (TOML); without one, any site's map");
  CLI::Option* csv = command.add_flag("--csv", arguments.csv, "Print one register a line, as CSV");
  command.add_flag("--json", arguments.json, "Print the result as one JSON object")
      ->needs(site)
      ->excludes(csv);
  csv->needs(site);
}

void add_export(CLI::App& command, ExportArguments& arguments) {
  add_site(command, arguments);
  command.add_option("--from", arguments.from, "First local day, YYYY-MM-DD");
  command.add_option("--to", arguments.to, "Last local day, YYYY-MM-DD");
  command.add_flag("--months", arguments.months, "Write closed months instead of readings");
  command.add_option("--out", arguments.out, "File to write; standard output by default");
}

void add_import(CLI::App& command, ImportArguments& arguments) {
  add_site(command, arguments);
  command.add_option("file", arguments.file, "Readings CSV: timestamp,meter,value,unit")
      ->required();
  command.add_option("--reason", arguments.reason, "Why, for whoever reads the record later")
      ->required();
  command
      .add_option("--stamps", arguments.stamps,
                  "Whether a time stamp marks the start or the end of its interval")
      ->check(one_of({"start", "end"}))
      ->capture_default_str();
  command.add_flag("--supersede", arguments.supersede, "Replace good readings too");
  command.add_flag("--dry-run", arguments.dry_run, "Say what would happen, but change nothing");
}

void add_restore(CLI::App& command, RestoreArguments& arguments) {
  add_site(command, arguments);
  CLI::Option* list =
      command.add_flag("--list", arguments.list, "List the backups, and restore none");
  command
      .add_option("--backup", arguments.backup,
                  "File, or a name from --list; the newest backup by default")
      ->excludes(list);
  command
      .add_flag("--dry-run", arguments.dry_run,
                "Check the backup and say what would be lost, but change nothing")
      ->excludes(list);
}

/// What every command was given on the command line; only one of them is run.
struct Arguments {
  InitArguments init;
  CheckArguments check;
  ScanArguments scan;
  RunArguments run;
  DecodeArguments decode;
  ReplayArguments replay;
  ProfileArguments profile;
  SiteArguments doctor;
  SiteArguments verify;
  ExportArguments exported;
  ImportArguments imported;
  RestoreArguments restore;
  CalibrateArguments calibrate;
  ReportArguments report;
  ScreenArguments screen;
  MetamodelArguments metamodel;
  DoeArguments doe;
  EngineArguments engine;
  DiagnoseArguments diagnose;
  EffectsArguments effects;
  DriftArguments drift;
  EcmArguments ecm;
  DetectabilityArguments detectability;
  StatusArguments status;
  RegistersArguments registers;
  ModelArguments model;
  WorkerArguments worker;
  FleetArguments fleet;
  FleetAddArguments fleet_sites;
  FleetRerunArguments rerun;
  FleetPriorsArguments fleet_priors;
  std::vector<std::string> command;
  std::string shell;
};

struct Verb {
  CLI::App* command;
  std::function<int(const Console&)> run;
};

void add_init(CLI::App& command, InitArguments& arguments) {
  command
      .add_option("files", arguments.files,
                  "Exports of meters: CSV, other delimited text, .xlsx, Green Button (XML)")
      ->required();
  command.add_option("--out", arguments.out, "Folder for site.toml; the current one by default");
  command.add_option("--timezone", arguments.timezone,
                     "The building's zone, such as Europe/Berlin: for stamps without an offset, "
                     "and for months");
  StarterRequest& starter = arguments.starter;
  CLI::Option* epw = command.add_option("--epw", starter.epw, "Weather of the place, an EPW file");
  std::vector<std::string> uses;
  for (const std::string_view use : starter_uses()) uses.emplace_back(use);
  CLI::Option* use =
      command.add_option("--use", starter.use, "Add a starter model of a typical building")
          ->check(one_of(uses))
          ->needs(epw);
  CLI::Option* area =
      command.add_option("--area", starter.floor_area_m2, "Floor area of all storeys, m2");
  use->needs(area);
  area->needs(use);
  command.add_option("--storeys", starter.storeys, "Storeys")->capture_default_str()->needs(use);
  command.add_option("--built", starter.built, "Year of construction")->needs(use);
  command.add_flag("--yes", arguments.asks_nothing,
                   "Accepted for scripts; recald init asks nothing");
  command.add_flag("--json", arguments.json, "Print the result as one JSON object");
  show_first(command, {"--out", "--timezone", "--epw", "--use", "--area", "--storeys", "--built"});
}

void add_site_verbs(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* init =
      app.add_subcommand("init", "Look at exports of meters and write a site file")->group(kSetUp);
  add_init(*init, given.init);
  verbs.push_back({init, [&](const Console& console) { return run_init(given.init, console); }});

  CLI::App* check =
      app.add_subcommand("check", "Check a site file and say what is wrong with it")->group(kSetUp);
  add_site(*check, given.check);
  check->add_flag("--meters", given.check.meters, "Also read each live meter once");
  check->add_flag("--alerts", given.check.alerts, "Also send a trial message to all of [alerts]");
  verbs.push_back({check, [&](const Console& console) { return run_check(given.check, console); }});

  CLI::App* run = app.add_subcommand("run", "Poll the meters until stopped")->group(kRun);
  run->add_option("site", given.run.site, "Site file (TOML)")->required();
  run->add_option("--clock", given.run.clock,
                  "For trials with simulated meters: START@ANCHORxSPEED, such as "
                  "2026-01-30T00:00:00Z@1769900000x600");
  verbs.push_back({run, [&](const Console& console) { return run_run(given.run, console); }});

  CLI::App* status =
      app.add_subcommand("status", "Show what a running daemon is doing")->group(kRun);
  add_status(*status, given.status);
  verbs.push_back({status, [&](const Console& console) {
                     const bool names_one = !given.status.site.empty() || !given.status.url.empty();
                     return names_one ? run_status(given.status, console)
                                      : console.misused("status needs a site file or --url");
                   }});

  CLI::App* doctor =
      app.add_subcommand(
             "doctor",
             "Check the installation, and collect what a bug report needs, without secrets")
          ->group(kRun);
  doctor->add_option("site", given.doctor.site, "Site file (TOML); the machine alone without one");
  doctor->add_flag("--json", given.doctor.json, "Print the result as one JSON object");
  verbs.push_back(
      {doctor, [&](const Console& console) { return run_doctor(given.doctor, console); }});
  CLI::App* registers =
      app.add_subcommand("registers", "List the Modbus registers that the daemon serves")
          ->group(kRun);
  add_registers(*registers, given.registers);
  verbs.push_back(
      {registers, [&](const Console& console) { return run_registers(given.registers, console); }});

  CLI::App* replay =
      app.add_subcommand("replay", "Turn recorded readings into monthly figures")->group(kData);
  add_site(*replay, given.replay);
  replay->add_option("--from", given.replay.from, "First local day, YYYY-MM-DD");
  replay->add_option("--to", given.replay.to, "Last local day, YYYY-MM-DD");
  replay->add_option("--out", given.replay.out, "Folder for months.csv and the page of the meters");
  verbs.push_back(
      {replay, [&](const Console& console) { return run_replay(given.replay, console); }});

  CLI::App* profile =
      app.add_subcommand("profile", "Read lighting and plug schedules off the electricity meter")
          ->group(kData);
  add_site(*profile, given.profile);
  profile->add_option("--out", given.profile.out, "Folder for profile.json");
  verbs.push_back(
      {profile, [&](const Console& console) { return run_profile(given.profile, console); }});
}

void add_store_verbs(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* verify = app.add_subcommand("verify", "Check the store for damage")->group(kData);
  add_site(*verify, given.verify);
  verbs.push_back(
      {verify, [&](const Console& console) { return run_verify(given.verify, console); }});

  CLI::App* exported =
      app.add_subcommand("export", "Write the store's readings or months as CSV")->group(kData);
  add_export(*exported, given.exported);
  verbs.push_back(
      {exported, [&](const Console& console) { return run_export(given.exported, console); }});

  CLI::App* imported =
      app.add_subcommand("import", "Put readings into the store, with a reason")->group(kData);
  add_import(*imported, given.imported);
  verbs.push_back(
      {imported, [&](const Console& console) { return run_import(given.imported, console); }});

  CLI::App* restore =
      app.add_subcommand("restore", "Put a backup of the store back into place")->group(kRun);
  add_restore(*restore, given.restore);
  verbs.push_back(
      {restore, [&](const Console& console) { return run_restore(given.restore, console); }});
}

void add_device_verbs(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* scan =
      app.add_subcommand("scan", "List the devices that answer on a Modbus bus")->group(kSetUp);
  add_site(*scan, given.scan);
  scan->add_option("--bus", given.scan.bus, "Name of the [bus.NAME] to scan")->required();
  scan->add_option("--units", given.scan.units, "Modbus addresses, A-B or one")
      ->capture_default_str();
  verbs.push_back({scan, [&](const Console& console) { return run_scan(given.scan, console); }});

  CLI::App* decode =
      app.add_subcommand("decode", "Explain a Modbus frame byte by byte")->group(kSetUp);
  add_decode(*decode, given.decode);
  verbs.push_back(
      {decode, [&](const Console& console) { return run_decode(given.decode, console); }});
}

void add_calibration_verbs(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* calibrate =
      app.add_subcommand("calibrate",
                         "Calibrate the site's model, or forecast its meters if it has none")
          ->group(kCalibrate);
  add_calibrate(*calibrate, given.calibrate);
  verbs.push_back({calibrate, [&](const Console& console) {
                     const std::string why = misuse_of(given.calibrate);
                     return why.empty() ? run_calibrate(given.calibrate, console)
                                        : console.misused(why);
                   }});

  CLI::App* report =
      app.add_subcommand("report",
                         "Write the page of a site or of exports: meters, and a calibration where "
                         "there is a model")
          ->group(kCalibrate);
  add_report(*report, given.report);
  verbs.push_back(
      {report, [&](const Console& console) { return run_report(given.report, console); }});
}

void add_design_verbs(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* doe = app.add_subcommand("doe", "Run the site's model over a design of its parameters")
                      ->group(kDesigns);
  add_doe(*doe, given.doe);
  verbs.push_back({doe, [&](const Console& console) { return run_doe(given.doe, console); }});

  CLI::App* screen =
      app.add_subcommand("screen", "Find which parameters of a design matter")->group(kDesigns);
  add_screen(*screen, given.screen);
  verbs.push_back(
      {screen, [&](const Console& console) { return run_screen(given.screen, console); }});

  CLI::App* metamodel =
      app.add_subcommand("metamodel", "Fit a meta-model to the runs of a design")->group(kDesigns);
  add_screen(*metamodel, given.metamodel);
  add_form(*metamodel, given.metamodel.design);
  metamodel->add_option("--check", given.metamodel.check,
                        "Another design of the same model, such as corners, to be predicted");
  metamodel
      ->add_option("--parameters", given.metamodel.parameters, "all, or names separated by commas")
      ->capture_default_str();
  show_first(*metamodel, {"--doe", "--check", "--parameters", "--out", "--json"});
  verbs.push_back(
      {metamodel, [&](const Console& console) { return run_metamodel(given.metamodel, console); }});
}

void add_drift_verb(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* drift =
      app.add_subcommand("drift",
                         "Forecast each month from the months before it and say what changed")
          ->group(kCalibrate);
  add_site(*drift, given.drift);
  drift->add_option("--out", given.drift.out, "Folder for drift.json and the page drift.html");
  add_model(*drift, given.drift.model, "epc or hourly; else as the site file says", true);
  drift->add_option("--learn", given.drift.learning_months, "Months to learn from")
      ->check(CLI::Range(6, 60))
      ->capture_default_str();
  drift
      ->add_option("--anew-every", given.drift.anew_every_months,
                   "Sample the posterior from scratch every so many months")
      ->check(CLI::Range(1, 120))
      ->capture_default_str();
  drift->add_option("--particles", given.drift.particles, "Number of particles")
      ->check(CLI::Range(64, 100'000))
      ->capture_default_str();
  drift->add_option("--seed", given.drift.seed, "Seed of all random numbers")
      ->capture_default_str();
  drift->add_option("--threads", given.drift.threads, "Number of threads; 0 for one per core");
  show_first(*drift, {"--model", "--learn", "--out", "--seed", "--json"});
  verbs.push_back({drift, [&](const Console& console) { return run_drift(given.drift, console); }});
}

void add_ecm_verb(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* ecm =
      app.add_subcommand("ecm", "Say what measures would save, or what was saved since a date")
          ->group(kCalibrate);
  add_site(*ecm, given.ecm);
  CLI::Option* measure =
      ecm->add_option("--measure", given.ecm.measure, "What measures change and cost (TOML)")
          ->option_text("FILE");
  ecm->add_option("--since", given.ecm.since,
                  "What was saved since this local day, YYYY-MM-DD, by regression and by model")
      ->excludes(measure);
  ecm->add_option("--out", given.ecm.out,
                  "Folder for ecm.json, savings.csv and the page savings.html");
  add_model(*ecm, given.ecm.model, "epc, hourly or energyplus; else as the site file says", false);
  ecm->add_option("--seed", given.ecm.seed, "Seed of all random numbers")->capture_default_str();
  ecm->add_option("--threads", given.ecm.threads, "Number of threads; 0 for one per core");
  show_first(*ecm, {"--measure", "--since", "--model", "--out", "--json"});
  verbs.push_back({ecm, [&](const Console& console) { return run_ecm(given.ecm, console); }});
}

void add_model_verbs(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* diagnose =
      app.add_subcommand("diagnose", "Look for the likely cause where model and meters disagree")
          ->group(kFind);
  add_site(*diagnose, given.diagnose);
  diagnose->add_option("--out", given.diagnose.out, "Folder for diagnosis.html and diagnosis.json");
  diagnose->add_option("--seed", given.diagnose.seed, "Seed of all random numbers")
      ->capture_default_str();
  diagnose->add_option("--threads", given.diagnose.threads,
                       "Number of threads; 0 for one per core");
  diagnose->add_flag("--apply", given.diagnose.apply, "Add the effect that is named to the model");
  diagnose->add_option("--assume", given.diagnose.assumed,
                       "Add only this effect, EFFECT or EFFECT:METER, which is known to be there");
  verbs.push_back(
      {diagnose, [&](const Console& console) { return run_diagnose(given.diagnose, console); }});

  CLI::App* effects =
      app.add_subcommand("effects", "List the effects that diagnose knows, or explain one")
          ->group(kFind);
  effects->add_option("name", given.effects.name, "Effect to explain; without one, all are listed");
  effects->add_flag("--json", given.effects.json, "Print the result as one JSON object");
  verbs.push_back(
      {effects, [&](const Console& console) { return run_effects(given.effects, console); }});

  CLI::App* detectability =
      app.add_subcommand("detectability", "Estimate how visible an effect would be at a site")
          ->group(kFind);
  add_site(*detectability, given.detectability);
  detectability
      ->add_option("--footprint", given.detectability.footprint,
                   "What the effect adds to the meters: timestamp,meter,value,unit")
      ->required();
  detectability->add_option("--out", given.detectability.out, "Folder for detectability.json");
  verbs.push_back({detectability, [&](const Console& console) {
                     return run_detectability(given.detectability, console);
                   }});

  CLI::App* model =
      app.add_subcommand("model", "List the versions of the site's model, or change to one")
          ->group(kFind);
  model->require_subcommand(1);
  const auto add = [&](const char* name, const char* help, auto run) {
    CLI::App* command = model->add_subcommand(name, help);
    add_site(*command, given.model);
    verbs.push_back(
        {command, [&given, run](const Console& console) { return run(given.model, console); }});
    return command;
  };
  add("list", "List all versions and mark the one in use", run_model_list);
  add("show", "Show one version and why it was accepted", run_model_show)
      ->add_option("version", given.model.version, "Version; the one in use by default");
  add("apply", "Put a version in force that a diagnosis proposed", run_model_apply)
      ->add_option("version", given.model.version, "Version, or its first digits")
      ->required();
  add("revert", "Go back to an earlier version", run_model_revert)
      ->add_option("version", given.model.version, "Version; the one before by default");
}

void add_engine_verbs(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* engine =
      app.add_subcommand("engine", "Look into the EnergyPlus model of a site")->group(kDesigns);
  engine->require_subcommand(1);
  CLI::App* show = engine->add_subcommand(
      "show", "List what the model reports and what in it could be varied, as lines to paste");
  add_site(*show, given.engine);
  verbs.push_back(
      {show, [&](const Console& console) { return run_engine_show(given.engine, console); }});
}

CLI::Option* add_fleet(CLI::App& command, FleetArguments& arguments) {
  return command.add_option("fleet", arguments.fleet, "File of the fleet (TOML)")->required();
}

void add_worker_verb(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* worker =
      app.add_subcommand("worker", "Take readings of gateways in, and calibrate their sites")
          ->group(kFleet);
  CLI::Option* fleet = add_fleet(*worker, given.worker);
  worker->add_option("--jobs", given.worker.jobs, "Jobs at the same time, instead of the file's")
      ->check(CLI::Range(0, 64));
  worker->add_flag("--until-idle", given.worker.until_idle, "End when no job is left");
  // How a worker starts the process of one job.
  worker->add_option("--do", given.worker.job_folder, "Do the job in this folder")
      ->group("")
      ->excludes(fleet);
  fleet->required(false);
  verbs.push_back({worker, [&](const Console& console) {
                     if (given.worker.fleet.empty() && given.worker.job_folder.empty()) {
                       return console.misused("worker needs the file of a fleet");
                     }
                     return run_worker(given.worker, console);
                   }});
}

void add_fleet_verbs(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* fleet =
      app.add_subcommand("fleet", "The record of many sites, in PostgreSQL")->group(kFleet);
  fleet->require_subcommand(1);
  CLI::App* init = fleet->add_subcommand("init", "Make the record's tables, or update them");
  add_fleet(*init, given.fleet);
  verbs.push_back(
      {init, [&](const Console& console) { return run_fleet_init(given.fleet, console); }});
  CLI::App* add = fleet->add_subcommand("add", "Register sites, or new versions of their files");
  add_fleet(*add, given.fleet_sites);
  add->add_option("sites", given.fleet_sites.sites, "Site files (TOML)")->required();
  add->add_option("--use", given.fleet_sites.use, "What they are used for, to compare them");
  add->add_option("--climate", given.fleet_sites.climate, "Their climate, to compare them");
  add->add_option("--calibrate-from", given.fleet_sites.calibrate_from,
                  "First month to calibrate, YYYY-MM; the last month by default");
  verbs.push_back(
      {add, [&](const Console& console) { return run_fleet_add(given.fleet_sites, console); }});
  CLI::App* remove = fleet->add_subcommand("remove", "Stop accepting data from sites");
  add_fleet(*remove, given.fleet_sites);
  remove->add_option("sites", given.fleet_sites.sites, "Ids of sites")->required();
  verbs.push_back({remove, [&](const Console& console) {
                     return run_fleet_remove(given.fleet_sites, console);
                   }});
  CLI::App* status = fleet->add_subcommand("status", "List sites, jobs and what went wrong");
  add_fleet(*status, given.fleet);
  status->add_flag("--json", given.fleet.json, "Print the result as one JSON object");
  verbs.push_back(
      {status, [&](const Console& console) { return run_fleet_status(given.fleet, console); }});
  CLI::App* serve = fleet->add_subcommand("serve", "Serve the pages of all sites over HTTP");
  add_fleet(*serve, given.fleet);
  verbs.push_back(
      {serve, [&](const Console& console) { return run_fleet_serve(given.fleet, console); }});
  CLI::App* priors = fleet->add_subcommand(
      "priors", "Print what other sites of the same use teach one, as lines of its site file");
  add_fleet(*priors, given.fleet_priors);
  priors->add_option("site", given.fleet_priors.site, "Id of the site")->required();
  verbs.push_back({priors, [&](const Console& console) {
                     return run_fleet_priors(given.fleet_priors, console);
                   }});
  CLI::App* rerun = fleet->add_subcommand("rerun", "List jobs to run again, and let them run");
  add_fleet(*rerun, given.rerun);
  rerun->add_option("sites", given.rerun.sites, "Ids of sites; all by default");
  rerun->add_option("--month", given.rerun.month, "YYYY-MM; the last of each site by default");
  CLI::Option* failed = rerun->add_flag("--failed", given.rerun.failed, "Only those that failed");
  rerun->add_flag("--set-aside", given.rerun.set_aside, "Only those that were set aside")
      ->excludes(failed);
  rerun->add_flag("--yes", given.rerun.yes, "Let them run");
  verbs.push_back(
      {rerun, [&](const Console& console) { return run_fleet_rerun(given.rerun, console); }});
}

/// Pages and scripts made from `app`, which has all commands by then.
void add_shell_verbs(CLI::App& app, Arguments& given, std::vector<Verb>& verbs) {
  CLI::App* man =
      app.add_subcommand("man", "Print a manual page, to be read with man -l -")->group(kShell);
  man->add_option("command", given.command, "Command; the page of recald itself by default");
  verbs.push_back({man, [&](const Console& console) {
                     std::vector<std::string> words;
                     for (const std::string& word : given.command) {
                       // recald-model-list is how the page is called
                       for (std::string& part : CLI::detail::split(word, '-')) {
                         if (!words.empty() || part != "recald") words.push_back(std::move(part));
                       }
                     }
                     if (const auto why = unknown_word(app, words); !why.empty()) {
                       return console.misused(why);
                     }
                     console.out << man_page(command_at(app, words), kVersion);
                     return kSuccess;
                   }});

  CLI::App* schema =
      app.add_subcommand("schema", "Print a JSON schema of the site file, for editors")
          ->group(kShell);
  verbs.push_back({schema, [](const Console& console) {
                     console.out << site_schema();
                     return kSuccess;
                   }});

  CLI::App* completion =
      app.add_subcommand("completion", "Print a script that completes commands in a shell")
          ->group(kShell);
  completion->add_option("shell", given.shell, "bash, zsh or fish")
      ->required()
      ->check(one_of({"bash", "zsh", "fish"}));
  verbs.push_back({completion, [&](const Console& console) {
                     console.out << completion_script(app, given.shell);
                     return kSuccess;
                   }});
}

/// The whole command line; options point into it, so it stays where it is.
struct CommandLine {
  CLI::App app{"Meter readings into months, forecasts and a calibrated model of the building.",
               "recald"};
  bool quiet = false;
  bool verbose = false;
  Arguments given;
  std::vector<Verb> verbs;

  CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;
};

/// Where --help shows all there is, --help-all is not worth a line; whoever writes it gets the
/// same.
void hide_idle_help(CLI::App& command) {
  const auto is_more = [](const CLI::Option* one) { return one->get_group() == kMoreOptions; };
  if (std::ranges::none_of(options_of(command, false), is_more)) {
    command.get_option("--help-all")->group("");
  }
  for (CLI::App* below : command.get_subcommands({})) hide_idle_help(*below);
}

CommandLine::CommandLine() {
  app.formatter(std::make_shared<CommandHelp>());
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.set_help_all_flag("--help-all", "Print the help of every command and exit");
  app.set_version_flag("-V,--version", kVersion, "Print the version and exit");
  app.require_subcommand(1);
  app.fallthrough();  // recald check site.toml -q
  CLI::Option* less = app.add_flag("-q,--quiet", quiet, "Print results and failures only");
  app.add_flag("-v,--verbose", verbose, "Print every rejected row; log more")->excludes(less);
  add_site_verbs(app, given, verbs);
  add_store_verbs(app, given, verbs);
  add_device_verbs(app, given, verbs);
  add_calibration_verbs(app, given, verbs);
  add_design_verbs(app, given, verbs);
  add_drift_verb(app, given, verbs);
  add_ecm_verb(app, given, verbs);
  add_model_verbs(app, given, verbs);
  add_engine_verbs(app, given, verbs);
  add_worker_verb(app, given, verbs);
  add_fleet_verbs(app, given, verbs);
  add_shell_verbs(app, given, verbs);
  for (CLI::App* command : app.get_subcommands({})) hide_idle_help(*command);
  // Last, since commands inherit it.
  app.footer(
      "recald COMMAND --help explains a command, recald man COMMAND has examples.\n"
      "A first page from an export of meters: recald report export.csv");
}

/// "recald calibrate has no option …" names the program itself.
int tell_misuse(const std::string& sentence, const Console& console) {
  if (!sentence.starts_with("recald ")) return console.misused(sentence);
  console.err << sentence << "\n";
  return kUsage;
}

}  // namespace

std::string wrong_usage_of(const std::vector<std::string>& words) {
  static const CommandLine kAll;
  if (std::string why = unknown_word(kAll.app, words); !why.empty()) return why;
  CommandLine line;
  try {
    line.app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& error) {
    return error.get_exit_code() == 0 ? std::string{} : sentence_of(line.app, error);
  }
  return {};
}

int run_cli(int argc, const char* const* argv, const Console& console) {
  CommandLine line;
  if (argc < 2) {
    console.out << line.app.help();
    return kSuccess;
  }
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (const auto why = unknown_word(line.app, words); !why.empty())
    return tell_misuse(why, console);
  try {
    line.app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // CLI11 prints help and version through the same door, with exit code 0.
    if (error.get_exit_code() != 0) return tell_misuse(sentence_of(line.app, error), console);
    line.app.exit(error, console.out, console.err);
    return kSuccess;
  }
  const auto verb =
      std::ranges::find_if(line.verbs, [](const Verb& one) { return one.command->parsed(); });
  const EndSignals signals;
  const Console told{console.out, console.err, console.is_terminal && !line.quiet,
                     line.quiet     ? Console::Detail::little
                     : line.verbose ? Console::Detail::all
                                    : Console::Detail::usual,
                     console.answers};
  return signals.exit_code(verb->run(told));  // CLI11 has required a command
}

}  // namespace recald::daemon
