#include "daemon/site/calibrate/site_runs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "adapters/doe/days_file.hpp"
#include "adapters/doe/design_folder.hpp"
#include "adapters/doe/folder_engine.hpp"
#include "adapters/system/files/file_lock.hpp"
#include "adapters/system/files/sha256.hpp"
#include "adapters/system/files/write_file.hpp"
#include "daemon/site/calibrate/design_plan.hpp"
#include "daemon/site/calibrate/site_calibration.hpp"
#include "daemon/site/model/energyplus_site.hpp"

namespace recald::daemon {

namespace {

/// Hourly means by `weather::kWeatherVariables`; blanks where there is no value.
std::string weather_text(const weather::WeatherSeries& series) {
  std::string text = "timestamp";
  for (const weather::WeatherVariable& variable : weather::kWeatherVariables) {
    text += fmt::format(",{}", variable.name);
  }
  text += '\n';
  for (std::size_t i = 0; i < series.hours.size(); ++i) {
    text += metering::to_string(series.begin + std::chrono::hours{i});
    for (const weather::WeatherVariable& variable : weather::kWeatherVariables) {
      const double value = series.hours[i].*variable.member;
      text += std::isfinite(value) ? fmt::format(",{:.7g}", value) : ",";
    }
    text += '\n';
  }
  return text;
}

/// The engine has the days of every run that it ever made, so none is made again.
Result<void> keep_days(const std::filesystem::path& folder, const doe::DesignPlan& plan,
                       const doe::FolderEngine& runs, Engine& run_by,
                       const energyplus::EnergyPlusEngine& engine, const ForEachIndex& executor,
                       const Engine::Observer& observer) {
  std::vector<int> ids;
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < plan.theta.rows(); ++i) {
    const int id = static_cast<int>(i) + 1;
    if (runs.failed().contains(id)) continue;
    ids.push_back(id);
    rows.push_back(i);
  }
  TRY(run_by.run(plan.theta(rows, Eigen::all), executor, observer));
  if (const auto failed = run_by.failed_runs(); !failed.empty()) {
    return failure(
        ErrorCode::invalid_value,
        fmt::format("run {} went well once and now fails: {}",
                    ids[static_cast<std::size_t>(failed.front().row)], failed.front().because));
  }
  return doe::write_design_days(folder, ids, plan.output_names, {engine.days(), engine.daily()});
}

constexpr const char* kModelNote = "model.json";

/// Of what a run depends on besides its parameters' values, as far as the site file says it.
std::string settings_digest(const ModelConfig& model) {
  system::Sha256 digest;
  digest.add(fmt::format("{}\n", model.energyplus->interval_noise));
  for (const ParameterConfig& parameter : model.parameters) {
    digest.add(fmt::format("{} {} {}\n", parameter.name, static_cast<int>(parameter.change),
                           fmt::join(parameter.targets, " ")));
    if (parameter.effect) digest.add(parameter.effect->effect);
  }
  return digest.hex();
}

/// Empty where the file is not at hand, as on a gateway.
std::string file_digest(const ModelConfig& model) {
  system::Sha256 digest;
  return digest.add_file(model.energyplus->file) ? digest.hex() : "";
}

/// "Electricity:Facility -Cooling:Electricity"
std::string reports_text(const ModelConfig& model, const std::string& output) {
  const auto reports = model.energyplus->reports.find(output);
  return reports == model.energyplus->reports.end()
             ? ""
             : fmt::format("{}", fmt::join(reports->second, " "));
}

Result<void> note_model(const ModelConfig& model) {
  nlohmann::ordered_json note = {{"settings", settings_digest(model)},
                                 {"file", file_digest(model)}};
  for (const std::string& output : model.outputs) {
    note["reports"][output] = reports_text(model, output);
  }
  return system::write_file(model.energyplus->design / kModelNote, note.dump(2) + "\n");
}

/// The client's model as the runs have it, effects included, at the priors' means: to open and to
/// look at.
Result<void> write_model_copy(const energyplus::EnergyPlusEngine& engine,
                              const std::filesystem::path& folder) {
  const std::vector<Parameter> parameters = engine.parameters();
  const bool has_effects =
      std::ranges::any_of(engine.targeted(), [](const auto& one) { return one.effect != nullptr; });
  if (!has_effects) return {};
  Eigen::VectorXd means(std::ssize(parameters));
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    means[static_cast<Eigen::Index>(j)] = parameters[j].prior.mean();
  }
  return system::write_file(folder / "model-with-effects.epJSON",
                            engine.last_model(means).dump(2) + "\n");
}

}  // namespace

