/// The commands of `recald`, one function each; they return the exit code.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/model/model_kind.hpp"
#include "daemon/commands/console.hpp"
#include "daemon/site/setup/starter_site.hpp"

namespace recald::daemon {

struct SiteArguments {
  std::filesystem::path site;
  bool json = false;
};

struct RunArguments {
  std::filesystem::path site;
  std::string clock;             ///< "START@ANCHORxSPEED"; empty: the world's time.
  std::filesystem::path record;  ///< A new file for what comes in; empty: none.
  int record_max_MB = 200;
};

/// The daemon.
[[nodiscard]] int run_run(const RunArguments& arguments, const Console& console);

struct ReplayArguments : SiteArguments {
  std::string from;  ///< Local day, or empty.
  std::string to;
  std::filesystem::path out;  ///< Folder for months.csv and meters.html, or empty.
};

struct ProfileArguments : SiteArguments {
  std::filesystem::path out;
};

/// A design of experiments on disk, and how to regress on it.
struct DesignArguments {
  std::filesystem::path folder;
  std::string design;                     ///< Name of another design in the folder, or empty.
  std::string form;                       ///< "seed", "monthly", or empty: the better one.
  std::string wind_direction = "sincos";  ///< Or "degrees", as the seed.
};

/// How to sample a posterior.
struct SamplingArguments {
  std::string sampler = "auto";
  std::string hyper_prior = "scaled";  ///< A profile, or a file that ends in .toml.
  std::optional<int> iterations;       ///< A chain, burn-in included; absent: the sampler's own.
  std::optional<int> burn_in;
  int chains = 4;
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0: one a core. No result depends on it.
  bool prior_sensitivity = false;
  bool predictive = false;  ///< Also write y_rep and log_lik of each draw and measured point.
};

/// A site, or a design of experiments in its place.
struct CalibrateArguments : SiteArguments, SamplingArguments {
  std::filesystem::path out;           ///< Folder; for `report` the page itself.
  std::optional<ModelKind> model;      ///< Absent: as site or design say.
  int design_runs = 200;               ///< Of a site.
  std::string discrepancy = "sound";   ///< Of a site; or "seed".
  DesignArguments design;              ///< `folder` empty: a site.
  std::filesystem::path metamodel;     ///< Given regression, or empty.
  std::filesystem::path measurements;  ///< Empty: measurements.csv of the folder.
  std::string parameters;              ///< "screened", "all" or names; empty: screened.
};

/// One site file, or exports of meters.
struct ReportArguments : CalibrateArguments {
  std::vector<std::filesystem::path> files;
  std::string timezone;  ///< Of exports: IANA name, or empty.
  SurveyHints hints;     ///< Of exports.
};

struct ScreenArguments {
  DesignArguments design;
  std::filesystem::path out;  ///< Folder for screen.json, or empty.
  std::uint64_t seed = 1;
  bool json = false;
};

struct MetamodelArguments : ScreenArguments {
  std::filesystem::path check;     ///< Another design of the same model to predict; or empty.
  std::string parameters = "all";  ///< Or names separated by commas.
};

struct DoeArguments : SiteArguments {
  std::filesystem::path out;       ///< Empty: the folder that the site file's model names.
  std::optional<ModelKind> model;  ///< Absent: as the site file says.
  std::optional<int> runs;         ///< Absent: as the site file says, else 200.
  std::uint64_t seed = 1;
  unsigned threads = 0;
  bool from_priors = false;  ///< To check a meta-model with: a Latin hypercube through them …
  bool at_corners = false;   ///< … or their corners.
};

struct EngineArguments : SiteArguments {};

struct DiagnoseArguments : SiteArguments {
  std::filesystem::path out;
  std::uint64_t seed = 1;
  unsigned threads = 0;              ///< 0: one per core.
  bool apply = false;                ///< Put what was named in force.
  std::vector<std::string> assumed;  ///< Effects known to be there, "scale_fault:steam".
};

struct EffectsArguments {
  std::string name;  ///< Id of one, as a person writes it; empty: all.
  bool json = false;
};

struct DriftArguments : SiteArguments {
  std::filesystem::path out;       ///< Folder for drift.json, or empty.
  std::optional<ModelKind> model;  ///< Absent: as the site file says.
  int learning_months = 12;
  int anew_every_months = 12;  ///< 1: recalibrated from scratch each month.
  int particles = 512;
  std::uint64_t seed = 1;
  unsigned threads = 0;
};

/// One of `measure` and `since`.
struct EcmArguments : SiteArguments, SamplingArguments {
  std::filesystem::path measure;   ///< File of measures, or empty.
  std::string since;               ///< Local day, or empty.
  std::filesystem::path out;       ///< Folder for ecm.json, savings.csv and savings.html, or empty.
  std::optional<ModelKind> model;  ///< Absent: as the site file says.
};

struct InitArguments {
  std::vector<std::filesystem::path> files;
  std::filesystem::path out;  ///< Folder for site.toml; empty: here.
  std::string timezone;       ///< IANA name, or empty.
  bool asks_nothing = false;  ///< Not even where somebody could be asked.
  SurveyHints hints;
  StarterRequest starter;
  bool json = false;
};

struct CheckArguments : SiteArguments {
  bool meters = false;  ///< Try each live meter once.
  bool alerts = false;  ///< Send a trial message to each destination.
};

struct ScanArguments : SiteArguments {
  std::string bus;
  std::string units = "1-247";  ///< "3", "1-32"
};

struct DecodeArguments {
  std::string map;      ///< A shipped map, or a file that ends in .toml.
  std::string hex;      ///< The reply.
  std::string request;  ///< The request that it answers, or empty.
  std::string at;       ///< Address of the first register, or empty.
  std::string as;       ///< "tcp", "rtu", "registers"; empty: as it looks.
  bool json = false;
};

/// A running daemon: by its site file, or by its address.
struct StatusArguments : SiteArguments {
  std::string url;                   ///< "http://127.0.0.1:8080", in the place of a site file.
  std::filesystem::path token_file;  ///< With a URL; empty: none is sent.
};

/// Without a site: the page of any site's map.
struct RegistersArguments : SiteArguments {
  bool csv = false;
};

struct ExportArguments : SiteArguments {
  std::string from;  ///< Local day, or empty.
  std::string to;
  bool months = false;        ///< Closed months in the place of readings.
  std::filesystem::path out;  ///< File, or empty: standard output.
};

struct ImportArguments : SiteArguments {
  std::filesystem::path file;
  std::string reason;
  std::string stamps = "start";  ///< Or "end": what the file's stamps name.
  bool supersede = false;
  bool dry_run = false;
};

struct RestoreArguments : SiteArguments {
  std::filesystem::path backup;  ///< A file, or a name in the backup folder; empty: the newest.
  bool list = false;             ///< Only say which backups there are.
  bool dry_run = false;
};

struct DetectabilityArguments : SiteArguments {
  std::filesystem::path footprint;  ///< Readings CSV: with the effect minus without.
  std::filesystem::path out;        ///< Folder for detectability.json, or empty.
};

struct ModelArguments : SiteArguments {
  std::string version;  ///< Or its first digits; empty: the one in force, for revert its parent.
};

struct FleetArguments {
  std::filesystem::path fleet;  ///< File of the fleet (TOML).
  bool json = false;
};

struct WorkerArguments : FleetArguments {
  std::optional<int> jobs;           ///< At the same time; absent: as the file says.
  bool until_idle = false;           ///< Ends when no job is left.
  std::filesystem::path job_folder;  ///< Does the job in it and nothing else; empty: a worker.
};

struct FleetAddArguments : FleetArguments {
  std::vector<std::filesystem::path> sites;  ///< Site files; to remove: ids.
  std::string use, climate;                  ///< For comparisons; may be empty.
  std::string calibrate_from;                ///< "2026-01"; empty: the last month.
};

struct FleetPriorsArguments : FleetArguments {
  std::string site;  ///< Its id; it has been calibrated with the library's priors.
};

struct FleetRerunArguments : FleetArguments {
  std::vector<std::string> sites;  ///< Empty: all.
  std::string month;               ///< Empty: the last of each site.
  bool failed = false;             ///< Only those that failed …
  bool set_aside = false;          ///< … or were set aside.
  bool yes = false;                ///< Otherwise it only lists them.
};

/// Lists the effects that a diagnosis knows, or explains one.
int run_effects(const EffectsArguments& arguments, const Console& console);
/// "there is no effect 'fooling'; did you mean 'fouling'?"
[[nodiscard]] std::string no_such_effect(std::string_view name);
/// Looks at exports of meters and writes a site file that reads them, each guess a comment.
int run_init(const InitArguments& arguments, const Console& console);
/// Explains a site file; with `meters` it also reads each live meter once.
int run_check(const CheckArguments& arguments, const Console& console);
/// Explains a Modbus reply byte by byte, with the values that a register map finds in it.
int run_decode(const DecodeArguments& arguments, const Console& console);
/// Which units of a bus answer, and what they say of themselves.
int run_scan(const ScanArguments& arguments, const Console& console);
/// What a running daemon says of itself, over HTTP.
int run_status(const StatusArguments& arguments, const Console& console);
/// What a report of a bug needs, of the machine and of a site if one is named; without secrets.
int run_doctor(const SiteArguments& arguments, const Console& console);
/// The Modbus registers that a site serves, with their addresses.
int run_registers(const RegistersArguments& arguments, const Console& console);
int run_replay(const ReplayArguments& arguments, const Console& console);
/// The same of a recording of `recald run --record`.
int run_replay_recording(const ReplayArguments& arguments, const Console& console);
/// Checks the store without changing it, beside a daemon if need be; a sentence a fault.
int run_verify(const SiteArguments& arguments, const Console& console);
/// The store's readings or months as CSV.
int run_export(const ExportArguments& arguments, const Console& console);
/// Readings CSV into the store, as an edit with author and reason. Not while a daemon runs on it.
int run_import(const ImportArguments& arguments, const Console& console);
/// A backup into the place of the store, which is kept. Not while a daemon runs on it.
int run_restore(const RestoreArguments& arguments, const Console& console);
int run_profile(const ProfileArguments& arguments, const Console& console);
/// Writes calibration.json, draws, months.csv, profile.json and report.html into the folder; where
/// predictions are asked for also points.json.
int run_calibrate(const CalibrateArguments& arguments, const Console& console);
/// The same from a design of experiments, with screen.json and metamodel.json for profile.json.
int run_calibrate_design(const CalibrateArguments& arguments, const Console& console);
/// The site's calibration, of which only the page is kept; or the page of the meters in exports.
int run_report(const ReportArguments& arguments, const Console& console);
int run_screen(const ScreenArguments& arguments, const Console& console);
int run_metamodel(const MetamodelArguments& arguments, const Console& console);
/// What the site's EnergyPlus model reports, and what in it could be varied.
int run_engine_show(const EngineArguments& arguments, const Console& console);
/// Runs the site's model over a design into its folder, or goes on with one.
int run_doe(const DoeArguments& arguments, const Console& console);
/// Locates, names and shows what the model lacks; with `apply` the model gets it.
int run_diagnose(const DiagnoseArguments& arguments, const Console& console);
/// Forecasts each month from those before and says where and since when the building left them.
int run_drift(const DriftArguments& arguments, const Console& console);
/// What measures would save, by the calibrated model; or what was saved since a date.
int run_ecm(const EcmArguments& arguments, const Console& console);
/// How visible an effect of a given footprint is at the site, whose data must be without it.
int run_detectability(const DetectabilityArguments& arguments, const Console& console);
/// The versions of the site's model, the one in force marked.
int run_model_list(const ModelArguments& arguments, const Console& console);
/// One version in full: its effects, what they were accepted on, what they change.
int run_model_show(const ModelArguments& arguments, const Console& console);
/// Puts the parent of the version in force, or the given version, in force again.
int run_model_apply(const ModelArguments& arguments, const Console& console);
int run_model_revert(const ModelArguments& arguments, const Console& console);
/// Takes what gateways send into the record of a fleet, and does the jobs of its sites.
int run_worker(const WorkerArguments& arguments, const Console& console);
/// Makes the tables of a fleet's record, or brings them up to date.
int run_fleet_init(const FleetArguments& arguments, const Console& console);
/// Registers sites, or new versions of them; those that cannot be are said and left out.
int run_fleet_add(const FleetAddArguments& arguments, const Console& console);
int run_fleet_remove(const FleetAddArguments& arguments, const Console& console);
/// Sites, jobs, and what a person should look at.
int run_fleet_status(const FleetArguments& arguments, const Console& console);
/// Pages and API of a fleet, until it is told to stop.
int run_fleet_serve(const FleetArguments& arguments, const Console& console);
/// What the calibrations of the fleet's other sites of the same use teach one of them, as lines of
/// its site file.
int run_fleet_priors(const FleetPriorsArguments& arguments, const Console& console);
/// Lists jobs that would run again, and lets them if told to.
int run_fleet_rerun(const FleetRerunArguments& arguments, const Console& console);

}  // namespace recald::daemon
