#include "adapters/system/scratch_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

namespace recald::system {

Result<ScratchFolder> ScratchFolder::make() {
  std::error_code failed;
  const std::filesystem::path place = std::filesystem::temp_directory_path(failed);
  if (failed) return failure(ErrorCode::io_failed, "no temporary folder: " + failed.message());
  std::string name = (place / "recald-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    return failure(ErrorCode::io_failed, "cannot create " + name + ": " + std::strerror(errno));
  }
  return ScratchFolder{std::move(name)};
}

ScratchFolder::ScratchFolder(ScratchFolder&& other) noexcept
    : path_{std::exchange(other.path_, {})} {}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

}  // namespace recald::system
