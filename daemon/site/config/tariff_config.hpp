/// What energy costs and emits, as a site file says it.
#pragma once

#include "core/tariff/tariff.hpp"
#include "daemon/site/config/toml_reader.hpp"

namespace recald::daemon {

/// [tariff]
void read_tariff(TomlReader& table, tariff::Tariff& tariff);

/// [emissions]
void read_emissions(TomlReader& table, tariff::Tariff& tariff);

}  // namespace recald::daemon
