/// One site as its TOML file describes it. Every key is documented in the example sites.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/csv/line_issues.hpp"
#include "core/display/unit.hpp"
#include "core/metering/months/close_month.hpp"
#include "core/metering/months/month_closer.hpp"
#include "core/metering/registers/counter.hpp"
#include "core/metering/units.hpp"
#include "core/model/building.hpp"
#include "core/model/change_kind.hpp"
#include "core/model/end_use.hpp"
#include "core/model/model_kind.hpp"
#include "core/model/parameter.hpp"
#include "core/result.hpp"
#include "core/tariff/tariff.hpp"
#include "core/weather/recorded_values.hpp"
#include "core/weather/sun.hpp"
#include "daemon/site/config/bus_config.hpp"
#include "daemon/site/config/service/alert_config.hpp"
#include "daemon/site/config/service/mqtt_config.hpp"
#include "daemon/site/config/service/remote_write_config.hpp"
#include "daemon/site/config/service/service_config.hpp"
#include "daemon/site/config/service/store_config.hpp"
#include "daemon/site/config/table_config.hpp"

namespace recald::daemon {

/// Where a meter's readings come from: a file, registers that are read, whoever sends them,
/// messages of a broker, or other meters of the site.
enum class MeterSource : std::uint8_t { csv, modbus, http, mqtt, sum };

/// "csv", "modbus", "http", "mqtt", "sum"
[[nodiscard]] std::string_view name_of(MeterSource source);

/// What a [[meter]] measures.
enum class MeterRole : std::uint8_t { energy, weather };

/// A meter that a sum adds, or takes away.
struct SumPart {
  std::string meter;  ///< Its id.
  double sign;        ///< 1 or -1.
};

struct MeterConfig {
  metering::Meter meter;
  MeterRole role = MeterRole::energy;
  MeterSource source = MeterSource::csv;
  std::vector<std::filesystem::path> files;  ///< source = "csv": in order of time; else empty.
  std::string name_in_file;                  ///< In the file's `meter` column.
  std::vector<std::string> further_names;    ///< There too: rows of the same load.
  std::optional<TableConfig> table;          ///< Absent: the file is recald's own CSV.
  csv::Stamps stamps = csv::Stamps::start;
  /// Of a weather sensor that sends: instants are values at the start of their interval.
  weather::RecordedValues values = weather::RecordedValues::mean;
  std::optional<std::chrono::seconds> interval;  ///< Declared; absent: as the file shows.
  /// Of a file: stamps so far beside the grid of its intervals are put on it.
  std::chrono::seconds grid_tolerance{0};
  double multiplier = 1.0;
  metering::UnitFactors units;
  std::optional<metering::CounterSettings> counter;
  std::string reset_zone;  ///< By whose midnights it sets itself to zero; empty: the site's.
  std::optional<model::MeterMap> end_uses;  ///< Absent: as usual for the utility.
  std::optional<LiveMeterConfig> live;      ///< source = "modbus".
  /// source = "mqtt"; or "http" with a counter, whose samples are sent, from no topic.
  std::optional<MqttMeterConfig> mqtt;
  std::vector<SumPart> sum_of;  ///< source = sum: meters of the site, all in files or all stored.
  std::string text;  ///< The table as TOML: whether a file that is read again says something else.

  /// Its readings are in the site's store, and not in a file.
  [[nodiscard]] bool is_stored() const {
    return source == MeterSource::modbus || source == MeterSource::http ||
           source == MeterSource::mqtt;
  }
};

/// "2021.csv", "2021.csv and 2 more"
[[nodiscard]] std::string files_words(std::span<const std::filesystem::path> files);

enum class WeatherFormat { csv, epw };

struct WeatherConfig {
  /// Several: EPW, each of a year of its own. None: the weather comes from the site's sensors
  /// alone.
  std::vector<std::filesystem::path> files;
  WeatherFormat format = WeatherFormat::csv;
  csv::Stamps stamps = csv::Stamps::start;
  std::optional<weather::RecordedValues> values;  ///< Absent: as the file shows or usually is.
};

struct PeriodConfig {
  metering::MonthRange calibration;
  std::optional<metering::MonthRange> validation;
};

/// An effect of the model version in force, one of whose values a parameter is.
struct EffectOfModel {
  std::string effect;                   ///< Id in the catalogue.
  std::vector<std::string> parameters;  ///< Their names in the catalogue, without dates.
  std::optional<metering::Day> from;
  std::optional<metering::Day> to;
};

struct ParameterConfig {
  std::string name;
  std::optional<Prior> prior;  ///< Absent: from the library.
  std::string source;          ///< Where that prior comes from; empty: nobody says.
  /// Of an EnergyPlus model: patterns of the fields that it changes; empty: as the library has it.
  std::vector<std::string> targets = {};
  model::ChangeKind change = model::ChangeKind::scale;
  std::string unit = "-";
  /// Of an EnergyPlus model that was given an effect: not from the site file.
  std::shared_ptr<const EffectOfModel> effect = {};
};

/// Sizes of the model's own errors that the site knows better (`assessment::ModelErrorSizes`);
/// absent: as learnt.
struct ModelErrorsConfig {
  std::optional<double> parameter_share;
  std::optional<double> cooling_level;
  std::optional<double> heating_level;
  std::optional<double> electricity_level;
};

/// kind = "energyplus": the model, and where its runs live.
struct EnergyPlusConfig {
  std::filesystem::path file;     ///< epJSON or IDF.
  std::filesystem::path program;  ///< Empty: RECALD_ENERGYPLUS, else along PATH.
  std::filesystem::path design;
  int runs = 200;
  std::chrono::seconds time_max{1800};  ///< Of one run.
  /// Relative sd of the meters' intervals about the simulated ones: a measured peak is the largest
  /// of some thousand noisy intervals.
  double interval_noise = 0.0;
  /// By output: the meters of the model that it is the sum of; a minus subtracts one.
  std::map<std::string, std::vector<std::string>> reports;
};

struct ModelConfig {
  ModelKind kind = ModelKind::epc;
  std::vector<std::string> outputs;       ///< Ids of meters.
  std::map<std::string, double> weights;  ///< By meter; absent: 1.
  std::vector<ParameterConfig> parameters;
  ModelErrorsConfig errors;
  std::optional<EnergyPlusConfig> energyplus;  ///< Of that kind, and only of it.

