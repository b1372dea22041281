/// A folder for a moment.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.hpp"

namespace recald::system {

/// New, private, and gone with all that is in it when the value is.
class ScratchFolder {
 public:
  /// @param place  An existing folder; empty: where the system keeps temporary files.
  /// @param name   What its name begins with.
  /// @return io_failed with the path and the reason.
  [[nodiscard]] static Result<ScratchFolder> make(std::filesystem::path place = {},
                                                  const std::string& name = "recald-");

  ~ScratchFolder();
  ScratchFolder(ScratchFolder&& other) noexcept;
  ScratchFolder& operator=(ScratchFolder&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit ScratchFolder(std::filesystem::path path) : path_{std::move(path)} {}

  std::filesystem::path path_;  ///< Empty: moved from.
};

}  // namespace recald::system
