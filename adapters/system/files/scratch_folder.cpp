#include "adapters/system/files/scratch_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

namespace recald::system {

Result<ScratchFolder> ScratchFolder::make(std::filesystem::path place, const std::string& name) {
  std::error_code failed;
  if (place.empty()) place = std::filesystem::temp_directory_path(failed);
  if (failed) return failure(ErrorCode::io_failed, "no temporary folder: " + failed.message());
  std::string path = (place / (name + "XXXXXX")).string();
  if (::mkdtemp(path.data()) == nullptr) {
    return failure(ErrorCode::io_failed, "cannot create " + path + ": " + std::strerror(errno));
  }
  return ScratchFolder{std::move(path)};
}

ScratchFolder::ScratchFolder(ScratchFolder&& other) noexcept
    : path_{std::exchange(other.path_, {})} {}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

}  // namespace recald::system
