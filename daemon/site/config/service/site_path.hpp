/// Paths in a site file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "adapters/toml/toml_reader.hpp"

namespace recald::daemon {

/// Relative to the site file; a leading $NAME comes from the environment, so that a site file can
/// point at data that is kept elsewhere. A name that the environment lacks is a problem at `key`.
[[nodiscard]] std::filesystem::path resolve(const std::filesystem::path& site_file,
                                            const std::string& text, std::string_view key,
                                            TomlReader& table);

}  // namespace recald::daemon
