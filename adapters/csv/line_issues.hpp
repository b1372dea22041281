/// Bad lines of a file: the first hundred in words, the rest counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace recald::csv {

struct LineIssue {
  std::uint64_t line;  ///< From 1; the header is line 1 unless comments precede it.
  std::string reason;
};

struct LineIssues {
  std::vector<LineIssue> listed;
  std::uint64_t total = 0;
  std::size_t listed_max = 100;

  void add(std::uint64_t line, std::string reason) {
    ++total;
    if (listed.size() < listed_max) listed.push_back({line, std::move(reason)});
  }
};

/// What a file's time stamps name.
enum class Stamps : std::uint8_t { start, end };

}  // namespace recald::csv
