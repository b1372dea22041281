#include "daemon/site/config/site_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <set>
#include <utility>

#include "adapters/models/versions_folder.hpp"
#include "adapters/system/files/regular_file.hpp"
#include "adapters/toml/toml_reader.hpp"
#include "core/metering/registers/late_stamps.hpp"
#include "core/model/parameter_library.hpp"
#include "daemon/site/config/building_config.hpp"
#include "daemon/site/config/service/site_path.hpp"
#include "daemon/site/config/tariff_config.hpp"
#include "daemon/site/config/weather_sensors.hpp"

namespace recald::daemon {
namespace {

using std::chrono::seconds;

/// What turns a reading into kWh: a ratio of transformers, a heating value.
constexpr NumberRange kFactor{1e-6, 1e6};

bool is_identifier(std::string_view text) {
  return !text.empty() && text.size() <= 40 && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
}

csv::Stamps read_stamps(TomlReader& table) {
  return table.word("stamps", {"start", "end"}) == "end" ? csv::Stamps::end : csv::Stamps::start;
}

std::optional<weather::RecordedValues> read_values(TomlReader& table) {
  const auto word = table.word("values", {"instant", "mean"});
  if (!word) return {};
  return *word == "mean" ? weather::RecordedValues::mean : weather::RecordedValues::instant;
}

std::optional<seconds> read_interval(TomlReader& table, std::string_view key) {
  const auto interval = table.duration(key);
  if (!interval) return {};
  for (const int minutes : {1, 5, 10, 15, 30, 60}) {
    if (*interval == std::chrono::minutes{minutes}) return interval;
  }
  table.problem_at(key, fmt::format("'{}' must be 1m, 5m, 10m, 15m, 30m or 60m (\"1h\")", key));
  return {};
}

void read_site(TomlReader table, SiteConfig& config) {
  config.id = table.required_text("id");
  if (!config.id.empty() && !is_identifier(config.id)) {
    table.problem_at("id",
                     fmt::format("'id' is \"{}\"; use 1 to 40 of a-z, 0-9, - and _", config.id));
  }
  config.name = table.text_or("name", config.id);
  config.timezone = table.required_text("timezone");
  if (!config.timezone.empty()) {
    if (const auto calendar = metering::LocalCalendar::open(config.timezone); !calendar) {
      table.problem_at("timezone", calendar.error().message);
    }
  }
  if (const auto units = table.word("units", {"SI", "IP"})) {
    config.units = *units == "IP" ? display::UnitSystem::ip : display::UnitSystem::si;
  }
  const auto latitude = table.number("latitude_deg", {-90.0, 90.0});
  const auto longitude = table.number("longitude_deg", {-180.0, 180.0});
  const double altitude_m = table.number_or("altitude_m", 0.0, {-430.0, 6000.0});
  if (latitude && longitude) config.location = {*latitude, *longitude, altitude_m};
  config.interval = read_interval(table, "interval").value_or(config.interval);

  auto& fill = config.closing.closing.fill;
  const std::vector<std::string_view> rules{metering::kFillRules.begin(),
                                            metering::kFillRules.end()};
  if (const auto rule = table.word("fill", rules)) {
    fill.rule = static_cast<metering::FillRule>(std::ranges::find(rules, *rule) - rules.begin());
  }
  fill.daytype = table.boolean("daytype").value_or(false);
  config.closing.closing.coverage_min = table.number_or("coverage_min", 0.6, kShare);
  config.closing.watermark = table.duration("watermark").value_or(config.closing.watermark);
  for (const std::string& text : table.texts("holidays").value_or(std::vector<std::string>{})) {
    const auto day = metering::parse_day(text);
    if (!day) {
      table.problem_at("holidays", "'holidays': " + day.error().message);
      continue;
    }
    config.holidays.insert(*day);
    fill.holidays.push_back(*day);
  }
  table.finish();
}

/// @param has_sensors  Then a file is only needed for the time before them.
WeatherConfig read_weather(TomlReader table, const std::filesystem::path& site_file,
                           bool has_sensors) {
  WeatherConfig weather;
  const bool has_none = has_sensors && !table.has("file");
  const auto files = table.one_or_more("file");
  if (!has_none && !table.has("file")) table.problem("'file' is missing");
  for (const std::string& file : files.value_or(std::vector<std::string>{})) {
    weather.files.push_back(resolve(site_file, file, "file", table));
  }
  weather.format =
      table.word("format", {"csv", "epw"}) == "epw" ? WeatherFormat::epw : WeatherFormat::csv;
  if (weather.files.size() > 1 && weather.format != WeatherFormat::epw) {
    table.problem_at("file",
                     "'file' lists several files, which only EPW years may be; add format = "
                     "\"epw\", or put the rows into one CSV file");
  }
  weather.stamps = read_stamps(table);
  weather.values = read_values(table);
  for (const std::string_view key : {"stamps", "values"}) {
    if (!has_none || !table.has(key)) continue;
    table.problem_at(key, fmt::format("'{}' describes a file, but 'file' is missing; the 'values' "
                                      "of a pushed weather sensor belong in its [[meter]]",
                                      key));
  }
  table.finish();
  return weather;
}

void read_peak(TomlReader table, metering::PeakRule& rule) {
  (void)table.word("method", {"block"});
  rule.window = read_interval(table, "window").value_or(rule.window);
  table.finish();
}

std::optional<metering::CounterSettings> read_counter(TomlReader table,
                                                      const std::optional<double>& rated_kW,
                                                      std::string& reset_zone) {
  if (!rated_kW) {
    table.problem("a cumulative counter needs the meter's 'rated_kW', to tell a jump from a load");
  }
  const double modulus =
      table.number_or("modulus", std::numeric_limits<double>::infinity(), kPositive);
  const double resolution = table.number_or("resolution", 0.0, kNotNegative);
  const std::string unit = table.text_or("unit", "kWh");
  const auto resets = table.word("resets", {"day", "month"});
  reset_zone = table.text_or("reset_zone", "");
  if (table.has("reset_zone") && !metering::LocalCalendar::open(reset_zone)) {
    table.problem_at("reset_zone",
                     fmt::format("'reset_zone' is \"{}\", no time zone; it is one like "
                                 "\"Etc/UTC\"",
                                 reset_zone));
  }
  const auto conversion = metering::find_unit(unit, metering::Utility::electricity, {});
  if (!conversion || conversion->is_rate) {
    table.problem_at(
        "unit",
        fmt::format("'unit' is \"{}\"; a counter needs a unit of energy such as kWh or MWh", unit));
    return {};
  }
  table.finish();
  return metering::CounterSettings{.rated_kW = rated_kW.value_or(0.0),
                                   .resolution_kWh = resolution * conversion->factor,
                                   .modulus_kWh = modulus * conversion->factor,
                                   .resets = resets == "day"     ? metering::Resets::daily
                                             : resets == "month" ? metering::Resets::monthly
                                                                 : metering::Resets::never};
}

std::optional<model::MeterMap> read_end_uses(TomlReader& table) {
  const auto names = table.texts("end_uses");
  if (!names) return {};
  model::MeterMap map;
  for (const std::string& name : *names) {
    const auto use = model::parse_end_use(name);
    if (use) {
      map[*use] = 1.0;
    } else {
      table.problem_at("end_uses", "'end_uses': " + use.error().message);
    }
  }
  return map;
}

MeterSource read_source(TomlReader& table) {
  const auto word = table.word("source", {"csv", "modbus", "http", "mqtt"});
  if (word == "modbus") return MeterSource::modbus;
  if (word == "mqtt") return MeterSource::mqtt;
  return word == "http" ? MeterSource::http : MeterSource::csv;
}

/// "main" is added, "-pv" taken away.
std::vector<SumPart> read_sum(TomlReader& table) {
  std::vector<SumPart> parts;
  for (const std::string& text : table.texts("sum_of").value_or(std::vector<std::string>{})) {
    const bool is_negative = text.starts_with('-');
    parts.push_back({text.substr(is_negative ? 1 : 0), is_negative ? -1.0 : 1.0});
  }
  return parts;
}

std::string read_meter_id(TomlReader& table) {
  std::string id = table.required_text("id");
  if (!id.empty() && !is_identifier(id)) {
    table.problem_at("id", fmt::format("'id' is \"{}\"; use 1 to 40 of a-z, 0-9, - and _", id));
  }
  return id;
}

seconds read_grid_tolerance(TomlReader& table, const std::optional<seconds>& interval) {
  const auto tolerance = table.duration("grid_tolerance").value_or(seconds{0});
  const seconds longest = interval.value_or(std::chrono::hours{1}) / metering::kToleranceShare;
  if (tolerance <= longest) return tolerance;
  table.problem_at("grid_tolerance",
                   fmt::format("'grid_tolerance' is {} s; it may be a fifth of the interval at "
                               "most, {} s",
                               tolerance.count(), longest.count()));
  return longest;
}

/// A [[meter]] with role = "weather".
MeterConfig read_sensor(TomlReader& table, const SiteConfig& site, RegisterMaps& maps) {
  MeterConfig config{.role = MeterRole::weather};
  config.meter.id = read_meter_id(table);
  config.source = read_source(table);
  if (config.source == MeterSource::modbus) {
    config.live = read_live_sensor(table, maps);
  } else if (config.source != MeterSource::http) {
    table.problem(
        "a weather sensor is polled (source = \"modbus\") or pushed (source = \"http\"); name a "
        "weather file, which may grow, in [weather] file");
  } else {
    if (!table.has("interval")) {
      table.problem(
          "a pushed weather sensor needs an 'interval', the time between its values, such as "
          "\"1h\"");
    }
    config.values = read_values(table).value_or(config.values);
  }
  config.interval = read_interval(table, "interval");
  config.meter.interval = config.interval.value_or(site.interval);
  config.text = table.toml();
  table.finish();
  return config;
}

/// A clock column that counts does so by the meter's interval, and counts whole ones.
void fit_clock_format(TomlReader& table, MeterConfig& config) {
  table::TableShape& shape = config.table->shape;
  if (shape.clock_format == table::ClockFormat::time) return;
  shape.interval = config.interval.value_or(std::chrono::hours{1});
  if (config.stamps == csv::Stamps::end) {
    table.problem_at(
        "stamps",
        "'stamps' is \"end\", but each number of a 'clock_column' stands for its whole "
        "interval; leave it out");
  }
}

/// The files of a recorded meter and its rows in them.
void read_files(TomlReader& table, const SiteConfig& site, MeterConfig& config) {
  if (!table.has("file")) table.problem("'file' is missing");
  for (const std::string& file : table.one_or_more("file").value_or(std::vector<std::string>{})) {
    config.files.push_back(resolve(site.file, file, "file", table));
  }
  config.further_names = table.one_or_more("name_in_file").value_or(std::vector{config.meter.id});
  if (!config.further_names.empty()) {
    config.name_in_file = config.further_names.front();
    config.further_names.erase(config.further_names.begin());
  }
  config.stamps = read_stamps(table);
}

MeterConfig read_meter(TomlReader& table, const SiteConfig& site, RegisterMaps& maps) {
  MeterConfig config;
  metering::Meter& meter = config.meter;
  meter.id = read_meter_id(table);
  config.sum_of = read_sum(table);
  config.source = table.has("sum_of") ? MeterSource::sum : read_source(table);
  const bool is_polled = config.source == MeterSource::modbus;
  const std::string utility_name = table.required_text("utility");
  if (const auto utility = metering::parse_utility(utility_name)) {
    meter.utility = *utility;
  } else if (!utility_name.empty()) {
    table.problem_at("utility", utility.error().message);
  }
  if (is_polled) {
    config.live = read_live_meter(table, maps);
  } else if (config.source == MeterSource::csv) {
    read_files(table, site, config);
  }
  config.interval = read_interval(table, "interval");
  if (config.source == MeterSource::csv) {
    config.grid_tolerance = read_grid_tolerance(table, config.interval);
  }
  meter.interval = config.interval.value_or(site.interval);
  meter.rated_kW = table.number("rated_kW", kPositive);
  meter.zero_run_max = table.duration("zero_run_max");
  // Two hours without a single watt is a dead transformer, not a building; other utilities rest.
  if (!meter.zero_run_max && meter.utility == metering::Utility::electricity) {
    meter.zero_run_max = std::chrono::hours{2};
  }
  meter.stuck_max = table.duration("stuck_max");
  meter.negative_is_valid = table.boolean("negative_is_valid").value_or(false);
  config.multiplier = table.number_or("multiplier", 1.0, kFactor);
  config.units.steam_kWh_per_kg =
      table.number_or("steam_kWh_per_kg", config.units.steam_kWh_per_kg, kFactor);
  config.units.gas_kWh_per_m3 = table.number("gas_kWh_per_m3", kFactor);
  if (config.source == MeterSource::mqtt) {
    config.mqtt = read_mqtt_meter(table, meter.utility, config.units);
  }
  const bool is_counted =
      (config.live && !config.live->map.energy.empty()) || (config.mqtt && config.mqtt->energy);
  const bool says_nothing =
      config.live && config.live->map.energy.empty() && !config.live->map.power;
  if ((is_counted || says_nothing) && !table.has("rated_kW")) {
    table.problem("a live counter needs 'rated_kW', to tell a jump from a load");
  }
  if (!config.files.empty() && is_table(table, config.files.front())) {
    config.table = read_table_config(table, config.files.front(), meter.utility, config.units);
    fit_clock_format(table, config);
  }
  if (auto peak = table.table("peak")) read_peak(*peak, meter.peak);
  if (auto counter = table.table("counter"))
    config.counter = read_counter(*counter, meter.rated_kW, config.reset_zone);
  if (!config.reset_zone.empty() && config.files.empty()) {
    table.problem_at("counter",
                     "'reset_zone' is of registers in files; a live one is set to zero at "
                     "the site's midnight");
  }
  if (config.counter) {
    // What is delivered back is counted down.
    config.counter->runs_back = meter.negative_is_valid;
    if (config.source == MeterSource::http) config.mqtt = sent_counter(meter.interval);
  }
  meter.is_counted = config.counter || is_counted;
  config.end_uses = read_end_uses(table);
  config.text = table.toml();
  table.finish();
  return config;
}

/// A sum adds meters of its own utility, each once: all of them in files, or all in the store.
void require_parts(TomlReader& table, const SiteConfig& site, const MeterConfig& sum) {
  const auto wrong = [&](const std::string& sentence) {
    table.problem_at("sum_of", "'sum_of' " + sentence);
  };
  if (sum.sum_of.size() < 2) return wrong("needs the ids of at least two meters");
  std::set<std::string> seen;
  const MeterConfig* first = nullptr;
  for (const SumPart& part : sum.sum_of) {
    const auto index = site.meter_index(part.meter);
    if (!index) {
      wrong(fmt::format("names '{}', which is not the id of a [[meter]]", part.meter));
      continue;
    }
    const MeterConfig& meter = site.meters[*index];
    if (!seen.insert(part.meter).second) wrong(fmt::format("names '{}' twice", part.meter));
    if (meter.source == MeterSource::sum) {
      wrong(fmt::format("names '{}', which is itself a sum; name its parts instead", part.meter));
      continue;
    }
    if (meter.meter.utility != sum.meter.utility) {
      wrong(fmt::format("names '{}', which meters {}, not {}", part.meter,
                        metering::to_string(meter.meter.utility),
                        metering::to_string(sum.meter.utility)));
    }
    if (first == nullptr) first = &meter;
    if (meter.is_stored() != first->is_stored()) {
      const bool is_first = first->is_stored();
      wrong(fmt::format(
          "names '{}', which is read live, and '{}', which is in a file; sum meters of one kind, "
          "or move the file into the store of a live meter with `recald import`",
          is_first ? first->meter.id : part.meter, is_first ? part.meter : first->meter.id));
    } else if (meter.is_stored() && meter.meter.interval != first->meter.interval) {
      wrong(
          fmt::format("names '{}' and '{}', whose intervals are {} s and {} s; give them one "
                      "'interval'",
                      first->meter.id, part.meter, first->meter.interval.count(),
                      meter.meter.interval.count()));
    }
  }
}

/// The live meters of a site by what they answer to, so that each is compared with few others.
class BusAddresses {
 public:
  explicit BusAddresses(const std::vector<BusConfig>& buses) {
    for (const BusConfig& bus : buses) buses_.insert(bus.name);
  }

