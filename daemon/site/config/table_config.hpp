/// Keys of a [[meter]] whose readings are in an export of another program.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adapters/table/table_shape.hpp"
#include "adapters/toml/toml_reader.hpp"
#include "core/metering/units.hpp"

namespace recald::daemon {

/// How the file of a recorded meter is read, unless it is recald's own CSV.
struct TableConfig {
  table::TableShape shape;
  std::string column;                          ///< With the meter's values.
  std::vector<std::string> further_columns{};  ///< Of the same load: phases, tariffs.
  std::string unit;                            ///< Of them; empty: the file says it in a column.
};

/// Whether the file is such an export: by 'format', else by its keys and its name.
[[nodiscard]] bool is_table(TomlReader& meter, const std::filesystem::path& file);

/// @param known_units  What the unit is checked with.
[[nodiscard]] TableConfig read_table_config(TomlReader& meter, const std::filesystem::path& file,
                                            metering::Utility utility,
                                            const metering::UnitFactors& known_units);

}  // namespace recald::daemon
