/// The [building] table of a site file.
#pragma once

#include "adapters/toml/toml_reader.hpp"
#include "core/model/building.hpp"

namespace recald::daemon {

/// Problems go to the reader; what could be read comes back.
[[nodiscard]] model::Building read_building(TomlReader table);

}  // namespace recald::daemon
