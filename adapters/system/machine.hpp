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

/// Of the user that the process runs as; empty: the number has no name.
[[nodiscard]] std::string user_name();

/// Why a file cannot be opened for reading, without its name: "does not exist". Empty: it can.
[[nodiscard]] std::string why_unreadable(const std::filesystem::path& file);

/// Why nothing can be written into a folder, or, where it does not exist yet, why it cannot be
/// made. Empty: it can. Writes nothing.
[[nodiscard]] std::string why_unwritable(const std::filesystem::path& folder);

}  // namespace recald::system
