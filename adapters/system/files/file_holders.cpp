#include "adapters/system/files/file_holders.hpp"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>

namespace recald::system {
namespace {

namespace fs = std::filesystem;

std::optional<int> process_number(const fs::path& folder) {
  const std::string name = folder.filename().string();
  int number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc{} || end != name.data() + name.size()) return {};
  return number;
}

/// Processes may end while we look at them, so nothing here is an error.
bool has_open(const fs::path& process, const fs::path& file) {
  std::error_code ignored;
  for (fs::directory_iterator one{process / "fd", ignored}, end; one != end;
       one.increment(ignored)) {
    if (fs::read_symlink(one->path(), ignored) == file) return true;
  }
  return false;
}

}  // namespace

std::vector<FileHolder> holders_of(const fs::path& file) {
  std::vector<FileHolder> holders;
  std::error_code ignored;
  const fs::path real = fs::canonical(file, ignored);
  if (real.empty()) return holders;
  for (fs::directory_iterator one{"/proc", ignored}, end; one != end; one.increment(ignored)) {
    const auto number = process_number(one->path());
    if (!number || *number == ::getpid() || !has_open(one->path(), real)) continue;
    FileHolder holder{*number, ""};
    std::ifstream{one->path() / "comm"} >> holder.name;
    holders.push_back(std::move(holder));
  }
  std::ranges::sort(holders, {}, &FileHolder::process);
  return holders;
}

}  // namespace recald::system
