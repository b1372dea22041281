#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "adapters/energyplus/contents.hpp"
#include "adapters/energyplus/model/component_sizes.hpp"
#include "adapters/energyplus/run/simulation.hpp"
#include "adapters/epw/epw_writer.hpp"
#include "adapters/system/files/scratch_folder.hpp"
#include "adapters/system/files/write_file.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/interrupt.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/model/energyplus_site.hpp"

namespace recald::daemon {
namespace {

using energyplus::KnownParameter;
using energyplus::ReportedMeter;
using energyplus::VariableField;

constexpr int kTrialYear = 2021;

struct Contents {
  std::vector<ReportedMeter> meters;
  std::vector<VariableField> fields;
  std::vector<KnownParameter> parameters;
};

/// A mild year without sun: what a model has does not depend on the weather.
Result<std::filesystem::path> write_mild_weather(const OpenSite& site,
                                                 const std::filesystem::path& folder) {
  using namespace std::chrono;
  weather::WeatherSeries mild{sys_days{year{kTrialYear} / 1 / 1} - days{2}, {}};
  mild.hours.assign(
      24 * 369,
      {.dry_bulb_C = 15.0, .rel_humidity_pct = 60.0, .wind_speed_m_s = 2.0, .ghi_W_m2 = 0.0});
  const auto text =
      TRY(epw::epw_text(mild, kTrialYear, *site.config.location, site.calendar, {}, "-"));
  const std::filesystem::path file = folder / "mild.epw";
  TRY(system::write_file(file, text));
  return file;
}

/// Runs a day of the model, which tells its meters and the sizes of its plant.
Result<Contents> contents_of(const OpenSite& site, const EnergyPlusConfig& config,
                             const std::function<bool()>& keep_going) {
  auto opened = TRY(open_energyplus(config));
  const auto scratch = TRY(system::ScratchFolder::make());
  const auto weather = TRY(write_mild_weather(site, scratch.path()));
  const metering::Day day = std::chrono::year{kTrialYear} / 1 / 4;
  energyplus::Json objects = opened.model.objects;
  energyplus::prepare_objects({.first = day, .last = day, .meters = {}}, objects);
  energyplus::ask_for_meters(objects);
  const std::filesystem::path folder = scratch.path() / "run";
  const auto sql = TRY(energyplus::simulate(objects, weather, folder, opened.program,
                                            {.time_max = config.time_max}, keep_going));
  auto meters = TRY(energyplus::what_is_reported(folder));
  const auto sizes = TRY(energyplus::read_component_sizes(sql));
  energyplus::freeze_sizes(sizes, opened.model.objects);
  return Contents{std::move(meters), energyplus::what_could_be_varied(opened.model),
                  energyplus::known_parameters(opened.model)};
}

std::string contents_words(const EnergyPlusConfig& config, const Contents& contents) {
  std::string text =
      fmt::format("# What {} reports, for [model.reports]:\n", config.file.filename().string());
  int of_parts = 0;
  for (const ReportedMeter& meter : contents.meters) {
    const bool is_of_a_part =
        meter.where.starts_with("Zone:") || meter.where.starts_with("SpaceType:");
    if (is_of_a_part) {
      ++of_parts;
    } else {
      text += fmt::format("#   {}\n", meter.name);
    }
  }
  if (of_parts > 0) text += fmt::format("#   and {} of single zones, with --json\n", of_parts);
  text += "#\n# Numbers that could be varied: how many there are, the smallest and the largest\n";
  for (const VariableField& field : contents.fields) {
    text += fmt::format("#   {:<64} {:>5}  {:.4g} to {:.4g}\n", field.pattern, field.objects,
                        field.smallest, field.largest);
  }
  text += "#\n# Parameters of the library that the model has, to paste into the site file:\n";
  for (const KnownParameter& parameter : contents.parameters) {
    text += "\n" + energyplus::paste_lines(parameter);
  }
  return text;
}

std::string contents_json(const EnergyPlusConfig& config, const Contents& contents) {
  nlohmann::ordered_json json = {{"file", config.file.string()}};
  for (const ReportedMeter& meter : contents.meters) json["meters"].push_back(meter.name);
  for (const VariableField& field : contents.fields) {
    json["fields"].push_back({{"pattern", field.pattern},
                              {"objects", field.objects},
                              {"smallest", field.smallest},
                              {"largest", field.largest}});
  }
  for (const KnownParameter& known : contents.parameters) {
    const Prior& prior = known.parameter.prior;
    json["parameters"].push_back({{"name", known.parameter.name},
                                  {"unit", known.parameter.unit},
                                  {"label", known.label},
                                  {"group", known.group},
                                  {"prior", {prior.min(), prior.mode(), prior.max()}}});
  }
  return json.dump(2) + "\n";
}

}  // namespace

int run_engine_show(const EngineArguments& arguments, const Console& console) {
  auto site = open_site(arguments.site);
  if (!site) return console.fail(site.error());
  if (auto modelled = require_model(site->config); !modelled) {
    return console.fail(modelled.error());
  }
  if (auto chosen = choose_model(site->config, ModelKind::energyplus); !chosen) {
    return console.fail(chosen.error());
  }
  const EnergyPlusConfig& config = *site->config.model->energyplus;
  const InterruptGuard guard;
  const auto contents = contents_of(*site, config, [&] { return !guard.interrupted(); });
  if (!contents) return console.fail(contents.error());
  console.out << (arguments.json ? contents_json(config, *contents)
                                 : contents_words(config, *contents));
  return kSuccess;
}

}  // namespace recald::daemon
