/// Lets only one process at a time run.
#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace recald::system {

/// Locks a file for its lifetime. The system releases the lock when the process ends,
/// however it ends.
class FileLock {
 public:
  /// @return unsupported when another process holds the lock, io_failed when the file
  ///         cannot be created.
  [[nodiscard]] static Result<FileLock> acquire(const std::filesystem::path& file);

  /// Whether another process holds the lock, without creating the file. For a moment nobody else
  /// can take it.
  [[nodiscard]] static bool is_held(const std::filesystem::path& file);

  ~FileLock();
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&& other) noexcept;

 private:
  explicit FileLock(int descriptor) : descriptor_(descriptor) {}

  int descriptor_;
};

}  // namespace recald::system
