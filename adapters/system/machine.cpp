#include "adapters/system/machine.hpp"

#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string_view>
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

}  // namespace recald::system
