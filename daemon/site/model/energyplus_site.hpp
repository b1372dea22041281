/// The EnergyPlus model of a site: opened, checked against the site file, and ready to run.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "adapters/energyplus/energyplus_engine.hpp"
#include "adapters/energyplus/run/program.hpp"
#include "core/metering/civil_time.hpp"
#include "core/result.hpp"
#include "daemon/site/config/site_config.hpp"
#include "daemon/site/model/modelled_site.hpp"
#include "daemon/site/replay/site_weather.hpp"

namespace recald::daemon {

/// The client's model and the program that runs it.
struct EnergyPlusSite {
  energyplus::Program program;
  energyplus::ModelDocument model;
};

/// Whether the site file says all that a run needs: parameters, and what each output is made of.
/// @pre the model is of this kind
[[nodiscard]] Result<void> require_runnable(const ModelConfig& model);

/// Finds the program and reads the model.
/// @return as `find_program`, `read_model`.
[[nodiscard]] Result<EnergyPlusSite> open_energyplus(const EnergyPlusConfig& config);

/// Each parameter of the site file in the model.
/// @return as `find_target`; not_found, unsupported: the model has no such quantity.
[[nodiscard]] Result<std::vector<energyplus::TargetedParameter>> find_parameters(
    const energyplus::ModelDocument& document, const std::vector<ParameterConfig>& parameters);

/// The measured weather as an EPW file for each calendar year of these months. Hours of the year
/// outside the weather repeat its nearest days: no month that is asked for has any.
/// @param folder  The files are YEAR.epw in it.
/// @return the files by year; or not_enough_data, io_failed.
[[nodiscard]] Result<std::map<int, std::filesystem::path>> write_weather_years(
    const OpenSite& site, const SiteWeather& weather, const std::vector<metering::Month>& months,
    const std::filesystem::path& folder);

/// Months to simulate, and an EPW file for each of their calendar years.
struct RunMonths {
  std::vector<metering::Month> months;  ///< Ascending.
  std::map<int, std::filesystem::path> weather;
};

/// Tries the model for a day, freezes its sizes, and makes the engine. Runs and the trial are kept
/// in the model's design folder.
/// @param beside  Columns behind the model's parameters.
/// @param notes   Gets what should be known of the model, in words.
/// @return or the errors of the steps; cancelled.
[[nodiscard]] Result<std::unique_ptr<energyplus::EnergyPlusEngine>> make_energyplus_engine(
    const OpenSite& site, const ModelConfig& model, RunMonths months,
    const std::vector<ParameterConfig>& beside, const std::function<bool()>& keep_going,
    std::vector<std::string>& notes);

}  // namespace recald::daemon
