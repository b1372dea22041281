#include "adapters/system/files/reserved_space.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "adapters/system/files/regular_file.hpp"

namespace recald::system {
namespace {

constexpr std::uintmax_t kMebibyte = 1024 * 1024;

}  // namespace

ReservedSpace::ReservedSpace(std::filesystem::path file, std::uintmax_t bytes)
    : file_(std::move(file)), bytes_(bytes) {}

bool ReservedSpace::is_held() const {
  std::error_code error;
  return std::filesystem::file_size(file_, error) == bytes_ && !error;
}

Result<void> ReservedSpace::hold() {
  if (is_held()) return {};
  std::error_code error;
  const auto folder = std::filesystem::absolute(file_, error).parent_path();
  const auto space = std::filesystem::space(folder, error);
  if (!error && space.available < 2 * bytes_) {
    return failure(ErrorCode::io_failed,
                   fmt::format("'{}' cannot be made: only {} MiB are free, twice its {} MiB are "
                               "needed; make room on the disk",
                               file_.string(), space.available / kMebibyte, bytes_ / kMebibyte));
  }
  const int descriptor = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, kPrivateMode);
  int reason = errno;
  if (descriptor >= 0) {
    reason = ::posix_fallocate(descriptor, 0, static_cast<off_t>(bytes_));
    ::close(descriptor);
    if (reason == 0) return {};
    (void)give_up();
  }
  return failure(ErrorCode::io_failed, fmt::format("'{}' cannot be made: {}", file_.string(),
                                                   std::generic_category().message(reason)));
}

bool ReservedSpace::give_up() {
  std::error_code error;
  return std::filesystem::remove(file_, error);
}

}  // namespace recald::system
