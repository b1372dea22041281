#include "daemon/site/setup/export_meters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

#include "adapters/csv/fields.hpp"
#include "adapters/csv/line_reader.hpp"
#include "adapters/table/cells/words.hpp"
#include "adapters/table/containers/influx_csv.hpp"
#include "adapters/table/containers/nem12.hpp"
#include "adapters/table/delimited.hpp"
#include "adapters/table/files/open_rows.hpp"
#include "adapters/table/green_button.hpp"
#include "adapters/table/loads/named_rows.hpp"
#include "core/text/ascii.hpp"
#include "core/text/utf8.hpp"
#include "daemon/site/setup/clock_evidence.hpp"
#include "daemon/site/setup/file_guess.hpp"
#include "daemon/site/setup/utility_guess.hpp"

namespace recald::daemon {
namespace {

using std::chrono::seconds;
using table::Container;

constexpr std::size_t kFirstBytes = 4096;
constexpr std::size_t kMetersMax = 500;
constexpr double kTypicalGas_kWh_per_m3 = 10.55;
constexpr std::string_view kOwnHeader = "timestamp,meter,value,unit";

}  // namespace

std::string unit_read(const SurveyedMeter& meter) {
  return meter.unit.value.empty() ? "kWh" : meter.unit.value;
}

namespace {

/// A meter before anything is known of its readings.
SurveyedMeter described(std::string name, std::string name_in_file, std::string column,
                        std::string unit, std::string unit_because) {
  SurveyedMeter meter;
  const UtilityGuess utility = guess_utility(name, unit);
  meter.name = std::move(name);
  meter.name_in_file = std::move(name_in_file);
  meter.column = std::move(column);
  meter.unit = {std::move(unit), std::move(unit_because)};
  meter.utility = {utility.utility, utility.because};
  const auto conversion = metering::find_unit(unit_read(meter), utility.utility, {});
  meter.needs_heating_value = !conversion && conversion.error().code == ErrorCode::unsupported &&
                              utility.utility == metering::Utility::gas;
  return meter;
}

Result<std::string> first_bytes(const std::filesystem::path& file) {
  const auto bytes = TRY(csv::open_file(file, "export"));
  std::string begin(kFirstBytes, '\0');
  const auto got = TRY(bytes(begin.data(), begin.size()));
  begin.resize(got);
  return begin;
}

bool is_own(const std::vector<std::string>& lines) {
  const auto header = std::ranges::find_if(
      lines, [](const std::string& line) { return !line.empty() && line.front() != '#'; });
  return header != lines.end() && header->starts_with(kOwnHeader);
}

/// Of the numbers of a statistic one is the load: the mean, not the least and the most; the total,
/// not what a device shows.
void keep_the_load(table::TableGuess& guess) {
  const auto find = [&](std::string_view name) {
    return std::ranges::find_if(
        guess.values, [&](const table::GuessedColumn& one) { return to_lower(one.name) == name; });
  };
  const auto end = guess.values.end();
  auto load = end;
  if (find("min") != end || find("max") != end) load = find("mean");
  if (find("sum") != end && find("state") != end) load = find("sum");
  if (load == end) return;
  const table::GuessedColumn kept = *load;
  constexpr std::array<std::string_view, 6> kStatistics{"min", "max",   "mean",
                                                        "sum", "state", "change"};
  std::erase_if(guess.values, [&](const table::GuessedColumn& one) {
    const bool is_other = one.column != kept.column &&
                          std::ranges::find(kStatistics, to_lower(one.name)) != kStatistics.end();
    if (is_other) guess.ignored.push_back(fmt::format("{} (beside {})", one.column, kept.column));
    return is_other;
  });
}

/// "UsagePoint/1" of one of its meter readings.
std::string_view usage_point(std::string_view name) {
  return name.substr(0, name.find("/MeterReading"));
}

bool is_of_one_load(const table::FeedMeter& a, const table::FeedMeter& b) {
  return usage_point(a.name) == usage_point(b.name) && a.unit == b.unit &&
         a.is_register == b.is_register && a.is_reverse == b.is_reverse;
}

/// Registers of tariffs are parts of the first of them, or of the total where the feed has it.
void join_tariff(std::span<const table::FeedMeter> feed, const table::FeedMeter& in_feed,
                 SurveyedMeter& meter, std::vector<SurveyedMeter>& meters) {
  const auto is_sibling = [&](const table::FeedMeter& other) {
    return &other != &in_feed && is_of_one_load(other, in_feed);
  };
  if (in_feed.tariff != 0) {
    const bool has_total = std::ranges::any_of(feed, [&](const table::FeedMeter& other) {
      return is_sibling(other) && other.tariff == 0;
    });
    if (has_total) return;
    for (SurveyedMeter& known : meters) {
      const auto first = std::ranges::find(feed, known.name_in_file, &table::FeedMeter::name);
      if (first == feed.end() || first->tariff == 0 || first->tariff == in_feed.tariff) continue;
      if (!is_sibling(*first)) continue;
      known.further_names.push_back(in_feed.name);
      known.parts_because = "registers of tariffs, as the feed says, added up";
      return;
    }
  }
  meters.push_back(std::move(meter));
}

Result<std::vector<SurveyedMeter>> meters_of_feed(const std::filesystem::path& file) {
  const auto feed = TRY(table::read_green_button(file));
  std::vector<SurveyedMeter> meters;
  for (const table::FeedMeter& in_feed : feed.meters) {
    const std::string name = in_feed.title.empty()
                                 ? std::string{in_feed.is_reverse ? "delivered back" : ""}
                                 : in_feed.title;
    SurveyedMeter meter = described(name.empty() ? file.stem().string() : name, in_feed.name,
                                    "value", in_feed.unit, "as the feed says");
    if (in_feed.utility) {
      meter.utility = {*in_feed.utility, "as the feed says"};
      meter.needs_heating_value = in_feed.utility == metering::Utility::gas &&
                                  !metering::find_unit(in_feed.unit, *in_feed.utility, {});
    }
    meter.is_register = in_feed.is_register;
    join_tariff(feed.meters, in_feed, meter, meters);
  }
  return meters;
}

}  // namespace

tl::unexpected<Error> about(const std::filesystem::path& file, const Error& error) {
  const std::string name = file.string();
  if (error.message.find(name) != std::string::npos) return tl::unexpected(error);
  return tl::unexpected(Error{error.code, fmt::format("'{}': {}", name, error.message)});
}

std::vector<SurveyedMeter> meters_of_columns(const table::TableGuess& guess,
                                             const std::string& file_stem) {
  std::vector<SurveyedMeter> meters;
  for (const table::GuessedColumn& value : guess.values) {
    std::string name = value.name;
    const bool is_by_file = name.empty() && guess.values.size() == 1;
    if (name.empty()) name = is_by_file ? file_stem : value.column;
    meters.push_back(described(name, "", value.column, value.unit, value.unit_because));
    meters.back().is_named_by_file = is_by_file;
  }
  return meters;
}

Result<std::vector<SurveyedMeter>> meters_of_rows(const std::filesystem::path& file,
                                                  const table::TableGuess& guess) {
  const table::TableShape& shape = guess.shape;
  const auto rows = TRY(table::open_rows(file, shape));
  std::vector<SurveyedMeter> meters;
  std::map<std::string, std::size_t, std::less<>> known;
  std::vector<std::string> header;
  const std::vector<table::GuessedColumn>& values = guess.values;
  std::optional<std::size_t> meter_at;
  std::optional<std::size_t> unit_at;
  std::optional<std::size_t> time_at;
  for (table::TableRow row; rows->next(row);) {
    if (!meter_at || !time_at) {
      header.clear();
      for (const std::string_view cell : row.cells) header.push_back(utf8_of(cell));
      meter_at = table::find_column(header, shape.meter_column);
      time_at = table::find_time_in_header(header, shape);
      unit_at = table::find_column(header, shape.unit_column);
      if (!shape.time_column.starts_with('#')) continue;
    }
    if (*meter_at >= row.cells.size() || *time_at >= row.cells.size()) continue;
    const std::string_view name = row.cells[*meter_at];
    if (name.empty() || known.contains(name)) continue;
    if (!table::parse_stamp(row.cells[*time_at], shape.time_format)) continue;
    if (meters.size() == kMetersMax) {
      return failure(ErrorCode::malformed,
                     fmt::format("column {} has more than {} different names; if it does not "
                                 "name the meters, take it out",
                                 csv::in_quotes(shape.meter_column), kMetersMax));
    }
    const std::string text = utf8_of(name);
    known.emplace(std::string{name}, meters.size());
    const bool has_unit = unit_at && *unit_at < row.cells.size();
    for (const table::GuessedColumn& value : values) {
      const std::string called = values.size() == 1 ? text : text + " " + value.name;
      if (has_unit) {
        meters.push_back(
            described(called, text, value.column, utf8_of(row.cells[*unit_at]), "as its rows say"));
        continue;
      }
      // "sensor.main_energy_kwh"
      std::string in_name = value.unit.empty() ? table::split_unit(text).unit : "";
      const bool is_in_name = !in_name.empty();
      meters.push_back(described(called, text, value.column,
                                 is_in_name ? std::move(in_name) : value.unit,
                                 is_in_name ? "as its name says" : value.unit_because));
    }
  }
  if (rows->error()) return tl::unexpected(*rows->error());
  return meters;
}

metering::UnitFactors factors_of(const SurveyedMeter& meter) {
  metering::UnitFactors factors;
  if (meter.needs_heating_value) factors.gas_kWh_per_m3 = kTypicalGas_kWh_per_m3;
  return factors;
}

namespace {

/// "NAME=kWh" of this meter.
std::optional<std::string> unit_of(const SurveyedMeter& meter, const SurveyHints& hints) {
  for (const std::string& hint : hints.units) {
    const std::size_t sign = hint.rfind('=');
    if (sign == std::string::npos) continue;
    const std::string_view name = std::string_view{hint}.substr(0, sign);
    const bool is_of_it = name == meter.name || name == meter.column ||
                          (!meter.name_in_file.empty() && name == meter.name_in_file);
    if (is_of_it) return hint.substr(sign + 1);
  }
  if (!meter.unit.value.empty()) return {};
  const auto of_all = std::ranges::find_if(
      hints.units, [](const std::string& hint) { return hint.find('=') == std::string::npos; });
  return of_all == hints.units.end() ? std::nullopt : std::optional{*of_all};
}

void apply_units(const SurveyHints& hints, SurveyedExport& survey) {
  for (SurveyedMeter& meter : survey.meters) {
    auto unit = unit_of(meter, hints);
    if (!unit) continue;
    const bool is_register = meter.is_register;
    meter = described(meter.name, meter.name_in_file, meter.column, std::move(*unit), "as told");
    meter.is_register = is_register;
  }
}

/// Own files: meters and first units are found by reading it once.
Result<std::vector<SurveyedMeter>> meters_of_own(const std::filesystem::path& file) {
  table::TableGuess as_table;
  as_table.shape.separator = ',';
  as_table.shape.time_column = "timestamp";
  as_table.shape.meter_column = "meter";
  as_table.shape.unit_column = "unit";
  as_table.values.push_back({"value", "value", ""});
  return meters_of_rows(file, as_table);
}

/// Text that says itself what its readings are.
Container container_in_text(const std::vector<std::string>& lines) {
  const auto first = std::ranges::find_if(
      lines, [](const std::string& line) { return !csv::trimmed(line).empty(); });
  if (first != lines.end() && table::is_nem12(*first)) return Container::nem12;
  return table::is_influx_csv(lines) ? Container::influx : Container::text;
}

/// Channels in units that are no energy, as reactive power is, beside others that are.
void leave_out_other_quantities(SurveyedExport& survey) {
  const auto is_other = [](const SurveyedMeter& meter) {
    if (meter.unit.value.empty()) return false;
    const auto unit = metering::find_unit(meter.unit.value, meter.utility.value, factors_of(meter));
    return !unit && unit.error().code == ErrorCode::invalid_value;
  };
  if (std::ranges::all_of(survey.meters, is_other)) return;
  std::vector<std::string> words;
  for (const SurveyedMeter& meter : survey.meters) {
    if (is_other(meter)) words.push_back(fmt::format("{} ({})", meter.name, meter.unit.value));
  }
  if (words.empty()) return;
  std::erase_if(survey.meters, is_other);
  survey.notes.push_back(fmt::format("{}: not energy, and left out: {}.",
                                     survey.files.front().filename().string(),
                                     fmt::join(words, ", ")));
}

/// The water that flows through a heat meter is no gas, if only its unit says so.
void leave_out_volumes(SurveyedExport& survey) {
  const auto is_heat = [](const SurveyedMeter& meter) {
    return meter.utility.value == metering::Utility::heating ||
           meter.utility.value == metering::Utility::chilled_water;
  };
  if (std::ranges::none_of(survey.meters, is_heat)) return;
  std::vector<std::string> words;
  const auto is_volume = [&](const SurveyedMeter& meter) {
    const std::string name = table::folded(meter.name);
    return meter.utility.value == metering::Utility::gas &&
           meter.utility.because.starts_with("by its unit") &&
           name.find("gas") == std::string::npos;
  };
  for (const SurveyedMeter& meter : survey.meters) {
    if (is_volume(meter)) words.push_back(fmt::format("{} ({})", meter.name, meter.unit.value));
  }
  if (words.empty()) return;
  std::erase_if(survey.meters, is_volume);
  survey.notes.push_back(
      fmt::format("{}: beside heat these are volumes of its water, not gas, and left out: {}.",
                  survey.files.front().filename().string(), fmt::join(words, ", ")));
}

/// What neither a column nor a unit says, the file's name may: "Gas.csv".
void guess_by_file_name(SurveyedExport& survey) {
  if (survey.meters.size() != 1) return;
  SurveyedMeter& meter = survey.meters.front();
  const UtilityGuess by_file =
      guess_utility(survey.files.front().stem().string(), meter.unit.value);
  if (by_file.because != "by its name") return;
  if (meter.utility.because.starts_with("guessed")) {
    meter.utility = {by_file.utility, "by its file's name"};
  } else if (meter.utility.value != by_file.utility) {
    meter.utility.because +=
        fmt::format(", though its file's name says {}", metering::to_string(by_file.utility));
  }
}

/// Series without a unit, beside others that have one, are temperatures, switches and the like.
void leave_out_without_unit(SurveyedExport& survey) {
  const auto has_none = [](const SurveyedMeter& meter) { return meter.unit.value.empty(); };
  if (std::ranges::all_of(survey.meters, has_none)) {
    survey.table->shape.unit_column.clear();
    return;
  }
  std::vector<std::string> words;
  for (const SurveyedMeter& meter : survey.meters) {
    if (has_none(meter)) words.push_back(meter.name_in_file);
  }
  if (words.empty()) return;
  std::erase_if(survey.meters, has_none);
  survey.notes.push_back(fmt::format("{}: series without a unit of energy are left out: {}.",
                                     survey.files.front().filename().string(),
                                     fmt::join(words, ", ")));
}

/// Names of series without what all have in common, and without their units.
void shorten_names(std::vector<SurveyedMeter>& meters) {
  std::map<std::string, std::size_t> in_meters;
  const auto parts_of_name = [](const std::string& name) {
    std::vector<std::string> parts;
    for (std::size_t at = 0; at <= name.size();) {
      const std::size_t end = std::min(name.find(table::kNamesApart, at), name.size());
      parts.push_back(name.substr(at, end - at));
      at = end + table::kNamesApart.size();
    }
    return parts;
  };
  for (const SurveyedMeter& meter : meters) {
    for (const std::string& part : parts_of_name(meter.name)) ++in_meters[part];
  }
  for (SurveyedMeter& meter : meters) {
    std::string name;
    for (const std::string& part : parts_of_name(meter.name)) {
      const bool is_of_all = meters.size() > 1 && in_meters[part] == meters.size();
      if (is_of_all || table::is_unit(part) || part == "value" || part == "_value") continue;
      name += (name.empty() ? "" : " ") + part;
    }
    if (!name.empty()) meter.name = std::move(name);
  }
}

/// NEM12 and annotated CSV: meters and units are found by reading it once.
Result<SurveyedExport> export_with_description(const std::filesystem::path& file,
                                               Container container) {
  SurveyedExport survey{.files = {file}};
  survey.table.emplace();
  survey.table->shape = table::described_shape(container);
  survey.table->has_offsets = true;
  survey.table->values.push_back({"value", "value", ""});
  survey.meters = TRY(meters_of_rows(file, *survey.table));
  if (container == Container::influx) {
    leave_out_without_unit(survey);
    shorten_names(survey.meters);
    return survey;
  }
  for (SurveyedMeter& meter : survey.meters) {
    meter.utility = {metering::Utility::electricity, "as NEM12 is"};
  }
  survey.notes.push_back(
      fmt::format("{}: its times are the market's, UTC+10 all year (Etc/GMT-10), as NEM12 has them "
                  "wherever the meter is; channels B are what the building feeds in.",
                  file.filename().string()));
  return survey;
}

/// The only meter of a long table, if its rows name it by a number, is called as its values are.
void name_by_values(const table::TableGuess& guess, std::vector<SurveyedMeter>& meters) {
  if (meters.size() != 1 || guess.values.front().name.empty()) return;
  const std::string& name = meters.front().name;
  const auto figures = std::ranges::count_if(name, [](char c) { return c >= '0' && c <= '9'; });
  constexpr int kFiguresOfNumber = 6;
  if (figures < kFiguresOfNumber) return;
  const SurveyedMeter as_number = std::move(meters.front());
  meters.front() = described(guess.values.front().name, as_number.name_in_file, as_number.column,
                             as_number.unit.value, as_number.unit.because);
}

/// The clock that the name of its time column says, and what else of the guess should be looked at.
Result<void> take_words_of_guess(SurveyedExport& survey, table::TableGuess& guess) {
  const std::filesystem::path& file = survey.files.front();
  if (const auto said = table::offset_said(guess.shape.time_column); said && !guess.has_offsets) {
    const auto zone = zone_of_offset(*said);
    if (!zone) {
      return about(file,
                   {ErrorCode::unsupported,
                    "column " + csv::in_quotes(guess.shape.time_column) +
                        " has an offset that is no whole hour, which no zone of a fixed clock "
                        "has; export its times in UTC"});
    }
    guess.shape.timezone = *said == seconds{0} ? "Etc/UTC" : *zone;
    survey.clock_because = "by the time column's name";
  }
  const std::string name = file.filename().string();
  if (!guess.ignored.empty()) {
    survey.notes.push_back(
        fmt::format("{}: columns not used: {}.", name, fmt::join(guess.ignored, ", ")));
  }
  if (guess.decimal_because.starts_with("guessed")) {
    survey.notes.push_back(fmt::format("{}: the decimal sign is '{}', {}.", name,
                                       guess.shape.decimal, guess.decimal_because));
  }
  for (const std::string& note : guess.notes) {
    survey.notes.push_back(fmt::format("{}: {}", name, note));
  }
  return {};
}

Result<SurveyedExport> read_description(const std::filesystem::path& file,
                                        const SurveyHints& hints) {
  SurveyedExport survey{.files = {file}};
  const auto begin = TRY(first_bytes(file));
  const auto container = table::guess_container(begin);
  if (!container) return about(file, container.error());
  if (*container == Container::green_button) {
    survey.table.emplace();
    survey.table->shape = table::green_button_shape();
    survey.table->has_offsets = true;
    auto meters = meters_of_feed(file);
    if (!meters) return about(file, meters.error());
    survey.meters = std::move(*meters);
    leave_out_other_quantities(survey);
    return survey;
  }
  std::vector<std::string> lines;
  if (*container == Container::text) lines = TRY(first_lines(file));
  const Container inside = *container == Container::text ? container_in_text(lines) : *container;
  if (table::describes_itself(inside)) {
    auto described = export_with_description(file, inside);
    return described ? described : about(file, described.error());
  }
  if (inside == Container::text && is_own(lines)) {
    auto meters = meters_of_own(file);
    if (!meters) return about(file, meters.error());
    survey.meters = std::move(*meters);
    return survey;
  }
  auto guessed = guess_file(file, inside, lines, hints.table);
  if (!guessed) return about(file, guessed.error());
  table::TableGuess* const guess = &guessed->table;
  survey.layout_because = guessed->layout_because;
  survey.notes = std::move(guessed->notes);
  if (hints.table.columns.empty()) keep_the_load(*guess);
  if (guess->shape.meter_column.empty()) {
    survey.meters = meters_of_columns(*guess, file.stem().string());
  } else {
    auto meters = meters_of_rows(file, *guess);
    if (!meters) return about(file, meters.error());
    survey.meters = std::move(*meters);
    name_by_values(*guess, survey.meters);
  }
  TRY(take_words_of_guess(survey, *guess));
  leave_out_other_quantities(survey);
  survey.table = std::move(*guess);
  return survey;
}

}  // namespace

Result<SurveyedExport> described_export(const std::filesystem::path& file,
                                        const SurveyHints& hints) {
  auto survey = read_description(file, hints);
  if (!survey) return survey;
  apply_units(hints, *survey);
  leave_out_volumes(*survey);
  guess_by_file_name(*survey);
  return survey;
}

}  // namespace recald::daemon
