/// A program outside, run to its end or to a limit, with what it cost.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace recald::system {

struct ChildCommand {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::filesystem::path folder = ".";  ///< Where it works.
  std::filesystem::path output;        ///< Gets what it writes to both streams.
  std::chrono::duration<double> time_max{3600.0};
  std::uint64_t memory_max_bytes = 0;  ///< Of address space, for it and what it starts; 0: none.
};

enum class Ending {
  exited,      ///< By itself; `exit_code` counts.
  killed,      ///< By a signal from elsewhere; `signal` counts.
  over_limit,  ///< By us, at the time limit.
  stopped,     ///< By us, because the caller wants to stop.
};

struct ChildEnd {
  Ending ending = Ending::exited;
  int exit_code = 0;
  int signal = 0;
  double wall_s = 0.0;
  double cpu_s = 0.0;        ///< User and system time, with children it waited for.
  double peak_rss_MB = 0.0;  ///< Of the largest among the process and its children.
};

/// Runs the program in a process group of its own, which dies with it at the limit. It reads
/// nothing.
/// @param keep_going  Asked some fifty times a second; empty: always.
/// @return io_failed if it cannot be started.
[[nodiscard]] Result<ChildEnd> run_child(const ChildCommand& command,
                                         const std::function<bool()>& keep_going);

}  // namespace recald::system
