#include "adapters/system/machine.hpp"

#include <fcntl.h>
#include <pwd.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>
#include <string_view>
#include <system_error>
#include <thread>

namespace recald::system {
namespace {

namespace fs = std::filesystem;

/// The rest of the line that begins with `key`, without quotes; empty: none does.
std::string value_in(const fs::path& file, std::string_view key) {
  std::ifstream in{file};
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(key)) continue;
    std::string value = line.substr(key.size());
    std::erase(value, '"');
    return value;
  }
  return {};
}

/// Of "MemTotal:       16314220 kB"
std::uint64_t memory_bytes(std::string_view key) {
  const std::string value = value_in("/proc/meminfo", key);
  return 1024 * std::strtoull(value.c_str(), nullptr, 10);
}

/// A PC has four ports in its tables; those without hardware are of type 0.
bool has_hardware(const fs::path& port) {
  std::error_code ignored;
  if (!fs::exists(port / "device", ignored)) return false;
  std::ifstream in{port / "type"};
  int type = 1;  // a USB adapter has no such file
  return !(in >> type) || type != 0;
}

}  // namespace

Machine this_machine() {
  Machine machine{.system = value_in("/etc/os-release", "PRETTY_NAME="),
                  .processors = std::thread::hardware_concurrency(),
                  .memory_bytes = memory_bytes("MemTotal:"),
                  .memory_free_bytes = memory_bytes("MemAvailable:")};
  utsname names{};
  if (::uname(&names) == 0) {
    machine.kernel = std::string{names.sysname} + " " + names.release;
    machine.architecture = names.machine;
  }
  return machine;
}

std::vector<fs::path> serial_ports() {
  std::vector<fs::path> ports;
  std::error_code ignored;
  for (fs::directory_iterator one{"/sys/class/tty", ignored}, end; one != end;
       one.increment(ignored)) {
    const fs::path device = fs::path{"/dev"} / one->path().filename();
    if (has_hardware(one->path()) && fs::exists(device, ignored)) ports.push_back(device);
  }
  std::ranges::sort(ports);
  return ports;
}

bool may_use(const fs::path& file) { return ::access(file.c_str(), R_OK | W_OK) == 0; }

std::string user_name() {
  passwd entry{};
  passwd* found = nullptr;
  std::array<char, 4096> text{};
  const int failed = ::getpwuid_r(::geteuid(), &entry, text.data(), text.size(), &found);
  return failed == 0 && found != nullptr ? found->pw_name : "";
}

std::string why_unreadable(const fs::path& file) {
  // A pipe that nobody writes to must not keep us waiting.
  const int handle = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (handle < 0) {
    if (errno == ENOENT || errno == ENOTDIR) return "does not exist";
    if (errno == EACCES) return "may not be read by this user";
    return std::string{"cannot be opened: "} + std::generic_category().message(errno);
  }
  struct stat status {};
  const bool is_known = ::fstat(handle, &status) == 0;
  ::close(handle);
  if (!is_known || S_ISREG(status.st_mode)) return {};
  return S_ISDIR(status.st_mode) ? "is a folder, not a file" : "is not a file";
}

std::string why_unwritable(const fs::path& folder) {
  std::error_code ignored;
  const fs::path absolute = fs::absolute(folder, ignored);
  fs::path there = absolute;
  while (!fs::exists(there, ignored) && there.has_relative_path()) there = there.parent_path();
  const std::string what = there == absolute ? "" : "does not exist, and " + there.string() + " ";
  if (!fs::is_directory(there, ignored)) return what + "is not a folder";
  if (::faccessat(AT_FDCWD, there.c_str(), W_OK | X_OK, AT_EACCESS) == 0) return {};
  return what + "may not be written by this user";
}

}  // namespace recald::system
