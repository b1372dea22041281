/// A new file that grows at its end, whole pieces at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "core/result.hpp"

namespace recald::system {

/// Nothing is buffered here: what was appended survives the end of the process, but not a power
/// cut.
class GrowingFile {
 public:
  /// For its owner alone. @return io_failed, also where something of that name exists.
  [[nodiscard]] static Result<GrowingFile> create(const std::filesystem::path& file);
  GrowingFile(GrowingFile&& other) noexcept;
  GrowingFile& operator=(GrowingFile&& other) noexcept;
  ~GrowingFile();

  /// Appends all of it or, as far as the disk allows, nothing. @return or io_failed.
  [[nodiscard]] Result<void> append(std::string_view piece);

  [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }

 private:
  GrowingFile(int descriptor, std::filesystem::path file)
      : descriptor_(descriptor), file_(std::move(file)) {}

  int descriptor_;
  std::filesystem::path file_;  ///< For messages.
  std::uint64_t size_bytes_ = 0;
};

}  // namespace recald::system
