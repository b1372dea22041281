/// ZIP archives of what a test says, such as workbooks.
#pragma once

#include <zip.h>

#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>

namespace recald::testing {

/// @param entries  Name and bytes of each.
inline void write_zip(const std::filesystem::path& file,
                      const std::map<std::string, std::string>& entries) {
  int code = 0;
  zip_t* archive = zip_open(file.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  if (archive == nullptr) throw std::runtime_error("cannot make the archive");
  for (const auto& [name, bytes] : entries) {
    zip_source_t* source = zip_source_buffer(archive, bytes.data(), bytes.size(), 0);
    if (source == nullptr || zip_file_add(archive, name.c_str(), source, ZIP_FL_OVERWRITE) < 0) {
      throw std::runtime_error("cannot write the archive");
    }
  }
  if (zip_close(archive) != 0) throw std::runtime_error("cannot close the archive");
}

}  // namespace recald::testing
