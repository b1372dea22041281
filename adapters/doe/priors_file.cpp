#include "adapters/doe/priors_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "adapters/doe/table_reader.hpp"

namespace recald::doe {
namespace {

/// Columns of the file; the last two are optional.
struct Columns {
  std::size_t parameter;
  std::size_t unit;
  std::size_t min;
  std::size_t mode;
  std::size_t max;
  std::optional<std::size_t> distribution;
  std::optional<std::size_t> sd;
};

Result<Columns> find_columns(const TableReader& table) {
  std::array<std::size_t, 5> required{};
  constexpr std::array<std::string_view, 5> names{"parameter", "unit", "min", "mode", "max"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    required[i] = TRY(table.require(names[i]));
  }
  return Columns{required[0],     required[1], required[2],
                 required[3],     required[4], table.find("distribution"),
                 table.find("sd")};
}

/// The number in a column that the file may lack.
Result<std::optional<double>> number_if_any(const TableReader& table,
                                            const std::optional<std::size_t>& column) {
  if (!column) return std::optional<double>{};
  return table.number_or_blank(*column);
}

Result<PriorNumbers> read_numbers(const TableReader& table, const Columns& columns) {
  const std::array<std::optional<std::size_t>, 4> places{columns.min, columns.mode, columns.max,
                                                         columns.sd};
  std::array<std::optional<double>, 4> values;
  for (std::size_t i = 0; i < places.size(); ++i) {
    values[i] = TRY(number_if_any(table, places[i]));
  }
  return PriorNumbers{values[0], values[1], values[2], values[3]};
}

Result<Parameter> read_parameter(const TableReader& table, const Columns& columns,
                                 std::span<const Parameter> earlier) {
  std::string name{table.text(columns.parameter)};
  if (name.empty()) return table.wrong("the parameter has no name");
  if (std::ranges::find(earlier, name, &Parameter::name) != earlier.end()) {
    return table.wrong(fmt::format("parameter '{}' comes twice", name));
  }
  const auto numbers = TRY(read_numbers(table, columns));
  std::string_view distribution = columns.distribution ? table.text(*columns.distribution) : "";
  if (distribution.empty()) distribution = "triangular";
  auto prior = Prior::named(distribution, numbers);
  if (!prior) {
    Error error =
        table.wrong(fmt::format("parameter '{}': {}", name, prior.error().message)).value();
    error.code = prior.error().code;
    return tl::unexpected(std::move(error));
  }
  return Parameter{std::move(name), std::string{table.text(columns.unit)}, std::move(*prior)};
}

/// The shortest text that reads back as the same bits; blank for no value.
std::string field(std::optional<double> value) {
  return value && std::isfinite(*value) ? fmt::format("{}", *value) : "";
}

/// Quotes a text that would otherwise break the line.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string inside;
  for (const char c : text) inside += c == '"' ? std::string{"\"\""} : std::string{c};
  return '"' + inside + '"';
}

}  // namespace

Result<std::vector<Parameter>> read_priors(const std::filesystem::path& file) {
  auto table = TRY(TableReader::open(file));
  const auto columns = TRY(find_columns(table));
  std::vector<Parameter> parameters;
  for (;;) {
    const auto more = TRY(table.next());
    if (!more) break;
    auto parameter = TRY(read_parameter(table, columns, parameters));
    parameters.push_back(std::move(parameter));
  }
  if (!parameters.empty()) return parameters;
  return failure(ErrorCode::not_enough_data,
                 fmt::format("'{}' names no parameter; it needs a row for each", file.string()));
}

std::string priors_csv(std::span<const Parameter> parameters) {
  std::string text = "parameter,unit,min,mode,max,distribution,sd\n";
  for (const Parameter& parameter : parameters) {
    const PriorNumbers n = parameter.prior.numbers();
    text +=
        fmt::format("{},{},{},{},{},{},{}\n", quoted(parameter.name), quoted(parameter.unit),
                    field(n.min), field(n.mode), field(n.max), parameter.prior.name(), field(n.sd));
  }
  return text;
}

}  // namespace recald::doe
