#include "adapters/system/files/regular_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <string>
#include <system_error>

namespace recald::system {

void make_private_file(const std::filesystem::path& file) {
  const int descriptor =
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kPrivateMode);
  if (descriptor >= 0) ::close(descriptor);
}

Result<void> require_file(const std::filesystem::path& file, std::string_view what) {
  const std::string named = std::string{what} + " '" + file.string() + "'";
  std::error_code error;
  const auto is_other = [&](const char* kind) {
    return failure(ErrorCode::io_failed,
                   named + " is a " + kind + ", not a file; save its content to a file first");
  };
  switch (const auto status = std::filesystem::status(file, error); status.type()) {
    case std::filesystem::file_type::not_found:
      return failure(ErrorCode::not_found, named + " does not exist");
    case std::filesystem::file_type::directory:
      return failure(ErrorCode::io_failed, named + " is a folder, not a file");
    case std::filesystem::file_type::fifo:
      return is_other("pipe");
    case std::filesystem::file_type::socket:
      return is_other("socket");
    case std::filesystem::file_type::block:
    case std::filesystem::file_type::character:
      return is_other("device");
    case std::filesystem::file_type::none:
      return failure(ErrorCode::io_failed, named + " cannot be reached: " + error.message());
    default:
      return {};
  }
}

}  // namespace recald::system
