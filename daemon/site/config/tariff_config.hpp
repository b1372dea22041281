/// What energy costs and emits, as a site file says it.
#pragma once

#include "adapters/toml/toml_reader.hpp"
#include "core/tariff/tariff.hpp"

namespace recald::daemon {

/// [tariff]
void read_tariff(TomlReader& table, tariff::Tariff& tariff);

/// [emissions]
void read_emissions(TomlReader& table, tariff::Tariff& tariff);

}  // namespace recald::daemon
