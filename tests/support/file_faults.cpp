#include "tests/support/file_faults.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <linux/limits.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>

namespace recald::testing {

std::function<int(const FileChange&)> before_file_change;

namespace {

/// 0, or errno is set.
int asked(std::string_view call, const char* path, const char* to = "") {
  if (!before_file_change) return 0;
  const int error = before_file_change({call, path, to});
  if (error != 0) errno = error;
  return error;
}

int asked(std::string_view call, int file) {
  if (!before_file_change) return 0;
  char path[PATH_MAX] = "";
  const std::string link = "/proc/self/fd/" + std::to_string(file);
  const ssize_t size = ::readlink(link.c_str(), path, sizeof path - 1);
  return asked(call, size < 0 ? "" : path);
}

/// Of a name in an open folder, as std::filesystem::remove_all deletes what is in one.
int asked(std::string_view call, int folder, const char* name) {
  if (!before_file_change) return 0;
  if (folder == AT_FDCWD || name[0] == '/') return asked(call, name);
  char path[PATH_MAX] = "";
  const std::string link = "/proc/self/fd/" + std::to_string(folder);
  const ssize_t size = ::readlink(link.c_str(), path, sizeof path - 1);
  return asked(call, ((size < 0 ? "" : path) + std::string{"/"} + name).c_str());
}

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

/// Opening changes something only where it may make or cut a file.
bool changes(int flags) { return (flags & (O_CREAT | O_TRUNC)) != 0; }

}  // namespace

FailingChanges::FailingChanges(int nth, int error, bool lasting) {
  before_file_change = [this, nth, error, lasting](const FileChange&) {
    if (++seen_ < nth || (!lasting && seen_ > nth)) return 0;
    has_failed_ = true;
    return error;
  };
}

FailingChanges::~FailingChanges() { before_file_change = {}; }

void end_process_before_change(int nth, int exit_code) {
  before_file_change = [nth, exit_code, seen = 0](const FileChange&) mutable {
    if (++seen == nth) ::_exit(exit_code);
    return 0;
  };
}

}  // namespace recald::testing

// The C library's functions, with its own declarations.
extern "C" {

#define RECALD_LIST(...) __VA_ARGS__
#define RECALD_FORWARD(type, name, parameters, arguments, what)                \
  type name parameters {                                                       \
    if (recald::testing::asked(#name, RECALD_LIST what) != 0) return -1;       \
    static const auto real = recald::testing::real<type(*) parameters>(#name); \
    return real arguments;                                                     \
  }

RECALD_FORWARD(int, rename, (const char* from, const char* to) noexcept, (from, to), (from, to))
RECALD_FORWARD(int, link, (const char* from, const char* to) noexcept, (from, to), (from, to))
RECALD_FORWARD(int, unlink, (const char* path) noexcept, (path), (path))
RECALD_FORWARD(int, unlinkat, (int folder, const char* name, int flags) noexcept,
               (folder, name, flags), (folder, name))
RECALD_FORWARD(int, remove, (const char* path) noexcept, (path), (path))
RECALD_FORWARD(int, mkdir, (const char* path, mode_t mode) noexcept, (path, mode), (path))
// The disk of the machine is spared: no test needs it to outlive one.
int fsync(int file) { return recald::testing::asked("fsync", file) != 0 ? -1 : 0; }
int fdatasync(int file) { return recald::testing::asked("fdatasync", file) != 0 ? -1 : 0; }
RECALD_FORWARD(int, ftruncate, (int file, off_t size) noexcept, (file, size), (file))
RECALD_FORWARD(int, ftruncate64, (int file, off64_t size) noexcept, (file, size), (file))
RECALD_FORWARD(ssize_t, pwrite, (int file, const void* bytes, size_t size, off_t at),
               (file, bytes, size, at), (file))
RECALD_FORWARD(ssize_t, pwrite64, (int file, const void* bytes, size_t size, off64_t at),
               (file, bytes, size, at), (file))

int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = recald::testing::changes(flags) ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  if (recald::testing::changes(flags) && recald::testing::asked("open", path) != 0) return -1;
  static const auto real = recald::testing::real<int (*)(const char*, int, ...)>("open");
  return real(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = recald::testing::changes(flags) ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  if (recald::testing::changes(flags) && recald::testing::asked("open64", path) != 0) return -1;
  static const auto real = recald::testing::real<int (*)(const char*, int, ...)>("open64");
  return real(path, flags, mode);
}

}  // extern "C"
