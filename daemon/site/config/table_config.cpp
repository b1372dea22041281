#include "daemon/site/config/table_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/text/ascii.hpp"

namespace recald::daemon {
namespace {

using table::Container;

struct Separator {
  std::string_view word;
  char sign;
};
constexpr std::array kSeparators{Separator{",", ','}, Separator{";", ';'}, Separator{"tab", '\t'},
                                 Separator{"|", '|'}};

/// By the end of the file's name.
Container container_of(const std::filesystem::path& file) {
  const std::string end = to_lower(file.extension().string());
  if (end == ".xlsx" || end == ".xlsm") return Container::xlsx;
  return end == ".xml" ? Container::green_button : Container::text;
}

std::optional<std::string> read_format(TomlReader& meter) {
  return meter.word("format", {"readings", "table", "xlsx", "green_button"});
}

void require_unit(TomlReader& meter, const TableConfig& config, metering::Utility utility,
                  const metering::UnitFactors& known_units) {
  if (config.unit.empty()) return;
  const auto unit = metering::find_unit(config.unit, utility, known_units);
  if (!unit) meter.problem_at("unit", "'unit': " + unit.error().message);
}

/// What a column that counts hours or intervals counts.
void read_clock_format(TomlReader& meter, table::TableShape& shape) {
  const std::vector<std::string_view> formats{table::kClockFormats.begin(),
                                              table::kClockFormats.end()};
  const auto word = meter.word("clock_format", formats);
  if (!word) return;
  shape.clock_format =
      static_cast<table::ClockFormat>(std::ranges::find(formats, *word) - formats.begin());
  if (shape.clock_column.empty()) {
    meter.problem_at("clock_format", "'clock_format' says what a 'clock_column' counts; name that");
  }
}

/// A flag means one thing.
void read_flags(TomlReader& meter, table::TableShape& shape) {
  shape.flag_column = meter.text_or("flag_column", "");
  for (const auto& [key, flags] : {std::pair{"missing_flags", &shape.missing_flags},
                                   std::pair{"estimated_flags", &shape.estimated_flags}}) {
    *flags = meter.texts(key).value_or(std::vector<std::string>{});
    if (!meter.has(key) || !shape.flag_column.empty()) continue;
    meter.problem_at(key, fmt::format("'{}' needs the 'flag_column' that has them", key));
  }
  for (const std::string& flag : shape.estimated_flags) {
    if (std::ranges::find(shape.missing_flags, flag) == shape.missing_flags.end()) continue;
    meter.problem_at("estimated_flags",
                     fmt::format("'estimated_flags' has \"{}\", as 'missing_flags' does", flag));
  }
}

void read_columns(TomlReader& meter, TableConfig& config) {
  table::TableShape& shape = config.shape;
  shape.time_column = meter.required_text("time_column");
  shape.clock_column = meter.text_or("clock_column", "");
  read_clock_format(meter, shape);
  config.column = meter.required_text("column");
  shape.meter_column = meter.text_or("meter_column", "");
  shape.unit_column = meter.text_or("unit_column", "");
  read_flags(meter, shape);
  const std::vector<std::string_view> formats{table::kTimeFormats.begin(),
                                              table::kTimeFormats.end()};
  if (const auto word = meter.word("time_format", formats)) {
    shape.time_format =
        static_cast<table::TimeFormat>(std::ranges::find(formats, *word) - formats.begin());
  }
  shape.decimal = meter.word("decimal", {".", ","}) == "," ? ',' : '.';
  shape.timezone = meter.text_or("timezone", "");
  if (meter.has("timezone")) {
    if (const auto zone = metering::LocalCalendar::open(shape.timezone); !zone) {
      meter.problem_at("timezone", "'timezone': " + zone.error().message);
    }
  }
  config.unit = meter.text_or("unit", "");
  if (config.unit.empty() == shape.unit_column.empty()) {
    meter.problem_at(
        "unit", config.unit.empty()
                    ? "'unit' is missing: what the values are in, such as \"kWh\"; or name the "
                      "'unit_column' that says it"
                    : "'unit' and 'unit_column' are both there; leave one of them out");
  }
}

}  // namespace

bool is_table(TomlReader& meter, const std::filesystem::path& file) {
  if (const auto format = read_format(meter)) return *format != "readings";
  constexpr std::array kKeys{"time_column", "clock_column", "time_format",
                             "column",      "meter_column", "unit_column",
                             "decimal",     "separator",    "flag_column"};
  return container_of(file) != Container::text ||
         std::ranges::any_of(kKeys, [&](const char* key) { return meter.has(key); });
}

TableConfig read_table_config(TomlReader& meter, const std::filesystem::path& file,
                              metering::Utility utility, const metering::UnitFactors& known_units) {
  TableConfig config;
  const auto format = read_format(meter);
  const Container container = format == "xlsx"           ? Container::xlsx
                              : format == "green_button" ? Container::green_button
                              : format == "table"        ? Container::text
                                                         : container_of(file);
  if (container == Container::green_button) {
    config.shape = table::green_button_shape();
    config.column = "value";
    return config;
  }
  read_columns(meter, config);
  config.shape.container = container;
  if (container == Container::xlsx) {
    config.shape.sheet = meter.text_or("sheet", "");
  } else if (const auto word = meter.word("separator", {",", ";", "tab", "|"})) {
    config.shape.separator =
        std::ranges::find(kSeparators, std::string_view{*word}, &Separator::word)->sign;
  }
  require_unit(meter, config, utility, known_units);
  return config;
}

}  // namespace recald::daemon
