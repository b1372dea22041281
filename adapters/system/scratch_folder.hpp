/// A folder for a moment.
#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace recald::system {

/// New, private, and gone with all that is in it when the value is.
class ScratchFolder {
 public:
  /// Where the system keeps temporary files. @return io_failed with the path and the reason.
  [[nodiscard]] static Result<ScratchFolder> make();

  ~ScratchFolder();
  ScratchFolder(ScratchFolder&& other) noexcept;
  ScratchFolder& operator=(ScratchFolder&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit ScratchFolder(std::filesystem::path path) : path_{std::move(path)} {}

  std::filesystem::path path_;  ///< Empty: moved from.
};

}  // namespace recald::system
