#include "adapters/energyplus/run/simulation.hpp"

#include <fmt/format.h>

#include <string_view>

#include "adapters/energyplus/run/error_file.hpp"
#include "adapters/system/child_process.hpp"
#include "adapters/system/files/write_file.hpp"

namespace recald::energyplus {
namespace {

constexpr std::string_view kModelFile = "in.epJSON";
constexpr std::string_view kOutputFile = "eplusout.sql";

/// The older files that EnergyPlus writes unless told not to. Those of later versions are left out,
/// because an older version would refuse to know them.
constexpr std::string_view kUnwantedFiles[] = {
    "output_csv",   "output_mtr", "output_eso", "output_eio",    "output_tabular", "output_json",
    "output_audit", "output_dxf", "output_bnd", "output_rdd",    "output_mdd",     "output_mtd",
    "output_shd",   "output_dfs", "output_edd", "output_perflog"};

bool is_output(std::string_view type) { return type.starts_with("Output"); }

Json run_period(const RunRequest& request, const Json& objects) {
  Json period = Json::object();
  // Whether summer time and holidays come from the weather file is the model's own choice.
  const auto known = objects.find("RunPeriod");
  if (known != objects.end() && known->is_object() && !known->empty()) period = known->front();
  period.erase("day_of_week_for_start_day");
  period["begin_year"] = static_cast<int>(request.first.year());
  period["begin_month"] = static_cast<unsigned>(request.first.month());
  period["begin_day_of_month"] = static_cast<unsigned>(request.first.day());
  period["end_year"] = static_cast<int>(request.last.year());
  period["end_month"] = static_cast<unsigned>(request.last.month());
  period["end_day_of_month"] = static_cast<unsigned>(request.last.day());
  return period;
}

std::string failed_words(const ErrorFile& errors, const system::ChildEnd& ended,
                         const std::filesystem::path& folder) {
  const bool is_killed = ended.ending == system::Ending::killed;
  const std::string words = errors.words();
  if (!words.empty()) {
    const std::size_t others = errors.severe_count > 1 ? errors.severe_count - 1 : 0;
    return fmt::format(
        "EnergyPlus says: {}{}", words,
        others == 0 ? std::string{}
                    : fmt::format(" ({} more in {})", others, (folder / "eplusout.err").string()));
  }
  return fmt::format("EnergyPlus ended with {} {} and without a word; see {}",
                     is_killed ? "signal" : "status", is_killed ? ended.signal : ended.exit_code,
                     (folder / "energyplus.log").string());
}

}  // namespace

void prepare_objects(const RunRequest& request, Json& objects) {
  const Json period = run_period(request, objects);
  for (auto object = objects.begin(); object != objects.end();) {
    object = is_output(object.key()) ? objects.erase(object) : std::next(object);
  }
  objects["RunPeriod"] = {{"recald", period}};
  Json& control = objects["SimulationControl"];
  if (control.empty()) control["recald"] = Json::object();
  for (auto& [name, fields] : control.items()) {
    fields["run_simulation_for_sizing_periods"] = "No";
    fields["run_simulation_for_weather_file_run_periods"] = "Yes";
  }
  Json meters = Json::object();
  for (std::size_t i = 0; i < request.meters.size(); ++i) {
    meters[fmt::format("recald {}", i + 1)] = {{"key_name", request.meters[i]},
                                               {"reporting_frequency", "Timestep"}};
  }
  if (!meters.empty()) objects["Output:Meter"] = std::move(meters);
  objects["Output:SQLite"] = {{"recald", {{"option_type", "Simple"}}}};
  Json& files = objects["OutputControl:Files"]["recald"];
  for (const std::string_view file : kUnwantedFiles) files[std::string{file}] = "No";
  files["output_sqlite"] = "Yes";
}

Result<std::filesystem::path> simulate(const Json& objects, const std::filesystem::path& weather,
                                       const std::filesystem::path& folder, const Program& program,
                                       const RunLimits& limits,
                                       const std::function<bool()>& keep_going) {
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  TRY(system::make_folder(folder));
  TRY(system::write_file(folder / kModelFile, objects.dump()));
  const auto ended =
      TRY(system::run_child({.program = program.executable,
                             .arguments = {"--weather", std::filesystem::absolute(weather).string(),
                                           "--output-directory", ".", std::string{kModelFile}},
                             .folder = folder,
                             .output = folder / "energyplus.log",
                             .time_max = limits.time_max,
                             .memory_max_bytes = limits.memory_max_bytes},
                            keep_going));
  if (ended.ending == system::Ending::stopped) return failure(ErrorCode::cancelled, "stopped");
  if (ended.ending == system::Ending::over_limit) {
    return failure(ErrorCode::out_of_range,
                   fmt::format("EnergyPlus was still running after {} s and was ended; see {}",
                               limits.time_max.count(), (folder / "energyplus.log").string()));
  }
  const ErrorFile errors = read_error_file(folder / "eplusout.err");
  const bool went_well =
      ended.ending == system::Ending::exited && ended.exit_code == 0 && errors.fatal.empty();
  if (went_well) return folder / kOutputFile;
  return failure(ErrorCode::invalid_value, failed_words(errors, ended, folder));
}

}  // namespace recald::energyplus
