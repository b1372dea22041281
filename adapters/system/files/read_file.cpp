#include "adapters/system/files/read_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "adapters/system/files/regular_file.hpp"

namespace recald::system {

Result<std::string> read_file(const std::filesystem::path& file) {
  TRY(require_file(file, "file"));
  std::ifstream in{file, std::ios::binary};
  std::string bytes{std::istreambuf_iterator<char>{in}, {}};
  if (in.bad() || !in) {
    return failure(ErrorCode::io_failed,
                   fmt::format("'{}' cannot be read: {}", file.string(), std::strerror(errno)));
  }
  return bytes;
}

}  // namespace recald::system
