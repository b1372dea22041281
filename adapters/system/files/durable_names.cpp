#include "adapters/system/files/durable_names.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace recald::system {
namespace {

/// @return 0, or the error that kept the bytes from reaching the disk.
int flush(const std::filesystem::path& file, int flags) {
  const int descriptor = ::open(file.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) return 0;
  const int error = ::fsync(descriptor) == 0 || errno == EINVAL ? 0 : errno;
  ::close(descriptor);
  return error;
}

}  // namespace

Result<void> flush_folder_of(const std::filesystem::path& file) {
  const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path{"."};
  const int error = flush(folder, O_RDONLY | O_DIRECTORY);
  if (error == 0) return {};
  return failure(ErrorCode::io_failed,
                 fmt::format("folder '{}' cannot be written: {}", folder.string(),
                             std::generic_category().message(error)));
}

Result<void> rename_durably(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code error{flush(from, O_RDONLY), std::generic_category()};
  if (!error) std::filesystem::rename(from, to, error);
  if (!error) return flush_folder_of(to);
  return failure(ErrorCode::io_failed, fmt::format("'{}' cannot become '{}': {}", from.string(),
                                                   to.string(), error.message()));
}

Result<void> remove_durably(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove(file, error);
  if (!error) return flush_folder_of(file);
  return failure(ErrorCode::io_failed,
                 fmt::format("'{}' cannot be removed: {}", file.string(), error.message()));
}

}  // namespace recald::system
