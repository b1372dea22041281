#include "daemon/site/config/service/site_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace recald::daemon {

std::filesystem::path resolve(const std::filesystem::path& site_file, const std::string& text,
                              std::string_view key, TomlReader& table) {
  std::string path = text;
  if (path.starts_with('$')) {
    const std::size_t slash = std::min(path.find('/'), path.size());
    const std::string name = path.substr(1, slash - 1);
    const char* value = std::getenv(name.c_str());
    if (value == nullptr) {
      table.problem_at(key, fmt::format("'{0}' begins with ${1}, but the environment variable {1} "
                                        "is not set; set it to the folder with the data",
                                        key, name));
      return {};
    }
    path = value + path.substr(slash);
  }
  const std::filesystem::path given{path};
  return given.is_absolute() ? given : site_file.parent_path() / given;
}

}  // namespace recald::daemon
