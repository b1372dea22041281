/// How recald-sim ends.
#pragma once

#include <iostream>
#include <string>

namespace recald::simulators {

inline constexpr int kExitFailure = 1;
inline constexpr int kExitUsage = 2;

/// Prints the sentence; returns the exit code.
inline int failed(const std::string& sentence, int code = kExitFailure) {
  std::cerr << "recald-sim: " << sentence << '\n';
  return code;
}

}  // namespace recald::simulators
