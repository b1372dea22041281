/// The machine that the program runs on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace recald::system {

struct Machine {
  std::string system;        ///< "Debian GNU/Linux 12 (bookworm)", as /etc/os-release has it.
  std::string kernel;        ///< "Linux 6.1.0-18-amd64"
  std::string architecture;  ///< "x86_64"
  unsigned processors = 0;
  std::uint64_t memory_bytes = 0;       ///< 0: unknown, as the next.
  std::uint64_t memory_free_bytes = 0;  ///< What programs may still take.
};

[[nodiscard]] Machine this_machine();

/// "/dev/ttyUSB0" and so on, sorted: ports with hardware behind them, without opening one.
[[nodiscard]] std::vector<std::filesystem::path> serial_ports();

/// Whether this process may read and write a file or device. Opens nothing.
[[nodiscard]] bool may_use(const std::filesystem::path& file);

}  // namespace recald::system
