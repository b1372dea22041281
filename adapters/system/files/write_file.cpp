#include "adapters/system/files/write_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <string>
#include <system_error>

#include "adapters/system/files/durable_names.hpp"

namespace recald::system {
namespace {

tl::unexpected<Error> cannot_write(const std::filesystem::path& file, int error) {
  return failure(ErrorCode::io_failed,
                 "cannot write '" + file.string() + "': " + std::generic_category().message(error));
}

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// Holds Ctrl-C and SIGTERM back for this thread, so that no half-written file is left.
class HeldSignals {
 public:
  HeldSignals() {
    sigset_t held;
    sigemptyset(&held);
    sigaddset(&held, SIGINT);
    sigaddset(&held, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &held, &before_);
  }
  ~HeldSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

 private:
  sigset_t before_;
};

}  // namespace

Result<void> write_file(const std::filesystem::path& file, std::string_view bytes) {
  const HeldSignals held;
  std::filesystem::path part = file;
  part += ".part";
  const int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor < 0) return cannot_write(file, errno);
  const bool written = write_all(descriptor, bytes) && ::fsync(descriptor) == 0;
  const int error = errno;
  ::close(descriptor);
  if (!written || std::rename(part.c_str(), file.c_str()) != 0) {
    const int reason = written ? errno : error;
    ::unlink(part.c_str());
    return cannot_write(file, reason);
  }
  return flush_folder_of(file);
}

Result<void> make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    return failure(ErrorCode::io_failed,
                   "cannot create folder '" + folder.string() + "': " + error.message());
  }
  return {};
}

}  // namespace recald::system
