/// Where the versions of a site's model are kept.
#pragma once

#include <filesystem>

namespace recald::models {

/// SITE.models beside a file SITE.toml.
[[nodiscard]] inline std::filesystem::path versions_folder(const std::filesystem::path& site_file) {
  return site_file.parent_path() / (site_file.stem().string() + ".models");
}

}  // namespace recald::models