Result<void> require_runs_of(const ModelConfig& model) {
  const std::filesystem::path& folder = model.energyplus->design;
  std::ifstream in{folder / kModelNote};
  if (!in) return {};
  const auto note = nlohmann::json::parse(in, nullptr, /*allow_exceptions=*/false);
  if (!note.is_object()) return {};
  const std::string file = file_digest(model);
  std::string edited;
  if (note.value("settings", "") != settings_digest(model)) {
    edited = "the model's targets, changes or interval_noise";
  } else if (!file.empty() && note.value("file", "") != file) {
    edited = "'" + model.energyplus->file.filename().string() + "'";
  }
  // The site may follow fewer meters than were simulated.
  for (const std::string& output : model.outputs) {
    const auto reports = note.value("reports", nlohmann::json::object());
    const bool is_other =
        reports.contains(output) && reports[output] != reports_text(model, output);
    if (is_other) edited = fmt::format("[model.reports] of '{}'", output);
  }
  if (edited.empty()) return {};
  return failure(ErrorCode::invalid_value,
                 fmt::format("the runs in '{}' were made before {} changed; give the model another "
                             "'design' folder, or delete this one",
                             folder.string(), edited));
}

Result<system::FileLock> lock_runs(const std::filesystem::path& folder) {
  TRY(system::make_folder(folder));
  auto lock = system::FileLock::acquire(folder / "lock");
  if (lock || lock.error().code != ErrorCode::unsupported) return lock;
  return failure(
      ErrorCode::unsupported,
      fmt::format("another recald is making runs in '{}'; wait for it", folder.string()));
}

Result<MadeRuns> make_planned_runs(const std::filesystem::path& folder, const doe::DesignPlan& plan,
                                   Engine& run_by, const energyplus::EnergyPlusEngine& engine,
                                   bool with_days, const ForEachIndex& executor,
                                   const Engine::Observer& observer) {
  auto runs = TRY(doe::FolderEngine::open(folder, plan, &run_by));
  MadeRuns made{.outputs = plan.output_names,
                .months = plan.months.size(),
                .total = static_cast<int>(plan.theta.rows()),
                .before = runs.done_count()};
  for (const Parameter& parameter : plan.parameters) made.parameters.push_back(parameter.name);
  TRY(runs.run(plan.theta, executor, observer));
  made.failed = static_cast<int>(runs.failed().size());
  if (made.failed == made.total) {
    return failure(ErrorCode::invalid_value, fmt::format("every run failed, the first because: {}",
                                                         runs.failed().begin()->second));
  }
  std::error_code ignored;
  const bool has_days = std::filesystem::exists(doe::days_file(folder), ignored);
  if (with_days && (made.before < made.total || !has_days)) {
    TRY(keep_days(folder, plan, runs, run_by, engine, executor, observer));
  }
  return made;
}

bool has_all_runs(const SiteConfig& site) {
  return require_runs_of(*site.model) &&
         doe::read_design_folder(site.model->energyplus->design).has_value();
}

Result<MadeRuns> make_runs(const ModelledSite& modelled, const RunsOptions& options,
                           const ForEachIndex& executor,
                           const std::function<bool(int, int)>& observer) {
  const SiteConfig& site = modelled.site.config;
  ModelConfig model = *site.model;
  if (!options.folder.empty()) model.energyplus->design = options.folder;
  const std::filesystem::path& folder = model.energyplus->design;
  auto begun = TRY(begin_site(site, modelled.recording, modelled.weather));
  PreparedSite prepared{.so_far = std::move(begun.so_far)};
  add_inputs(modelled.site.calendar, modelled.weather, begun.months, prepared);
  prepared.problem.month_names = prepared.so_far.month_names;
  std::ranges::sort(prepared.problem.month_names);

  const auto lock = TRY(lock_runs(folder));
  std::vector<std::string> notes;
  auto months = begun.months.in_order();
  auto weather =
      TRY(write_weather_years(modelled.site, modelled.weather, months, folder / kWeatherYears));
  auto engine = TRY(make_energyplus_engine(
      modelled.site, model, {std::move(months), std::move(weather)}, {},
      [&] { return !observer || observer(0, 0); }, notes));
  prepared.so_far.parameters = engine->parameters();
  const doe::DesignPlan plan =
      plan_design(prepared, {.runs = options.runs > 0 ? options.runs : model.energyplus->runs,
                             .seed = options.seed,
                             .points = options.points,
                             .fingerprint = engine->fingerprint()});
  // Runs to check with are not calibrated on.
  const bool is_design = options.points == design::Points::wide;
  auto made = make_planned_runs(folder, plan, *engine, *engine, is_design, executor, observer);
  if (!made) return made;
  if (is_design) {
    TRY(system::write_file(folder / kRunsWeather, weather_text(modelled.weather.filled.series)));
  }
  TRY(note_model(model));
  TRY(write_model_copy(*engine, folder));
  made->notes = std::move(notes);
  return made;
}

}  // namespace recald::daemon
