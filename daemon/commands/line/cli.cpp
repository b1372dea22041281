#include "daemon/commands/line/cli.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "core/calibration/samplers/samplers.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/interrupt.hpp"
#include "daemon/commands/line/command_docs.hpp"
#include "daemon/commands/line/command_help.hpp"
#include "daemon/commands/line/command_tree.hpp"
#include "daemon/commands/line/site_schema.hpp"
#include "daemon/commands/line/wrong_usage.hpp"
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

template <class Given>
CLI::Option* add_json(CLI::App& command, Given& given) {
  return command.add_flag("--json", given.json, "Print the result as one JSON object");
}

void add_site(CLI::App& command, SiteArguments& arguments) {
  command.add_option("site", arguments.site, "Site file (TOML)")->required();
  add_json(command, arguments);
}

template <class Given>
void add_seed(CLI::App& command, Given& given) {
  command.add_option("--seed", given.seed, "Seed of all random numbers")->capture_default_str();
}

template <class Given>
CLI::Option* add_threads(CLI::App& command, Given& given) {
  return command.add_option("--threads", given.threads, "Number of threads; 0 for one per core");
}

template <class Given>
void add_chance(CLI::App& command, Given& given) {
  add_seed(command, given);
  add_threads(command, given);
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
  add_seed(command, arguments);
  add_threads(command, arguments)->capture_default_str();
  command.add_flag("--prior-sensitivity", arguments.prior_sensitivity,
                   "Calibrate twice more, with wider and narrower priors of the discrepancy");
}