  /// The bus of the last of these live meters or sensors is described, and no other one answers to
  /// its address there. @param meters  Stays where it is.
  void add_last_of(const std::vector<MeterConfig>& meters, TomlReader& table) {
    const MeterConfig& meter = meters.back();
    if (!meter.live || meter.live->bus.empty()) return;
    if (!buses_.contains(meter.live->bus)) {
      table.problem_at(
          "bus", fmt::format("'bus' names '{0}', but there is no [bus.{0}]", meter.live->bus));
    }
    std::vector<Place>& others = meters_[{meter.live->bus, meter.live->unit}];
    for (const auto& [list, index] : others) {
      if (!can_share((*list)[index], meter, table)) break;  // one of them says it
    }
    others.emplace_back(&meters, meters.size() - 1);
  }

 private:
  using Place = std::pair<const std::vector<MeterConfig>*, std::size_t>;

  /// @pre both have the same unit of the same bus
  static bool can_share(const MeterConfig& other, const MeterConfig& meter, TomlReader& table) {
    bool can = true;
    if (other.live->map.sunspec_models != meter.live->map.sunspec_models) {
      can = false;
      table.problem_at(
          "map", fmt::format("meters '{}' and '{}' are both unit {} on bus '{}' but have different "
                             "SunSpec models; give both maps the same 'sunspec_models'",
                             other.meter.id, meter.meter.id, meter.live->unit, meter.live->bus));
    }
    const bool is_same =
        other.live->map.energy == meter.live->map.energy &&
        other.live->map.weather == meter.live->map.weather &&
        (!meter.live->map.energy.empty() || other.live->map.power == meter.live->map.power);
    if (!is_same) return can;
    table.problem_at(
        "unit", fmt::format("meters '{}' and '{}' are the same registers of unit {} "
                            "on bus '{}'",
                            other.meter.id, meter.meter.id, meter.live->unit, meter.live->bus));
    return false;
  }

