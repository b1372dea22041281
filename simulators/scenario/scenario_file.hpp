/// Reads a scenario: one TOML file per building.
#pragma once

#include "simulators/scenario/scenario.hpp"

namespace recald::simulators {

/// All keys are optional; `README.md` lists them. Without a file the scenario is the
/// campus laboratory.
/// @return not_found      the file does not exist or cannot be read;
///         malformed      not TOML (file, line);
///         invalid_value  an unknown key, word or effect (with the nearest name), a value out of
///                        range, impossible effects; the sentence names file and line.
[[nodiscard]] Result<Scenario> read_scenario(const std::filesystem::path& path);

}  // namespace recald::simulators
