/// The entries of a ZIP archive as streams.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "adapters/csv/line_reader.hpp"

namespace recald::table {

class Archive {
 public:
  /// @return the archive, or not_found, io_failed, malformed (not a ZIP); messages name the file.
  [[nodiscard]] static Result<Archive> open(const std::filesystem::path& file);

  [[nodiscard]] bool has(const std::string& entry) const;

  /// The entry's bytes, decompressed as they are read; outlives the archive.
  [[nodiscard]] Result<csv::ByteSource> bytes_of(const std::string& entry) const;

 private:
  struct Handle;
  std::shared_ptr<Handle> handle_;
};

}  // namespace recald::table
