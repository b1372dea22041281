#include "daemon/site/config/table_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "core/text/ascii.hpp"

namespace recald::daemon {
namespace {

using table::Container;

struct Separator {
  std::string_view word;
  char sign;
};
struct Format {
  std::string_view word;
  Container container;
};
constexpr std::array kFormats{Format{"table", Container::text},
                              Format{"xlsx", Container::xlsx},
                              Format{"green_button", Container::green_button},
                              Format{"nem12", Container::nem12},
                              Format{"influx", Container::influx},
                              Format{"json", Container::json}};
constexpr std::array kSeparators{Separator{",", ','}, Separator{";", ';'}, Separator{"tab", '\t'},
                                 Separator{"|", '|'}};

/// By the end of the file's name.
Container container_of(const std::filesystem::path& file) {
  const std::string end = to_lower(file.extension().string());
  if (end == ".xlsx" || end == ".xlsm") return Container::xlsx;
  if (end == ".json" || end == ".ndjson" || end == ".jsonl") return Container::json;
  return end == ".xml" ? Container::green_button : Container::text;
}

std::optional<std::string> read_format(TomlReader& meter) {
  std::vector<std::string_view> words{"readings"};
  for (const Format& format : kFormats) words.push_back(format.word);
  return meter.word("format", words);
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
  if (meter.has("flag_column") && shape.flag_column.empty()) {
    meter.problem_at("flag_column", "'flag_column' is empty; name a column, or leave it out");
  }
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

/// One text, or the first of a list, whose others go into `further`.
std::string first_of(TomlReader& meter, std::string_view key, std::vector<std::string>& further) {
  auto texts = meter.one_or_more(key);
  if (!texts) return "";
  further.assign(std::next(texts->begin()), texts->end());
  return std::move(texts->front());
}

void read_values(TomlReader& meter, TableConfig& config) {
  config.column = first_of(meter, "column", config.further_columns);
  if (config.shape.layout == table::Layout::rows) {
    if (!meter.has("column")) (void)meter.required_text("column");
  } else if (meter.has("column")) {
    meter.problem_at("column",
                     "'column' is of tables with a row for each time; where times have columns, "
                     "leave it out");
  } else {
    config.column = table::kValueColumn;
  }
}

void read_columns(TomlReader& meter, TableConfig& config) {
  table::TableShape& shape = config.shape;
  const std::vector<std::string_view> layouts{table::kLayouts.begin(), table::kLayouts.end()};
  if (const auto word = meter.word("layout", layouts)) {
    shape.layout = static_cast<table::Layout>(std::ranges::find(layouts, *word) - layouts.begin());
  }
  if (shape.layout != table::Layout::column_a_time) {
    shape.time_column = meter.required_text("time_column");
  } else {
    shape.time_column = table::kStampColumn;
  }
  shape.clock_column = meter.text_or("clock_column", "");
  read_clock_format(meter, shape);
  read_values(meter, config);
  shape.meter_column = first_of(meter, "meter_column", shape.further_meter_columns);
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
  constexpr std::array kKeys{"time_column",  "clock_column", "time_format", "column",
                             "meter_column", "unit_column",  "decimal",     "separator",
                             "flag_column",  "layout"};
  return container_of(file) != Container::text ||
         std::ranges::any_of(kKeys, [&](const char* key) { return meter.has(key); });
}

TableConfig read_table_config(TomlReader& meter, const std::filesystem::path& file,
                              metering::Utility utility, const metering::UnitFactors& known_units) {
  TableConfig config;
  const auto format = read_format(meter);
  const auto named = std::ranges::find(kFormats, format.value_or(""), &Format::word);
  const Container container = named != kFormats.end() ? named->container : container_of(file);
  if (table::describes_itself(container)) {
    config.shape = table::described_shape(container);
    config.column = table::kValueColumn;
    config.unit = meter.text_or("unit", "");
    if (!config.unit.empty()) config.shape.unit_column.clear();
    require_unit(meter, config, utility, known_units);
    return config;
  }
  read_columns(meter, config);
  config.shape.container = container;
  if (container == Container::xlsx) {
    config.shape.sheet = meter.text_or("sheet", "");
  } else if (container == Container::json) {
    // Its columns are keys.
  } else if (const auto word = meter.word("separator", {",", ";", "tab", "|"})) {
    config.shape.separator =
        std::ranges::find(kSeparators, std::string_view{*word}, &Separator::word)->sign;
  }
  require_unit(meter, config, utility, known_units);
  return config;
}

}  // namespace recald::daemon