  std::set<std::string> buses_;
  std::map<std::pair<std::string, std::uint8_t>, std::vector<Place>> meters_;
};

std::optional<metering::MonthRange> read_range(TomlReader table) {
  const auto from = table.month("from");
  const auto to = table.month("to");
  table.finish();
  if (!table.has("from") || !table.has("to")) {
    table.problem("needs 'from' and 'to', each a month such as \"2021-01\"");
    return {};
  }
  if (!from || !to) return {};
  if (*to < *from) {
    table.problem(fmt::format("'to' ({}) is before 'from' ({})", metering::to_string(*to),
                              metering::to_string(*from)));
    return {};
  }
  return metering::MonthRange{*from, *to};
}

std::optional<PeriodConfig> read_period(TomlReader table) {
  std::optional<metering::MonthRange> calibration;
  std::optional<metering::MonthRange> validation;
  if (auto range = table.table("calibration")) {
    calibration = read_range(*range);
  } else {
    table.problem("'calibration' is missing: { from = \"2021-01\", to = \"2022-12\" }");
  }
  if (auto range = table.table("validation")) validation = read_range(*range);
  if (calibration && validation && validation->first <= calibration->last &&
      calibration->first <= validation->last) {
    table.problem(
        "calibration and validation overlap; a month used for calibration cannot serve for "
        "validation");
  }
  table.finish();
  if (!calibration) return {};
  return PeriodConfig{*calibration, validation};
}

/// "[min, mode, max]" or the numbers by name, with their distribution.
std::optional<Prior> read_prior(TomlReader& table, const std::string& name) {
  const bool is_short = table.has("prior");
  const auto three = table.numbers("prior", 3);
  const auto distribution = table.text("distribution");
  PriorNumbers numbers{table.number("min"), table.number("mode"), table.number("max"),
                       table.number("sd")};
  const bool is_long = distribution || numbers.min || numbers.mode || numbers.max || numbers.sd;
  if (is_short && is_long) {
    table.problem_at("prior", name +
                                  ": 'prior' is short for min, mode and max of a triangular prior; "
                                  "give one of the two");
    return {};
  }
  if (three) {
    numbers.min = (*three)[0];
    numbers.mode = (*three)[1];
    numbers.max = (*three)[2];
  } else if (is_short || !is_long) {
    return {};
  }
  const auto prior = Prior::named(distribution.value_or("triangular"), numbers);
  if (prior) return *prior;
  table.problem(name + ": " + prior.error().message + ", or nothing to use the library's range");
  return {};
}

void require_prior_for_source(TomlReader& table, const ParameterConfig& config) {
  if (config.prior || config.source.empty()) return;
  table.problem_at("source", config.name +
                                 ": 'source' says where a prior comes from; give min, mode and "
                                 "max, or leave it out");
}

ParameterConfig read_parameter(TomlReader& table) {
  ParameterConfig config{table.required_text("name"), {}, table.text_or("source", "")};
  const auto found = model::find_parameter(config.name);
  if (!config.name.empty() && !found) table.problem_at("name", found.error().message);
  config.prior = read_prior(table, config.name);
  if (config.prior && found) {
    if (const auto physical = model::physical_prior(**found, *config.prior)) {
      config.prior = *physical;
    } else {
      table.problem(physical.error().message);
    }
  }
  require_prior_for_source(table, config);
  for (const char* key : {"targets", "change", "unit"}) {
    if (!table.has(key)) continue;
    table.problem_at(key, fmt::format("'{}' belongs to a model of kind \"energyplus\"", key));
  }
  table.finish();
  return config;
}

/// Of an EnergyPlus model: any name where targets are given, else one of the library, which is
/// looked up when the model is at hand.
ParameterConfig read_targeted_parameter(TomlReader& table) {
  ParameterConfig config{table.required_text("name"), {}, table.text_or("source", "")};
  if (!config.name.empty() && !is_identifier(config.name)) {
    table.problem_at(
        "name", fmt::format("'name' is \"{}\"; use 1 to 40 of a-z, 0-9, - and _", config.name));
  }
  config.prior = read_prior(table, config.name);
  require_prior_for_source(table, config);
  config.targets = table.one_or_more("targets").value_or(std::vector<std::string>{});
  const auto library = model::parameter_library();
  const auto known = std::ranges::find(library, config.name, &model::ParameterDefinition::name);
  if (config.prior && config.targets.empty() && known != library.end()) {
    if (const auto physical = model::physical_prior(*known, *config.prior)) {
      config.prior = *physical;
    } else {
      table.problem(physical.error().message);
    }
  }
  const std::vector<std::string_view> kinds{model::kChangeKindNames.begin(),
                                            model::kChangeKindNames.end()};
  const auto change = table.word("change", kinds);
  if (change) {
    config.change =
        static_cast<model::ChangeKind>(std::ranges::find(kinds, *change) - kinds.begin());
  }
  config.unit = table.text_or("unit", "-");
  if (config.targets.empty()) {
    for (const char* key : {"change", "unit"}) {
      if (!table.has(key)) continue;
      table.problem_at(key, fmt::format("{}: '{}' needs 'targets'; without them the library of "
                                        "parameters says what is changed",
                                        config.name, key));
    }
  } else if (!change || !config.prior) {
    table.problem(
        fmt::format("{}: with 'targets' give 'change' (set, scale or add) and 'prior' "
                    "([min, mode, max])",
                    config.name));
  }
  table.finish();
  return config;
}

ModelErrorsConfig read_model_errors(TomlReader table) {
  constexpr NumberRange kShare{0.0, 10.0};
  constexpr NumberRange kLevel{0.0, 1.0};
  ModelErrorsConfig errors{.parameter_share = table.number("parameter_share", kShare),
                           .cooling_level = table.number("cooling_level", kLevel),
                           .heating_level = table.number("heating_level", kLevel),
                           .electricity_level = table.number("electricity_level", kLevel)};
  table.finish();
  return errors;
}

/// @param outputs  Ids of meters. @return what only this kind of model has
EnergyPlusConfig read_energyplus(TomlReader& table, const SiteConfig& site,
                                 const std::vector<std::string>& outputs) {
  EnergyPlusConfig config;
  if (const std::string file = table.required_text("file"); !file.empty()) {
    config.file = resolve(site.file, file, "file", table);
  }
  if (const auto program = table.text("program")) {
    config.program = resolve(site.file, *program, "program", table);
  }
  const std::string design = table.text_or("design", site.file.stem().string() + "-doe");
  config.design = resolve(site.file, design, "design", table);
  config.runs = table.whole_number_or("runs", config.runs, {4, 100'000});
  config.time_max = table.duration("time_max").value_or(config.time_max);
  config.interval_noise = table.number_or("interval_noise", 0.0, {0.0, 0.5});
  if (auto reports = table.table("reports")) {
    for (const std::string& id : outputs) {
      if (auto meters = reports->one_or_more(id)) config.reports[id] = std::move(*meters);
    }
    reports->finish();
  }
  return config;
}

/// Those of the seed. What the drawings say is not there (a house without ventilation) stays so: a
/// range around nothing is none.
std::vector<ParameterConfig> usual_parameters(const SiteConfig& site) {
  std::vector<ParameterConfig> usual;
  for (const std::string_view name : model::kSeedParameters) {
    const auto definition = model::find_parameter(name);
    const bool is_there = !site.building || !definition ||
                          (*definition)->range != model::RangeKind::relative ||
                          (*definition)->get(*site.building) > 0.0;
    if (is_there) usual.push_back({std::string{name}, {}});
  }
  return usual;
}

ModelConfig read_model(TomlReader& table, const SiteConfig& site) {
  ModelConfig config;
  std::vector<std::string_view> kinds = model_kind_names(/*of_building_alone=*/true);
  kinds.push_back(name_of(ModelKind::energyplus));
  if (const auto kind = table.word("kind", kinds)) config.kind = *find_model_kind(*kind);
  const auto outputs = table.texts("outputs");
  config.outputs = outputs.value_or(std::vector<std::string>{});
  if (!table.has("outputs")) {
    table.problem("'outputs' is missing: the ids of the meters to model");
  } else if (outputs && outputs->empty()) {
    table.problem_at("outputs", "'outputs' is empty; list the ids of the meters to model");
  }
  const auto require_meter = [&](std::string_view key, const std::string& id) {
    if (site.meter_index(id)) return;
    table.problem_at(key,
                     fmt::format("'{}' names '{}', which is not the id of a [[meter]]", key, id));
  };
  for (const std::string& id : config.outputs) require_meter("outputs", id);
  if (auto weights = table.table("weights")) {
    for (const std::string& id : weights->keys()) {
      require_meter("weights", id);
      config.weights[id] = weights->number(id, {1e-9, 1.0}).value_or(1.0);
    }
  }
  if (auto errors = table.table("errors")) config.errors = read_model_errors(*errors);
  const bool is_energyplus = config.kind == ModelKind::energyplus;
  if (is_energyplus) {
    config.energyplus = read_energyplus(table, site, config.outputs);
  } else {
    for (const char* key :
         {"file", "program", "design", "runs", "time_max", "interval_noise", "reports"}) {
      if (!table.has(key)) continue;
      table.problem_at(key,
                       fmt::format("'{}' belongs to a model of kind \"energyplus\"; add kind = "
                                   "\"energyplus\", or leave it out",
                                   key));
    }
  }
  for (TomlReader& parameter : table.tables("parameter")) {
    config.parameters.push_back(is_energyplus ? read_targeted_parameter(parameter)
                                              : read_parameter(parameter));
  }
  if (config.parameters.empty() && !is_energyplus) config.parameters = usual_parameters(site);
  table.finish();
  return config;
}

/// The first model is the one that the daemon follows; others are calibrated beside it.
void read_models(TomlReader& root, bool is_located, SiteConfig& config) {
  for (TomlReader& table : root.tables("model")) {
    ModelConfig model = read_model(table, config);
    const auto same = [&](const ModelConfig& other) { return other.kind == model.kind; };
    const bool has_same =
        (config.model && same(*config.model)) || std::ranges::any_of(config.other_models, same);
    if (has_same) {
      table.problem_at("kind", fmt::format("two [[model]] are of kind \"{}\"; models that are "
                                           "compared are of different kinds",
                                           name_of(model.kind)));
    }
    // What is there but wrong has been reported already.
    if (facts_of(model.kind).is_of_building && !root.has("building")) {
      table.problem("needs a [building]");
    }
    const bool has_store = std::ranges::any_of(config.meters, &MeterConfig::is_stored);
    // A store has its latest months.
    if (!root.has("period") && !has_store) table.problem("needs a [period]");
    if (!root.has("weather") && config.sensors.empty()) {
      table.problem("needs [weather], or a [[meter]] with role = \"weather\"");
    }
    if (!is_located) table.problem("needs latitude_deg and longitude_deg in [site]");
    if (config.model) {
      config.other_models.push_back(std::move(model));
    } else {
      config.model = std::move(model);
    }
  }
}

/// Meters with their addresses on buses, and weather sensors. @param tables  All [[meter]].
void read_meters(std::vector<TomlReader>& tables, const MapTexts* given, SiteConfig& config) {
  const auto first_sensor = std::stable_partition(
      tables.begin(), tables.end(),
      [](TomlReader& table) { return table.word("role", {"weather"}) != "weather"; });
  std::set<std::string> ids;
  BusAddresses addresses{config.buses};
  RegisterMaps maps{config.file.parent_path(), given};
  for (auto table = tables.begin(); table != tables.end(); ++table) {
    const bool is_sensor = table >= first_sensor;
    std::vector<MeterConfig>& list = is_sensor ? config.sensors : config.meters;
    list.push_back(is_sensor ? read_sensor(*table, config, maps)
                             : read_meter(*table, config, maps));
    addresses.add_last_of(list, *table);
    const std::string& id = list.back().meter.id;
    if (!id.empty() && !ids.insert(id).second) {
      table->problem(fmt::format("two meters have the id '{}'", id));
    }
  }
  for (std::size_t i = 0; i < config.meters.size(); ++i) {
    MeterConfig& meter = config.meters[i];
    if (meter.source != MeterSource::sum) continue;
    require_parts(tables[i], config, meter);
    // Recorded parts show theirs in their files.
    if (config.comes_from_store(meter)) {
      const auto part = config.meter_index(meter.sum_of.front().meter);
      meter.meter.interval = config.meters[*part].meter.interval;
    }
  }
}

/// Messages come from a broker.
void require_broker(TomlReader& root, const SiteConfig& config) {
  const auto meter = std::ranges::find(config.meters, MeterSource::mqtt, &MeterConfig::source);
  if (config.mqtt || meter == config.meters.end() || root.has("mqtt")) return;
  root.problem(
      fmt::format("meter '{}' has source = \"mqtt\", but there is no [mqtt] with the 'url' "
                  "of a broker",
                  meter->meter.id));
}

BrokerConfig read_fleet(TomlReader& table, const SiteConfig& config) {
  BrokerConfig broker = read_broker(table, config.file, "fleet-recald-" + config.id);
  // Of two connections with one name, each ends the other.
  const bool is_twice = config.mqtt && config.mqtt->broker.where() == broker.where() &&
                        config.mqtt->broker.client_id == broker.client_id;
  if (is_twice) {
    table.problem_at("client_id", fmt::format("'client_id' is \"{}\", as in [mqtt] at the same "
                                              "broker; write another, or none",
                                              broker.client_id));
  }
  table.finish();
  return broker;
}

/// A file, sensors, or both.
void read_whole_weather(TomlReader& root, SiteConfig& config) {
  if (auto weather = root.table("weather")) {
    config.weather = read_weather(*weather, config.file, !config.sensors.empty());
  } else if (!config.sensors.empty()) {
    config.weather.emplace();
  }
  const auto may_measure_dry_bulb = [](const MeterConfig& sensor) {
    return std::ranges::any_of(quantities_of(sensor), [](const auto* quantity) {
      return weather::is_dry_bulb(*quantity);
    });
  };
  if (config.sensors.empty() || root.has("weather")) return;
  if (std::ranges::none_of(config.sensors, may_measure_dry_bulb)) {
    root.problem(
        "no weather sensor measures dry_bulb_C; add one that does, or a [weather] file with it");
  }
}

void read_root(TomlReader root, const MapTexts* maps, SiteConfig& config) {
  const auto site = root.table("site");
  if (site) {
    read_site(*site, config);
  } else {
    root.problem("[site] is missing");
  }
  config.store = default_store(config.file);
  if (auto store = root.table("store")) config.store = read_store(*store, config.file);
  if (auto http = root.table("http")) config.http = read_http(*http, config.file);
  if (auto modbus = root.table("modbus")) config.modbus = read_modbus(*modbus);
  if (auto alerts = root.table("alerts")) config.alerts = read_alerts(*alerts, config.file);
  if (auto mqtt = root.table("mqtt")) config.mqtt = read_mqtt(*mqtt, config.id, config.file);
  if (auto fleet = root.table("fleet")) config.fleet = read_fleet(*fleet, config);
  for (TomlReader& write : root.tables("remote_write")) {
    config.remote_writes.push_back(read_remote_write(write, config.file));
  }
  if (auto table = root.table("tariff")) read_tariff(*table, config.tariff);
  if (auto table = root.table("emissions")) read_emissions(*table, config.tariff);
  if (auto table = root.table("recalibration")) {
    config.recalibration = read_recalibration(*table, config.file);
  }
  if (auto diagnosis = root.table("diagnosis")) {
    constexpr NumberRange kPriorOfNone{.min = 0.01, .max = 0.99};
    config.prior_none = diagnosis->number("prior_none", kPriorOfNone).value_or(config.prior_none);
    config.applies_itself = diagnosis->word("apply", {"never", "auto"}) == "auto";
    diagnosis->finish();
  }
  if (auto buses = root.table("bus")) {
    for (const std::string& name : buses->keys()) {
      if (auto bus = buses->table(name)) config.buses.push_back(read_bus(*bus, name));
    }
  }
  std::vector<TomlReader> tables = root.tables("meter");
  read_meters(tables, maps, config);
  require_broker(root, config);
  if (config.meters.empty()) {
    root.problem(config.sensors.empty() ? "there is no [[meter]]"
                                        : "there are only weather sensors and no other [[meter]]");
  }
  read_whole_weather(root, config);
  if (auto period = root.table("period")) config.period = read_period(*period);
  if (auto building = root.table("building")) config.building = read_building(*building);
  const bool is_located = site && site->has("latitude_deg") && site->has("longitude_deg");
  read_models(root, is_located, config);
  root.finish();
}

}  // namespace

std::string_view name_of(MeterSource source) {
  switch (source) {
    case MeterSource::modbus:
      return "modbus";
    case MeterSource::http:
      return "http";
    case MeterSource::mqtt:
      return "mqtt";
    case MeterSource::sum:
      return "sum";
    case MeterSource::csv:
      break;
  }
  return "csv";
}

std::string files_words(std::span<const std::filesystem::path> files) {
  if (files.empty()) return "";
  const std::string name = files.front().filename().string();
  return files.size() == 1 ? name : fmt::format("{} and {} more", name, files.size() - 1);
}

bool ModelConfig::has_output(const std::string& meter_id) const {
  return std::ranges::find(outputs, meter_id) != outputs.end();
}

std::filesystem::path SiteConfig::versions_beside() const {
  std::error_code unreadable;
  const bool has_some =
      std::filesystem::exists(models::versions_folder(file), unreadable) && !unreadable;
  return has_some ? file : store.file.parent_path() / file.filename();
}

bool SiteConfig::comes_from_store(const MeterConfig& meter) const {
  if (meter.sum_of.empty()) return meter.is_stored();
  const auto part = meter_index(meter.sum_of.front().meter);
  return part && meters[*part].is_stored();
}

std::vector<std::string> SiteConfig::without_sums(const std::vector<std::string>& ids) const {
  std::vector<std::string> all;
  for (const std::string& one : ids) {
    const auto index = meter_index(one);
    if (!index || meters[*index].sum_of.empty()) {
      all.push_back(one);
      continue;
    }
    for (const SumPart& part : meters[*index].sum_of) all.push_back(part.meter);
  }
  return all;
}

std::optional<std::size_t> SiteConfig::meter_index(const std::string& meter_id) const {
  for (std::size_t i = 0; i < meters.size(); ++i) {
    if (meters[i].meter.id == meter_id) return i;
  }
  return {};
}

const MeterConfig* SiteConfig::find_sensor(std::string_view sensor_id) const {
  const auto found = std::ranges::find_if(
      sensors, [&](const MeterConfig& sensor) { return sensor.meter.id == sensor_id; });
  return found == sensors.end() ? nullptr : &*found;
}

tl::expected<SiteConfig, std::vector<std::string>> parse_site(std::string_view text,
                                                              const std::filesystem::path& file,
                                                              const MapTexts* maps) {
  Problems problems;
  const std::string name = file.filename().string();
  SiteConfig config;
  config.file = file;
  try {
    const toml::table root = parse_toml(text, name);
    read_root(TomlReader{root, name, "", problems}, maps, config);
  } catch (const toml::parse_error& error) {
    problems.push_back(syntax_problem(name, error));
  }
  if (!problems.empty()) return tl::unexpected(problems);
  return config;
}

tl::expected<SiteConfig, std::vector<std::string>> load_site(const std::filesystem::path& file) {
  const auto refused = [&](std::string_view why) {
    return tl::unexpected(Problems{fmt::format("site file '{}' {}", file.string(), why)});
  };
  if (std::error_code ignored; std::filesystem::is_directory(file, ignored)) {
    return refused("is a folder; name the TOML file in it");
  }
  if (const auto is_file = system::require_file(file, "site file"); !is_file) {
    return tl::unexpected(Problems{is_file.error().message});
  }
  constexpr std::array kExports{".csv", ".xlsx", ".xlsm", ".xml", ".txt"};
  if (std::ranges::find(kExports, file.extension()) != kExports.end()) {
    return refused("is an export, not a site file; `recald init` makes a site file from it");
  }
  std::ifstream in{file, std::ios::binary};
  if (!in) return refused("cannot be read; give recald the right to read it");
  return parse_site(std::string{std::istreambuf_iterator<char>{in}, {}}, file);
}

}  // namespace recald::daemon
