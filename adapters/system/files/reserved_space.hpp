/// Disk space that is kept in reserve.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/result.hpp"

namespace recald::system {

/// A file that only takes up space until it is released. It outlives the process.
class ReservedSpace {
 public:
  ReservedSpace(std::filesystem::path file, std::uintmax_t bytes);

  /// Takes the space if twice as much is free: a reserve that fills the disk would cause the
  /// problem that it should prevent.
  /// @return io_failed with the system's reason, or how little is free.
  [[nodiscard]] Result<void> hold();

  /// @return whether there was anything to release.
  bool give_up();

  [[nodiscard]] bool is_held() const;

 private:
  std::filesystem::path file_;
  std::uintmax_t bytes_;
};

}  // namespace recald::system
