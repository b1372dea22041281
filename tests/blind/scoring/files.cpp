#include "tests/blind/scoring/files.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <system_error>

namespace recald::blind {

Result<std::string> read_file(const std::filesystem::path& file) {
  std::ifstream in{file, std::ios::binary};
  if (!in) return failure(ErrorCode::not_found, "cannot open '" + file.string() + "'");
  std::ostringstream text;
  // An empty file sets failbit on `text`, a read error sets badbit on `in`.
  text << in.rdbuf();
  if (in.bad() || std::filesystem::is_directory(file)) {
    return failure(ErrorCode::io_failed, "cannot read '" + file.string() + "'");
  }
  return text.str();
}

Result<std::vector<std::string>> names_in(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::string> names;
  for (std::filesystem::directory_iterator entry{folder, error}, end; !error && entry != end;
       entry.increment(error)) {
    names.push_back(entry->path().filename().string());
  }
  if (error) {
    return failure(ErrorCode::not_found,
                   "cannot list the folder '" + folder.string() + "': " + error.message());
  }
  std::ranges::sort(names);
  return names;
}

}  // namespace recald::blind