  [[nodiscard]] bool has_output(const std::string& meter_id) const;
};

struct SiteConfig {
  std::filesystem::path file;
  std::string unwritten;  ///< What `file` would have in it; empty: it is there.
  std::string id;
  std::string name;
  std::string timezone;
  display::UnitSystem units = display::UnitSystem::si;  ///< Of pages and the console.
  std::chrono::seconds interval{900};
  std::optional<weather::Location> location;
  model::Holidays holidays;
  metering::CloserOptions closing;
  StoreConfig store;
  std::optional<HttpConfig> http;      ///< Absent: nothing is served.
  std::optional<ModbusConfig> modbus;  ///< Absent: no registers are served.
  std::optional<MqttConfig> mqtt;      ///< Absent: no broker.
  std::optional<BrokerConfig> fleet;   ///< Between the site and its fleet's record; absent: none.
  std::vector<RemoteWriteConfig> remote_writes;
  AlertConfig alerts;
  RecalibrationConfig recalibration;
  /// [diagnosis] Probability that the model lacks nothing, before a reading is seen.
  double prior_none = 0.5;
  /// [diagnosis] The daemon puts in force by itself what `may_apply_itself`.
  bool applies_itself = false;
  tariff::Tariff tariff;
  std::vector<BusConfig> buses;
  std::vector<MeterConfig> meters;
  /// Those [[meter]] with role = "weather". They are no meters otherwise: no months, no outputs.
  std::vector<MeterConfig> sensors;
  std::optional<WeatherConfig> weather;  ///< Set if the site has a weather file or sensor.
  std::optional<PeriodConfig> period;
  std::optional<ModelConfig> model;       ///< The first, which the daemon follows.
  std::vector<ModelConfig> other_models;  ///< Calibrated beside it, to be compared.
  std::optional<model::Building> building;

  /// Index of a meter by its id.
  [[nodiscard]] std::optional<std::size_t> meter_index(const std::string& meter_id) const;
  /// Null where no weather sensor has that id.
  [[nodiscard]] const MeterConfig* find_sensor(std::string_view sensor_id) const;

  /// The file beside which the versions of the model are kept (models::ModelStore): the site file
  /// itself if there are some, else one of its name beside the store. A daemon may write there
  /// where it must not write among the settings.
  [[nodiscard]] std::filesystem::path versions_beside() const;

  /// Whether a meter's readings are in the store, or those of a sum's parts.
  [[nodiscard]] bool comes_from_store(const MeterConfig& meter) const;

  /// The same meters, with its parts in the place of each sum.
  [[nodiscard]] std::vector<std::string> without_sums(const std::vector<std::string>& ids) const;
};

/// Reads and checks a site file. Data files are not opened; paths are relative to the site file,
/// and `$NAME` at the start of a path is taken from the environment.
/// @return every problem found, or one when the file is missing or no TOML.
[[nodiscard]] tl::expected<SiteConfig, std::vector<std::string>> load_site(
    const std::filesystem::path& file);

/// The same of a text; `file` is where paths in it start from and what messages name.
/// @param maps  Register maps of its meters in the place of files, if not null.
[[nodiscard]] tl::expected<SiteConfig, std::vector<std::string>> parse_site(
    std::string_view text, const std::filesystem::path& file, const MapTexts* maps = nullptr);

}  // namespace recald::daemon