void add_calibration(CLI::App& command, CalibrateArguments& arguments) {
  add_json(command, arguments);
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

/// What an export's owner may say of it.
void add_survey_hints(CLI::App& command, SurveyHints& hints) {
  command.add_option("--unit", hints.units,
                     "Unit of the meters that say none, or NAME=UNIT of one; may be repeated");
  command.add_option("--column", hints.table.columns,
                     "Column with a meter's values; may be repeated; the others are left out");
  command.add_option("--time-column", hints.table.time_column, "Column with the times");
  command.add_option("--meter-column", hints.table.meter_column,
                     "Column that names each row's meter");
  command.add_option("--sheet", hints.table.sheet, "Sheet of a workbook");
  command
      .add_option_function<std::string>(
          "--dates",
          [&hints](const std::string& text) {
            const auto at = std::ranges::find(table::kTimeFormats, text);
            hints.table.dates = static_cast<table::TimeFormat>(at - table::kTimeFormats.begin());
          },
          "Order of a date's parts")
      ->check(one_of({table::kTimeFormats.begin(), table::kTimeFormats.end()}));
  command
      .add_option_function<std::string>(
          "--decimal", [&hints](const std::string& text) { hints.table.decimal = text.front(); },
          "Decimal sign of its numbers")
      ->check(one_of({".", ","}));
  command
      .add_option_function<std::string>(
          "--stamps",
          [&hints](const std::string& text) {
            hints.stamps = text == "end" ? csv::Stamps::end : csv::Stamps::start;
          },
          "Whether stamps are the starts or the ends of intervals")
      ->check(one_of({"start", "end"}));
  command
      .add_option_function<int>(
          "--interval", [&hints](int minutes) { hints.interval = std::chrono::minutes{minutes}; },
          "Minutes that a value stands for")
      ->check(CLI::Range(1, 60));
  command.add_option("--clock", hints.clock,
                     "Zone of the stamps, if it is not the building's: Etc/GMT-1 is Central "
                     "Europe's winter time all year");
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
  add_survey_hints(command, arguments.hints);
  show_first(command, {"--timezone", "--out", "--seed", "--threads", "--json"});
}

void add_screen(CLI::App& command, ScreenArguments& arguments) {
  command.add_option("--doe", arguments.design.folder, "Design folder")->required();
  add_design(command, arguments.design);
  command.add_option("--out", arguments.out, "Folder for the result");
  add_seed(command, arguments);
  add_json(command, arguments);
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
  add_seed(command, arguments);
  add_threads(command, arguments)->capture_default_str();
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

std::string misuse_of(const StatusArguments& arguments) {
  const bool names_one = !arguments.site.empty() || !arguments.url.empty();
  return names_one ? "" : "status needs a site file or --url";
}

std::string misuse_of(const WorkerArguments& arguments) {
  const bool has_work = !arguments.fleet.empty() || !arguments.job_folder.empty();
  return has_work ? "" : "worker needs the file of a fleet";
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
  add_json(command, arguments);
}

void add_status(CLI::App& command, StatusArguments& arguments) {
  CLI::Option* site = command.add_option("site", arguments.site, "Site file (TOML) of the daemon");
  CLI::Option* url = command.add_option("--url", arguments.url,
                                        "Address of the daemon, such as http://127.0.0.1:8080");
  command.add_option("--token-file", arguments.token_file, "File with the access token")
      ->needs(url);
  add_json(command, arguments);
  site->excludes(url);
}

void add_registers(CLI::App& command, RegistersArguments& arguments) {
  CLI::Option* site =
      command.add_option("site", arguments.site, "Site file (TOML); without one, any site's map");
  CLI::Option* csv = command.add_flag("--csv", arguments.csv, "Print one register a line, as CSV");
  add_json(command, arguments)->needs(site)->excludes(csv);
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

struct Verb {
  CLI::App* command;
  std::function<int(const Console&)> run;
};

/// What was given to a command, by type of its arguments; only one command is run.
template <class Given>
struct Command {
  CLI::App& app;
  Given& given;
};

class Verbs {
 public:
  explicit Verbs(CLI::App& app) : app_(&app) {}

  /// @param group   Heading of the help that it stands under.
  /// @param run     Called with what was given, unless `misuse` says why that makes no sense.
  template <class Given>
  Command<Given> add(const char* group, const char* name, const char* text,
                     int (*run)(const Given&, const Console&),
                     std::string (*misuse)(const Given&) = nullptr) {
    Command<Given> command = add_to(*app_, name, text, run, misuse);
    command.app.group(group);
    return command;
  }
  /// A command that has commands of its own.
  CLI::App& add_family(const char* group, const char* name, const char* text) {
    return *app_->add_subcommand(name, text)->group(group)->require_subcommand(1);
  }
  template <class Given>
  Command<Given> add_to(CLI::App& family, const char* name, const char* text,
                        int (*run)(const Given&, const Console&),
                        std::string (*misuse)(const Given&) = nullptr) {
    CLI::App* command = family.add_subcommand(name, text);
    const auto given = std::make_shared<Given>();
    all_.push_back({command, [given, run, misuse](const Console& console) {
                      const std::string why = misuse == nullptr ? "" : misuse(*given);
                      return why.empty() ? run(*given, console) : console.misused(why);
                    }});
    return {*command, *given};
  }
  /// A command of the command line itself.
  CLI::App& add(const char* group, const char* name, const char* text,
                std::function<int(const Console&)> run) {
    CLI::App* command = app_->add_subcommand(name, text)->group(group);
    all_.push_back({command, std::move(run)});
    return *command;
  }

  [[nodiscard]] int run_parsed(const Console& console) const {
    const auto parsed =
        std::ranges::find_if(all_, [](const Verb& one) { return one.command->parsed(); });
    return parsed->run(console);  // CLI11 has required a command
  }

 private:
  CLI::App* app_;
  std::vector<Verb> all_;
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
  add_survey_hints(command, arguments.hints);
  command.add_flag("--yes", arguments.asks_nothing,
                   "Ask nothing: what no evidence settles is refused, as without a terminal");
  add_json(command, arguments);
  show_first(command, {"--out", "--timezone", "--epw", "--use", "--area", "--storeys", "--built"});
}

void add_site_verbs(Verbs& verbs) {
  const auto init =
      verbs.add(kSetUp, "init", "Look at exports of meters and write a site file", run_init);
  add_init(init.app, init.given);

  const auto [check, checked] =
      verbs.add(kSetUp, "check", "Check a site file and say what is wrong with it", run_check);
  add_site(check, checked);
  check.add_flag("--meters", checked.meters, "Also read each live meter once");
  check.add_flag("--alerts", checked.alerts, "Also send a trial message to all of [alerts]");

  const auto [run, of_run] = verbs.add(kRun, "run", "Poll the meters until stopped", run_run);
  run.add_option("site", of_run.site, "Site file (TOML)")->required();
  run.add_option("--clock", of_run.clock,
                 "For trials with simulated meters: START@ANCHORxSPEED, such as "
                 "2026-01-30T00:00:00Z@1769900000x600");
  CLI::Option* const record = run.add_option(
      "--record", of_run.record,
      "New file for all that meters say, for a report of a fault; recald replay does it again");
  run.add_option("--record-max-MB", of_run.record_max_MB, "Size at which the recording ends")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str()
      ->needs(record);

  const auto status =
      verbs.add(kRun, "status", "Show what a running daemon is doing", run_status, misuse_of);
  add_status(status.app, status.given);

  const auto [doctor, examined] = verbs.add(
      kRun, "doctor",
      "Check the installation, and collect what a bug report needs, without secrets", run_doctor);
  doctor.add_option("site", examined.site, "Site file (TOML); the machine alone without one");
  add_json(doctor, examined);

  const auto registers = verbs.add(
      kRun, "registers", "List the Modbus registers that the daemon serves", run_registers);
  add_registers(registers.app, registers.given);

  const auto [replay, replayed] =
      verbs.add(kData, "replay", "Turn recorded readings into monthly figures", run_replay);
  replay
      .add_option("site", replayed.site, "Site file (TOML), or a recording of recald run --record")
      ->required();
  add_json(replay, replayed);
  replay.add_option("--from", replayed.from, "First local day, YYYY-MM-DD");
  replay.add_option("--to", replayed.to, "Last local day, YYYY-MM-DD");
  replay.add_option(
      "--out", replayed.out,
      "Folder for months.csv and the page of the meters; of a recording, for readings.csv, "
      "months.csv and events.jsonl");

  const auto [profile, profiled] = verbs.add(
      kData, "profile", "Read lighting and plug schedules off the electricity meter", run_profile);
  add_site(profile, profiled);
  profile.add_option("--out", profiled.out, "Folder for profile.json");
}

void add_store_verbs(Verbs& verbs) {
  const auto verify = verbs.add(kData, "verify", "Check the store for damage", run_verify);
  add_site(verify.app, verify.given);
  const auto exported =
      verbs.add(kData, "export", "Write the store's readings or months as CSV", run_export);
  add_export(exported.app, exported.given);
  const auto imported =
      verbs.add(kData, "import", "Put readings into the store, with a reason", run_import);
  add_import(imported.app, imported.given);
  const auto restore =
      verbs.add(kRun, "restore", "Put a backup of the store back into place", run_restore);
  add_restore(restore.app, restore.given);
}

void add_device_verbs(Verbs& verbs) {
  const auto [scan, scanned] =
      verbs.add(kSetUp, "scan", "List the devices that answer on a Modbus bus", run_scan);
  add_site(scan, scanned);
  scan.add_option("--bus", scanned.bus, "Name of the [bus.NAME] to scan")->required();
  scan.add_option("--units", scanned.units, "Modbus addresses, A-B or one")->capture_default_str();
  const auto decode =
      verbs.add(kSetUp, "decode", "Explain a Modbus frame byte by byte", run_decode);
  add_decode(decode.app, decode.given);
}

void add_calibration_verbs(Verbs& verbs) {
  const auto calibrate = verbs.add(
      kCalibrate, "calibrate", "Calibrate the site's model, or forecast its meters if it has none",
      run_calibrate, misuse_of);
  add_calibrate(calibrate.app, calibrate.given);
  const auto report = verbs.add(
      kCalibrate, "report",
      "Write the page of a site or of exports: meters, and a calibration where there is a model",
      run_report);
  add_report(report.app, report.given);
}

void add_design_verbs(Verbs& verbs) {
  const auto doe =
      verbs.add(kDesigns, "doe", "Run the site's model over a design of its parameters", run_doe);
  add_doe(doe.app, doe.given);
  const auto screen =
      verbs.add(kDesigns, "screen", "Find which parameters of a design matter", run_screen);
  add_screen(screen.app, screen.given);
  const auto [metamodel, given] =
      verbs.add(kDesigns, "metamodel", "Fit a meta-model to the runs of a design", run_metamodel);
  add_screen(metamodel, given);
  add_form(metamodel, given.design);
  metamodel.add_option("--check", given.check,
                       "Another design of the same model, such as corners, to be predicted");
  metamodel.add_option("--parameters", given.parameters, "all, or names separated by commas")
      ->capture_default_str();
  show_first(metamodel, {"--doe", "--check", "--parameters", "--out", "--json"});
}

void add_drift_verb(Verbs& verbs) {
  const auto [drift, given] =
      verbs.add(kCalibrate, "drift",
                "Forecast each month from the months before it and say what changed", run_drift);
  add_site(drift, given);
  drift.add_option("--out", given.out, "Folder for drift.json and the page drift.html");
  add_model(drift, given.model, "epc or hourly; else as the site file says", true);
  drift.add_option("--learn", given.learning_months, "Months to learn from")
      ->check(CLI::Range(6, 60))
      ->capture_default_str();
  drift
      .add_option("--anew-every", given.anew_every_months,
                  "Sample the posterior from scratch every so many months")
      ->check(CLI::Range(1, 120))
      ->capture_default_str();
  drift.add_option("--particles", given.particles, "Number of particles")
      ->check(CLI::Range(64, 100'000))
      ->capture_default_str();
  add_chance(drift, given);
  show_first(drift, {"--model", "--learn", "--out", "--seed", "--json"});
}

void add_ecm_verb(Verbs& verbs) {
  const auto [ecm, given] = verbs.add(
      kCalibrate, "ecm", "Say what measures would save, or what was saved since a date", run_ecm);
  add_site(ecm, given);
  CLI::Option* measure =
      ecm.add_option("--measure", given.measure, "What measures change and cost (TOML)")
          ->option_text("FILE");
  ecm.add_option("--since", given.since,
                 "What was saved since this local day, YYYY-MM-DD, by regression and by model")
      ->excludes(measure);
  ecm.add_option("--out", given.out, "Folder for ecm.json, savings.csv and the page savings.html");
  add_model(ecm, given.model, "epc, hourly or energyplus; else as the site file says", false);
  add_chance(ecm, given);
  show_first(ecm, {"--measure", "--since", "--model", "--out", "--json"});
}

void add_finding_verbs(Verbs& verbs) {
  const auto [diagnose, given] = verbs.add(
      kFind, "diagnose", "Look for the likely cause where model and meters disagree", run_diagnose);
  add_site(diagnose, given);
  diagnose.add_option("--out", given.out, "Folder for diagnosis.html and diagnosis.json");
  add_chance(diagnose, given);
  diagnose.add_flag("--apply", given.apply, "Add the effect that is named to the model");
  diagnose.add_option("--assume", given.assumed,
                      "Add only this effect, EFFECT or EFFECT:METER, which is known to be there");

  const auto [effects, named] = verbs.add(
      kFind, "effects", "List the effects that diagnose knows, or explain one", run_effects);
  effects.add_option("name", named.name, "Effect to explain; without one, all are listed");
  add_json(effects, named);

  const auto [detectability, seen] =
      verbs.add(kFind, "detectability", "Estimate how visible an effect would be at a site",
                run_detectability);
  add_site(detectability, seen);
  detectability
      .add_option("--footprint", seen.footprint,
                  "What the effect adds to the meters: timestamp,meter,value,unit")
      ->required();
  detectability.add_option("--out", seen.out, "Folder for detectability.json");
}

void add_model_verbs(Verbs& verbs) {
  CLI::App& model =
      verbs.add_family(kFind, "model", "List the versions of the site's model, or change to one");
  const auto add = [&](const char* name, const char* help, auto run, const char* version) {
    const auto [command, given] = verbs.add_to(model, name, help, run);
    add_site(command, given);
    return version == nullptr ? nullptr : command.add_option("version", given.version, version);
  };
  add("list", "List all versions and mark the one in use", run_model_list, nullptr);
  add("show", "Show one version and why it was accepted", run_model_show,
      "Version; the one in use by default");
  add("apply", "Put a version in force that a diagnosis proposed", run_model_apply,
      "Version, or its first digits")
      ->required();
  add("revert", "Go back to an earlier version", run_model_revert,
      "Version; the one before by default");
}

void add_engine_verbs(Verbs& verbs) {
  CLI::App& engine =
      verbs.add_family(kDesigns, "engine", "Look into the EnergyPlus model of a site");
  const auto show =
      verbs.add_to(engine, "show",
                   "List what the model reports and what in it could be varied, as lines to paste",
                   run_engine_show);
  add_site(show.app, show.given);
}

CLI::Option* add_fleet(CLI::App& command, FleetArguments& arguments) {
  return command.add_option("fleet", arguments.fleet, "File of the fleet (TOML)")->required();
}

void add_worker_verb(Verbs& verbs) {
  const auto [worker, given] =
      verbs.add(kFleet, "worker", "Take readings of gateways in, and calibrate their sites",
                run_worker, misuse_of);
  CLI::Option* fleet = add_fleet(worker, given);
  worker.add_option("--jobs", given.jobs, "Jobs at the same time, instead of the file's")
      ->check(CLI::Range(0, 64));
  worker.add_flag("--until-idle", given.until_idle, "End when no job is left");
  // How a worker starts the process of one job.
  worker.add_option("--do", given.job_folder, "Do the job in this folder")
      ->group("")
      ->excludes(fleet);
  fleet->required(false);
}

void add_fleet_verbs(Verbs& verbs) {
  CLI::App& fleet = verbs.add_family(kFleet, "fleet", "The record of many sites, in PostgreSQL");
  const auto init =
      verbs.add_to(fleet, "init", "Make the record's tables, or update them", run_fleet_init);
  add_fleet(init.app, init.given);

  const auto [add, added] =
      verbs.add_to(fleet, "add", "Register sites, or new versions of their files", run_fleet_add);
  add_fleet(add, added);
  add.add_option("sites", added.sites, "Site files (TOML)")->required();
  add.add_option("--use", added.use, "What they are used for, to compare them");
  add.add_option("--climate", added.climate, "Their climate, to compare them");
  add.add_option("--calibrate-from", added.calibrate_from,
                 "First month to calibrate, YYYY-MM; the last month by default");

  const auto [remove, removed] =
      verbs.add_to(fleet, "remove", "Stop accepting data from sites", run_fleet_remove);
  add_fleet(remove, removed);
  remove.add_option("sites", removed.sites, "Ids of sites")->required();

  const auto status =
      verbs.add_to(fleet, "status", "List sites, jobs and what went wrong", run_fleet_status);
  add_fleet(status.app, status.given);
  add_json(status.app, status.given);

  const auto serve =
      verbs.add_to(fleet, "serve", "Serve the pages of all sites over HTTP", run_fleet_serve);
  add_fleet(serve.app, serve.given);

  const auto [priors, taught] =
      verbs.add_to(fleet, "priors",
                   "Print what other sites of the same use teach one, as lines of its site file",
                   run_fleet_priors);
  add_fleet(priors, taught);
  priors.add_option("site", taught.site, "Id of the site")->required();

  const auto [rerun, given] =
      verbs.add_to(fleet, "rerun", "List jobs to run again, and let them run", run_fleet_rerun);
  add_fleet(rerun, given);
  rerun.add_option("sites", given.sites, "Ids of sites; all by default");
  rerun.add_option("--month", given.month, "YYYY-MM; the last of each site by default");
  CLI::Option* failed = rerun.add_flag("--failed", given.failed, "Only those that failed");
  rerun.add_flag("--set-aside", given.set_aside, "Only those that were set aside")
      ->excludes(failed);
  rerun.add_flag("--yes", given.yes, "Let them run");
}

/// What pages and scripts are made for.
struct ShellArguments {
  std::vector<std::string> command;
  std::string shell;
};

/// Pages and scripts made from `app`, which has all commands by then.
void add_shell_verbs(CLI::App& app, ShellArguments& given, Verbs& verbs) {
  verbs
      .add(kShell, "man", "Print a manual page, to be read with man -l -",
           [&](const Console& console) {
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
           })
      .add_option("command", given.command, "Command; the page of recald itself by default");
  verbs.add(kShell, "schema", "Print a JSON schema of the site file, for editors",
            [](const Console& console) {
              console.out << site_schema();
              return kSuccess;
            });
  verbs
      .add(kShell, "completion", "Print a script that completes commands in a shell",
           [&](const Console& console) {
             console.out << completion_script(app, given.shell);
             return kSuccess;
           })
      .add_option("shell", given.shell, "bash, zsh or fish")
      ->required()
      ->check(one_of({"bash", "zsh", "fish"}));
}

/// The whole command line; options point into it, so it stays where it is.
struct CommandLine {
  CLI::App app{"Meter readings into months, forecasts and a calibrated model of the building.",
               "recald"};
  bool quiet = false;
  bool verbose = false;
  ShellArguments given;
  Verbs verbs{app};

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
  add_site_verbs(verbs);
  add_store_verbs(verbs);
  add_device_verbs(verbs);
  add_calibration_verbs(verbs);
  add_design_verbs(verbs);
  add_drift_verb(verbs);
  add_ecm_verb(verbs);
  add_finding_verbs(verbs);
  add_model_verbs(verbs);
  add_engine_verbs(verbs);
  add_worker_verb(verbs);
  add_fleet_verbs(verbs);
  add_shell_verbs(app, given, verbs);
  for (CLI::App* command : app.get_subcommands({})) hide_idle_help(*command);
  // Last, since commands inherit it.
  app.footer(
      "recald COMMAND --help explains a command, recald man COMMAND has examples.\n"
      "A first page from an export of meters: recald report export.csv");
}

/// "recald calibrate has no option …" names the program itself.
int report_misuse(const std::string& sentence, const Console& console) {
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
    return report_misuse(why, console);
  try {
    line.app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    // CLI11 prints help and version through the same door, with exit code 0.
    if (error.get_exit_code() != 0) return report_misuse(sentence_of(line.app, error), console);
    line.app.exit(error, console.out, console.err);
    return kSuccess;
  }
  const EndSignals signals;
  const Console told{console.out, console.err, console.is_terminal && !line.quiet,
                     line.quiet     ? Console::Detail::little
                     : line.verbose ? Console::Detail::all
                                    : Console::Detail::usual,
                     console.answers};
  return signals.exit_code(line.verbs.run_parsed(told));
}

}  // namespace recald::daemon
