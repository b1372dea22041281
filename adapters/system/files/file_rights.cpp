#include "adapters/system/files/file_rights.hpp"

#include <sys/stat.h>
#include <unistd.h>

namespace recald::system {

void own_like(const std::filesystem::path& file, const std::filesystem::path& other) {
  struct stat about {};
  if (::stat(other.c_str(), &about) != 0) return;
  [[maybe_unused]] const int refused = ::chown(file.c_str(), about.st_uid, about.st_gid);
}

}  // namespace recald::system
