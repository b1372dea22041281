#include "adapters/system/files/growing_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "adapters/system/files/regular_file.hpp"

namespace recald::system {
namespace {

tl::unexpected<Error> refused_growth(const char* what, const std::filesystem::path& file) {
  return failure(ErrorCode::io_failed, fmt::format("'{}' cannot be {}: {}", file.string(), what,
                                                   std::generic_category().message(errno)));
}

}  // namespace

Result<GrowingFile> GrowingFile::create(const std::filesystem::path& file) {
  const int descriptor =
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, kPrivateMode);
  if (descriptor < 0) return refused_growth("made", file);
  return GrowingFile{descriptor, file};
}

GrowingFile::GrowingFile(GrowingFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      file_(std::move(other.file_)),
      size_bytes_(other.size_bytes_) {}

GrowingFile& GrowingFile::operator=(GrowingFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(file_, other.file_);
  std::swap(size_bytes_, other.size_bytes_);
  return *this;
}

GrowingFile::~GrowingFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<void> GrowingFile::append(std::string_view piece) {
  std::size_t written = 0;
  while (written < piece.size()) {
    const ssize_t some = ::write(descriptor_, piece.data() + written, piece.size() - written);
    if (some > 0) {
      written += static_cast<std::size_t>(some);
    } else if (some == 0 || errno != EINTR) {
      const auto refused = refused_growth("written", file_);
      // Best effort: a reader takes the beginning of a piece for a kill.
      if (::ftruncate(descriptor_, static_cast<off_t>(size_bytes_)) != 0) size_bytes_ += written;
      return refused;
    }
  }
  size_bytes_ += written;
  return {};
}

}  // namespace recald::system
