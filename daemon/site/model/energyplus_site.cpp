#include "daemon/site/model/energyplus_site.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "adapters/energyplus/known_parameters.hpp"
#include "adapters/energyplus/read_model.hpp"
#include "adapters/energyplus/trial.hpp"
#include "adapters/epw/epw_writer.hpp"
#include "adapters/system/files/write_file.hpp"

namespace recald::daemon {
namespace {

using metering::Instant;
using metering::Month;

/// What a run of EnergyPlus may touch: said, so that a pattern that means too much is seen.
constexpr std::size_t kManyFields = 200;

Result<energyplus::TargetedParameter> find_parameter_in(const energyplus::ModelDocument& model,
                                                        const ParameterConfig& config) {
  if (config.targets.empty()) {
    auto known = TRY(energyplus::find_known_parameter(model, config.name, config.prior));
    return energyplus::TargetedParameter{std::move(known)};
  }
  energyplus::TargetedParameter found{{config.name, config.unit, *config.prior},
                                      {},
                                      config.change,
                                      config.change == model::ChangeKind::scale ? 1.0 : 0.0};
  for (const std::string& pattern : config.targets) {
    auto target = energyplus::find_target(model, pattern);
    if (!target) {
      return failure(target.error().code,
                     fmt::format("parameter '{}': {}", config.name, target.error().message));
    }
    found.targets.push_back(std::move(*target));
  }
  return found;
}

Result<std::shared_ptr<const energyplus::ModelEffect>> find_effect_in(
    const energyplus::ModelDocument& model, const EffectOfModel& effect) {
  auto patch = TRY(energyplus::find_effect_patch(model, effect.effect, effect.parameters));
  return std::make_shared<const energyplus::ModelEffect>(
      energyplus::ModelEffect{std::move(patch), effect.parameters.size(), effect.from, effect.to});
}

void note_wide_targets(const std::vector<energyplus::TargetedParameter>& parameters,
                       std::vector<std::string>& notes) {
  for (const energyplus::TargetedParameter& one : parameters) {
    for (const energyplus::Target& target : one.targets) {
      if (target.fields.size() < kManyFields) continue;
      notes.push_back(fmt::format("{}: '{}' changes {} fields of the model.", one.parameter.name,
                                  target.pattern, target.fields.size()));
    }
  }
}

/// Daily average, then peak, of each output. @pre `require_runnable`
std::vector<energyplus::ModelOutput> outputs_of(const ModelConfig& model) {
  std::vector<energyplus::ModelOutput> outputs;
  for (const std::string& id : model.outputs) {
    energyplus::ModelOutput output{id, {}, false};
    for (const std::string& text : model.energyplus->reports.at(id)) {
      output.meters.push_back(energyplus::parse_signed_meter(text));
    }
    outputs.push_back(output);
    output.is_peak = true;
    output.interval_noise = model.energyplus->interval_noise;
    outputs.push_back(std::move(output));
  }
  return outputs;
}

void note_left_sizes(const energyplus::FrozenSizes& sizes, std::vector<std::string>& notes) {
  if (sizes.left.empty()) return;
  notes.push_back(fmt::format(
      "{} autosized field{} of the model could not be given a fixed size (such as {}): runs with "
      "other parameters may have another plant.",
      sizes.left.size(), sizes.left.size() == 1 ? "" : "s", sizes.left.front()));
}

/// That hour, or the same of the nearest day that has all that a model needs; null: none has.
const weather::WeatherHour* complete_hour(const weather::WeatherSeries& known, Instant at) {
  const auto is_complete = [](const weather::WeatherHour* hour) {
    return hour != nullptr && std::ranges::all_of(kNeededWeather, [&](std::size_t variable) {
             return std::isfinite(hour->*weather::kWeatherVariables[variable].member);
           });
  };
  const auto length = known.end() - known.begin;
  for (std::chrono::hours apart{0}; apart <= length; apart += std::chrono::hours{24}) {
    for (const Instant day : {at - apart, at + apart}) {
      if (const weather::WeatherHour* hour = known.find(day); is_complete(hour)) return hour;
    }
  }
  return nullptr;
}

/// The weather of a whole calendar year, in the zone's standard time and a day on either side.
weather::WeatherSeries whole_year(const weather::WeatherSeries& known, int year,
                                  const metering::LocalCalendar& calendar) {
  const auto offset = calendar.standard_offset(std::chrono::year{year});
  const Instant begin =
      std::chrono::sys_days{std::chrono::year{year} / 1 / 1} - offset - std::chrono::hours{24};
  const Instant end =
      std::chrono::sys_days{std::chrono::year{year + 1} / 1 / 1} - offset + std::chrono::hours{24};
  weather::WeatherSeries whole{std::chrono::floor<std::chrono::hours>(begin), {}};
  for (Instant hour = whole.begin; hour < end; hour += std::chrono::hours{1}) {
    Instant from = hour;
    // The same hour of the nearest day that is known.
    if (from < known.begin) from += std::chrono::ceil<std::chrono::days>(known.begin - from);
    if (from >= known.end()) {
      from -= std::chrono::floor<std::chrono::days>(from - known.end()) + std::chrono::days{1};
    }
    const weather::WeatherHour* found = complete_hour(known, from);
    whole.hours.push_back(found == nullptr ? weather::WeatherHour{} : *found);
  }
  return whole;
}

}  // namespace

Result<void> require_runnable(const ModelConfig& model) {
  for (const std::string& output : model.outputs) {
    const auto report = model.energyplus->reports.find(output);
    if (report != model.energyplus->reports.end()) continue;
    return failure(
        ErrorCode::invalid_value,
        fmt::format("[model.reports] does not say which meters of the EnergyPlus model '{}' is; "
                    "`recald engine show` lists what there is, such as {} = "
                    "[\"Electricity:Facility\"]",
                    output, output));
  }
  if (!model.parameters.empty()) return {};
  return failure(ErrorCode::invalid_value,
                 "the EnergyPlus model has no [[model.parameter]] to calibrate; `recald engine "
                 "show` lists what could be varied, as lines to paste");
}

Result<EnergyPlusSite> open_energyplus(const EnergyPlusConfig& config) {
  auto program = TRY(energyplus::find_program(config.program));
  auto document = TRY(energyplus::read_model(config.file, program));
  energyplus::prepare_for_parameters(document);
  return EnergyPlusSite{std::move(program), std::move(document)};
}

Result<std::vector<energyplus::TargetedParameter>> find_parameters(
    const energyplus::ModelDocument& document, const std::vector<ParameterConfig>& parameters) {
  std::vector<energyplus::TargetedParameter> all;
  std::map<const EffectOfModel*, std::shared_ptr<const energyplus::ModelEffect>> effects;
  for (const ParameterConfig& parameter : parameters) {
    if (!parameter.effect) {
      auto found = TRY(find_parameter_in(document, parameter));
      all.push_back(std::move(found));
      continue;
    }
    auto& effect = effects[parameter.effect.get()];
    if (!effect) {
      effect = TRY(find_effect_in(document, *parameter.effect));
    }
    all.push_back({.parameter = {parameter.name, parameter.unit, *parameter.prior},
                   .targets = {},
                   .effect = effect});
  }
  return all;
}

Result<std::map<int, std::filesystem::path>> write_weather_years(
    const OpenSite& site, const SiteWeather& weather, const std::vector<Month>& months,
    const std::filesystem::path& folder) {
  TRY(system::make_folder(folder));
  std::map<int, std::filesystem::path> files;
  for (const Month month : months) {
    const int year = static_cast<int>(month.year());
    if (files.contains(year)) continue;
    const auto text = TRY(epw::epw_text(whole_year(weather.filled.series, year, site.calendar),
                                        year, *site.config.location, site.calendar,
                                        site.config.holidays, site.config.name));
    const auto file = folder / fmt::format("{}.epw", year);
    TRY(system::write_file(file, text));
    files[year] = file;
  }
  return files;
}

Result<std::unique_ptr<energyplus::EnergyPlusEngine>> make_energyplus_engine(
    const OpenSite& site, const ModelConfig& model, RunMonths months,
    const std::vector<ParameterConfig>& beside, const std::function<bool()>& keep_going,
    std::vector<std::string>& notes) {
  TRY(require_runnable(model));
  auto opened = TRY(open_energyplus(*model.energyplus));
  const std::filesystem::path runs = model.energyplus->design / "runs";
  const energyplus::RunLimits limits{.time_max = model.energyplus->time_max};
  std::vector<energyplus::ModelOutput> outputs = outputs_of(model);
  const Month first = months.months.front();
  auto tried = TRY(energyplus::try_model(opened.model, energyplus::meters_of(outputs), first / 1,
                                         months.weather.at(static_cast<int>(first.year())), runs,
                                         opened.program, limits, keep_going));
  note_left_sizes(tried.sizes, notes);
  std::vector<ParameterConfig> columns = model.parameters;
  columns.insert(columns.end(), beside.begin(), beside.end());
  auto parameters = TRY(find_parameters(tried.model, columns));
  note_wide_targets(parameters, notes);
  return energyplus::EnergyPlusEngine::make({.model = std::move(tried.model),
                                             .parameters = std::move(parameters),
                                             .outputs = std::move(outputs),
                                             .months = std::move(months.months),
                                             .weather = std::move(months.weather),
                                             .peak_window = site.config.interval,
                                             .program = std::move(opened.program),
                                             .limits = limits,
                                             .folder = runs},
                                            site.calendar);
}

}  // namespace recald::daemon
