/// One process at a time.
#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace recald::system {

/// Holds a file as long as it lives; the system lets go of it when the process ends, however it
/// ends.
class FileLock {
 public:
  /// @return unsupported when another process holds it, io_failed when it cannot be made.
  [[nodiscard]] static Result<FileLock> take(const std::filesystem::path& file);

  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&& other) noexcept;

 private:
  explicit FileLock(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
};

}  // namespace recald::system
