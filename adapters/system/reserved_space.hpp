/// Room on a disk that is kept for bad times.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/result.hpp"

namespace recald::system {

/// A file that does nothing but take up space, until it is given up. It outlives the process.
class ReservedSpace {
 public:
  ReservedSpace(std::filesystem::path file, std::uintmax_t bytes);

  /// Takes the room, where twice as much is free: a reserve that fills the disk would do the harm
  /// that it is there against.
  /// @return io_failed with what the system said, or how little is free.
  [[nodiscard]] Result<void> hold();

  /// @return whether there was anything to give up.
  bool give_up();

  [[nodiscard]] bool is_held() const;

 private:
  std::filesystem::path file_;
  std::uintmax_t bytes_;
};

}  // namespace recald::system
