/// The seed of a test that draws what happens, in words wherever it fails: RECALD_SEED replays it.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <source_location>
#include <string>

namespace recald::testing {

/// While it lives, every failure says its value.
class Seed {
 public:
  /// @param usual  Where RECALD_SEED is not set.
  explicit Seed(std::uint64_t usual = 1,
                std::source_location where = std::source_location::current())
      : value_(given_or(usual)),
        trace_(where.file_name(), static_cast<int>(where.line()),
               "RECALD_SEED=" + std::to_string(value_)) {}

  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  static std::uint64_t given_or(std::uint64_t usual) {
    const char* given = std::getenv("RECALD_SEED");
    return given != nullptr ? std::strtoull(given, nullptr, 10) : usual;
  }

  std::uint64_t value_;
  ::testing::ScopedTrace trace_;
};

/// How much of something a study wants: a number in the environment, else what tests do.
inline int given_or(const char* variable, int otherwise) {
  const char* given = std::getenv(variable);
  return given != nullptr ? std::atoi(given) : otherwise;
}

}  // namespace recald::testing
