/// What of a site file the meters of a gateway need, so that it can be read on another machine.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.hpp"
#include "daemon/site/config/register_map_file.hpp"

namespace recald::daemon {

struct PortableSite {
  /// [site], each [bus] and the meters that are polled, pushed or told by a broker. Everything else
  /// is left out: models, addresses of others, users, names of files with secrets.
  std::string text;
  MapTexts maps;  ///< Register maps of its own that it names; shipped ones come with recald.
};

/// @return or why the file, or a register map that it names, cannot be read.
[[nodiscard]] Result<PortableSite> read_portable_site(const std::filesystem::path& file);

}  // namespace recald::daemon
