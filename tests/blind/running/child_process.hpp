/// One program, run to its end or to a limit, with its wall time and its peak memory.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace recald::blind {

enum class Ending {
  exited,      ///< By itself; `exit_code` counts.
  killed,      ///< By a signal from elsewhere; `signal` counts.
  over_limit,  ///< By us, at the limit.
  stopped,     ///< By us, because the caller wants to stop.
};

struct ProcessEnd {
  Ending ending = Ending::exited;
  int exit_code = 0;
  int signal = 0;
  double wall_s = 0.0;
  double cpu_s = 0.0;        ///< User and system time, with children it waited for.
  double peak_rss_MB = 0.0;  ///< Of the largest among the process and its children.
};

/// Runs the command in a process group of its own, which dies with it at the limit. It reads
/// nothing; what it says on both streams goes into the file `said`.
///
/// @param command  The program's path and its arguments.
/// @param stop     Looked at while waiting, some fifty times a second.
/// @return io_failed if it cannot be started.
[[nodiscard]] Result<ProcessEnd> run_process(const std::vector<std::string>& command,
                                             const std::filesystem::path& said, double limit_s,
                                             const std::atomic<bool>& stop);

}  // namespace recald::blind
