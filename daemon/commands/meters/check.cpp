#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>

#include "adapters/csv/fields.hpp"
#include "adapters/system/files/regular_file.hpp"
#include "adapters/table/cells/header_units.hpp"
#include "core/model/parameter_library.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/meters/check_alerts.hpp"
#include "daemon/commands/meters/check_meters.hpp"
#include "daemon/commands/open_site.hpp"
#include "daemon/site/calibrate/site_runs.hpp"
#include "daemon/site/config/weather_sensors.hpp"
#include "daemon/site/model/energyplus_site.hpp"
#include "daemon/site/model/site_parts.hpp"
#include "daemon/site/replay/recording.hpp"
#include "daemon/site/replay/site_weather.hpp"

namespace recald::daemon {
namespace {

std::string duration_words(std::chrono::seconds length) {
  if (length.count() % 3600 == 0) return fmt::format("{} h", length.count() / 3600);
  if (length.count() % 60 == 0) return fmt::format("{} min", length.count() / 60);
  return fmt::format("{} s", length.count());
}

/// The rows of a recorded meter in its file, or its columns: "Day + Night".
std::string parts_words(const MeterConfig& config) {
  const bool is_of_columns = config.table && config.table->shape.meter_column.empty();
  std::vector<std::string> parts{is_of_columns ? config.table->column : config.name_in_file};
  const auto& further = is_of_columns ? config.table->further_columns : config.further_names;
  parts.insert(parts.end(), further.begin(), further.end());
  return fmt::format("{}", fmt::join(parts, " + "));
}

void print_meters(const SiteConfig& site, const Console& console) {
  for (const MeterConfig& config : site.meters) {
    const metering::Meter& meter = config.meter;
    if (config.live) {
      console.out << fmt::format("  meter {:<16} {:<14} unit {} on bus '{}', {}, every {}\n",
                                 meter.id, metering::to_string(meter.utility), config.live->unit,
                                 config.live->bus, config.live->map.title,
                                 duration_words(config.live->poll));
      continue;
    }
    if (config.source == MeterSource::mqtt) {
      const auto& first = config.mqtt->energy ? config.mqtt->energy : config.mqtt->power;
      console.out << fmt::format("  meter {:<16} {:<14} messages of topic '{}'\n", meter.id,
                                 metering::to_string(meter.utility), first->topic);
      continue;
    }
    if (config.source == MeterSource::http) {
      console.out << fmt::format("  meter {:<16} {:<14} pushed, {}interval {}\n", meter.id,
                                 metering::to_string(meter.utility),
                                 config.counter ? "a counter, " : "",
                                 duration_words(meter.interval));
      continue;
    }
    if (config.source == MeterSource::sum) {
      console.out << fmt::format("  meter {:<16} {:<14} {}\n", meter.id,
                                 metering::to_string(meter.utility), sum_words(config));
      continue;
    }
    console.out << fmt::format(
        "  meter {:<16} {:<14} {} ('{}', {}-stamped, interval {})\n", meter.id,
        metering::to_string(meter.utility), files_words(config.files), parts_words(config),
        config.stamps == csv::Stamps::end ? "end" : "start",
        config.interval ? duration_words(*config.interval) : "as in the file");
  }
}

/// "dry_bulb_C, ghi_W_m2" of a sensor that is polled.
std::string quantity_names(const MeterConfig& sensor) {
  std::string names;
  for (const auto* const quantity : quantities_of(sensor)) {
    names += (names.empty() ? "" : ", ") + std::string{quantity->name};
  }
  return names;
}

void print_sensors(const SiteConfig& site, const Console& console) {
  for (const MeterConfig& sensor : site.sensors) {
    const std::string how =
        sensor.live
            ? fmt::format("unit {} on bus '{}', {}: {}, every {}", sensor.live->unit,
                          sensor.live->bus, sensor.live->map.title, quantity_names(sensor),
                          duration_words(sensor.live->poll))
            : fmt::format(
                  "pushed, interval {}{}; units {}", duration_words(sensor.meter.interval),
                  sensor.values == weather::RecordedValues::instant ? ", values at the stamp" : "",
                  weather::quantity_units());
    console.out << fmt::format("  meter {:<16} {:<14} {}\n", sensor.meter.id, "weather", how);
  }
}

void print_weather(const WeatherConfig& config, const weather::ValuesTaken& taken,
                   const Console& console) {
  console.out << fmt::format(
      "  weather {} ({}-stamped, temperature, humidity, wind and pressure: {})\n",
      files_words(config.files),
      config.format == WeatherFormat::epw || config.stamps == csv::Stamps::end ? "end" : "start",
      to_string(taken));
}

/// How much of its time each bus is busy if all goes well. Beyond all of it reads queue without
/// end.
std::vector<std::string> check_buses(const SiteConfig& site, const Console& console, bool json) {
  constexpr double kCrowded = 0.7;
  std::vector<std::string> problems;
  std::map<std::string_view, std::vector<const LiveMeterConfig*>> meters;  // by bus
  for (const auto* const list : {&site.meters, &site.sensors}) {
    for (const MeterConfig& meter : *list) {
      if (meter.live) meters[meter.live->bus].push_back(&*meter.live);
    }
  }
  for (const BusConfig& bus : site.buses) {
    double busy = 0.0;
    for (const LiveMeterConfig* meter : meters[bus.name]) {
      const std::chrono::duration<double> length = poll_time(bus, *meter);
      busy += length / meter->poll;
    }
    if (!json) {
      console.out << fmt::format("  bus {:<18} {}, busy {:.0f} % of its time\n", bus.name,
                                 modbus::to_string(bus.endpoint), 100.0 * busy);
    }
    if (busy > 1.0) {
      problems.push_back(
          fmt::format("{}: bus '{}' would need {:.0f} % of its time; poll less often, "
                      "raise the baud rate or spread the meters over more buses",
                      site.file.filename().string(), bus.name, 100.0 * busy));
    } else if (busy > kCrowded) {
      console.err << fmt::format(
          "recald: bus '{}' is busy {:.0f} % of its time; retries and silent "
          "devices leave little room\n",
          bus.name, 100.0 * busy);
    }
  }
  return problems;
}

void print_parameter(const Parameter& parameter, const Console& console) {
  const Prior& prior = parameter.prior;
  console.out << fmt::format("  parameter {:<20} triangular {:.4g} / {:.4g} / {:.4g} {}\n",
                             parameter.name, prior.min(), prior.mode(), prior.max(),
                             parameter.unit);
}

/// Of a model of the site's [building]. @return sentences
std::vector<std::string> check_built_in(const SiteConfig& site, const Console& console, bool json) {
  std::vector<std::string> problems;
  if (const auto maps = meter_maps(site); !maps) problems.push_back(maps.error().message);
  for (const ParameterConfig& config : site.model->parameters) {
    const auto definition = model::find_parameter(config.name);
    const auto parameter = model::make_parameter(**definition, *site.building, config.prior);
    if (!parameter) {
      problems.push_back(parameter.error().message);
    } else if (!json) {
      print_parameter(*parameter, console);
    }
  }
  return problems;
}

/// Of a client's model: whether it can be run, unless its runs are there. @return sentences
std::vector<std::string> check_energyplus(const SiteConfig& site, const Console& console,
                                          bool json) {
  const ModelConfig& model = *site.model;
  if (auto runnable = require_runnable(model); !runnable) return {runnable.error().message};
  if (has_all_runs(site)) {
    if (!json) console.out << "  runs      " << model.energyplus->design.string() << "\n";
    return {};
  }
  const auto opened = open_energyplus(*model.energyplus);
  if (!opened) return {opened.error().message};
  std::vector<std::string> problems;
  for (const ParameterConfig& config : model.parameters) {
    const auto found = find_parameters(opened->model, {config});
    if (found) {
      if (!json) print_parameter(found->front().parameter, console);
      continue;
    }
    // A flow that is autosized is a number once the model has been tried.
    const ErrorCode code = found.error().code;
    const bool is_known = code == ErrorCode::not_found || code == ErrorCode::malformed;
    if (is_known) problems.push_back(found.error().message);
  }
  return problems;
}

/// Problems that only show once several tables are seen together.
std::vector<std::string> check_models(SiteConfig site, const Console& console, bool json) {
  std::vector<std::string> problems;
  std::vector<ModelConfig> models{*site.model};
  models.insert(models.end(), site.other_models.begin(), site.other_models.end());
  for (ModelConfig& model : models) {
    site.model = std::move(model);
    const bool is_of_building = facts_of(site.model->kind).is_of_building;
    for (const std::string& sentence : is_of_building ? check_built_in(site, console, json)
                                                      : check_energyplus(site, console, json)) {
      problems.push_back(site.file.filename().string() + ": " + sentence);
    }
  }
  return problems;
}

/// Pushed meters come in by HTTP alone.
std::vector<std::string> check_pushed(const SiteConfig& site) {
  if (site.http) return {};
  for (const auto* const list : {&site.meters, &site.sensors}) {
    const auto pushed = std::ranges::find(*list, MeterSource::http, &MeterConfig::source);
    if (pushed != list->end()) return {nowhere_to_push(site, *pushed)};
  }
  return {};
}

/// What the models will miss in the weather: a problem where the site has one, else good to know.
std::vector<std::string> check_weather(const SiteConfig& site, const Console& console) {
  if (!site.weather) return {};
  const bool has_all = std::ranges::all_of(site.weather->files, [](const auto& file) {
    return system::require_file(file, "the weather file").has_value();
  });
  if (!has_all) return {};
  const auto lack = lack_of_weather(site);
  if (!lack) return {site.file.filename().string() + ": " + lack.error().message};
  if (site.model && !lack->sentence.empty()) {
    return {site.file.filename().string() + ": " + lack->sentence};
  }
  for (const std::string& words : {lack->sentence, assumed_words(lack->assumed)}) {
    if (!words.empty()) console.err << "recald: " << words << "\n";
  }
  return {};
}

bool has_weather_file(const SiteConfig& site) {
  return site.weather && !site.weather->files.empty();
}

std::vector<std::string> check_files(const SiteConfig& site) {
  std::vector<std::string> problems;
  const auto require = [&](const std::filesystem::path& file, std::string_view what) {
    const auto is_file = system::require_file(file, what);
    if (is_file) return;
    problems.push_back(
        fmt::format("{}: {}", site.file.filename().string(), is_file.error().message));
  };
  for (const MeterConfig& config : site.meters) {
    for (const std::filesystem::path& file : config.files) {
      require(file, fmt::format("the file of meter '{}',", config.meter.id));
    }
  }
  if (!site.weather) return problems;
  for (const auto& file : site.weather->files) require(file, "the weather file");
  return problems;
}

/// What a site file says against the header of its column, and readings from days to come.
std::vector<std::string> doubts_of(const MeterConfig& config, const MeterRecord& record) {
  std::vector<std::string> doubts;
  if (config.table && !config.table->unit.empty()) {
    const std::string header = table::split_unit(config.table->column).unit;
    const auto said = metering::find_unit(header, config.meter.utility, config.units);
    const auto told = metering::find_unit(config.table->unit, config.meter.utility, config.units);
    if (said && told && (said->is_rate != told->is_rate || said->factor != told->factor)) {
      doubts.push_back(fmt::format("its unit is \"{}\", while the header of its column says {}: {}",
                                   config.table->unit, header,
                                   csv::in_quotes(config.table->column)));
    }
  }
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  if (record.rows.span && record.rows.span->end > now + std::chrono::days{1}) {
    doubts.push_back(
        fmt::format("its readings go on until {}, which is yet to come; is the order of its dates "
                    "(time_format) right?",
                    metering::to_string(record.rows.span->end)));
  }
  return doubts;
}

/// What `replay` would refuse of the meters' files. @param refused  Becomes how many lines.
std::vector<std::string> check_readings(const SiteConfig& site, const Console& console,
                                        std::uint64_t& refused) {
  const auto calendar = metering::LocalCalendar::open(site.timezone);
  if (!calendar) return {calendar.error().message};
  VirtualClock clock{metering::Instant{}};
  const auto recording = replay_meters(site, *calendar, {}, clock, {});
  if (!recording) return {site.file.filename().string() + ": " + recording.error().message};
  print_line_words(*recording, console);
  for (const FileIssues& file : recording->files) refused += file.issues.total;
  for (std::size_t i = 0; i < recording->meters.size(); ++i) {
    const MeterRecord& record = recording->meters[i];
    std::vector<std::string> doubts = doubts_of(site.meters[i], record);
    if (!record.doubt.empty()) doubts.push_back(record.doubt);
    doubts.insert(doubts.end(), record.series_doubts.begin(), record.series_doubts.end());
    for (const std::string& doubt : doubts) {
      console.err << fmt::format("! {}: {}\n", record.meter.id, doubt);
    }
  }
  return {};
}

}  // namespace

int run_check(const CheckArguments& arguments, const Console& console) {
  const auto site = load_site(arguments.site);
  std::vector<std::string> problems = site ? check_files(*site) : site.error();
  std::optional<weather::ValuesTaken> weather;
  if (site && has_weather_file(*site) && problems.empty()) {
    const auto taken = weather_values(*site);
    if (taken) weather = *taken;
    if (!taken) problems.push_back(site->file.filename().string() + ": " + taken.error().message);
  }
  if (site && !arguments.json) {
    console.out << fmt::format("{} ({}), {}\n", site->name, site->id, site->timezone);
    print_meters(*site, console);
    print_sensors(*site, console);
    if (weather) print_weather(*site->weather, *weather, console);
  }
  if (site) {
    for (const auto& more : {check_pushed(*site), check_weather(*site, console)}) {
      problems.insert(problems.end(), more.begin(), more.end());
    }
  }
  if (site) {
    const auto more = check_buses(*site, console, arguments.json);
    problems.insert(problems.end(), more.begin(), more.end());
  }
  std::uint64_t refused = 0;
  if (site && problems.empty()) {
    const auto more = check_readings(*site, console, refused);
    problems.insert(problems.end(), more.begin(), more.end());
  }
  if (site && site->model) {
    const auto more = check_models(*site, console, arguments.json);
    problems.insert(problems.end(), more.begin(), more.end());
  }
  nlohmann::ordered_json meters = nlohmann::ordered_json::array();
  // Nobody is disturbed for a file that has to be mended anyway.
  if (site && arguments.meters && problems.empty()) {
    const auto tell = [&](const TriedMeter& tried) {
      if (!arguments.json) print_trial(tried, console);
      meters.push_back(json_of(tried));
      const auto more = problems_of(tried);
      problems.insert(problems.end(), more.begin(), more.end());
    };
    if (try_meters(*site, tell).empty()) {
      problems.push_back(
          fmt::format("{}: no [[meter]] has source = \"modbus\", so there is no meter to try",
                      site->file.filename().string()));
    }
  }
  if (site && arguments.alerts && problems.empty()) {
    const auto more = try_alerts(*site, console, arguments.json);
    problems.insert(problems.end(), more.begin(), more.end());
  }
  if (arguments.json) {
    nlohmann::ordered_json result{{"ok", problems.empty()}, {"problems", problems}};
    if (refused > 0) result["lines_to_look_at"] = refused;
    if (weather) result["weather_values"] = to_string(*weather);
    if (arguments.meters) result["meters"] = meters;
    console.out << result.dump(2) << "\n";
  }
  if (!problems.empty()) return console.fail(problems);
  if (!arguments.json) console.out << "ok\n";
  return kSuccess;
}

}  // namespace recald::daemon
