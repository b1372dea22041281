#include "simulators/feed/write_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

namespace recald::simulators {

Result<void> make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error) return {};
  return failure(ErrorCode::io_failed, "cannot make the folder " + folder.string() + ": " +
                                           error.message() + "; choose another with --out");
}

Result<void> write_file(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (file) return {};
  return failure(ErrorCode::io_failed, "cannot write " + path.string() + ": " +
                                           std::strerror(errno) +
                                           "; choose a folder with --out that can be written");
}

}  // namespace recald::simulators
