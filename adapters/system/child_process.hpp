/// A program outside, run to its end under limits.
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
  std::filesystem::path folder;  ///< It works here.
  std::filesystem::path output;  ///< Gets what it writes to both streams.
  std::chrono::seconds time_max{3600};
  std::uint64_t memory_max_bytes = 0;  ///< Of address space, for it and what it starts; 0: none.
};

struct ChildEnd {
  enum class How { exited, signalled, timed_out, stopped };
  How how = How::exited;
  int code = 0;  ///< Exit status, or the signal.
};

/// Runs the program and waits. At the time limit, or when `keep_going` says no, it is killed with
/// all that it has started in its process group.
/// @param keep_going  Asked a few times a second; empty: always.
/// @return how it ended; or io_failed: it cannot be started.
[[nodiscard]] Result<ChildEnd> run_child(const ChildCommand& command,
                                         const std::function<bool()>& keep_going);

}  // namespace recald::system
