/// Bad lines of a file: the first hundred in words, the rest counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/text/printable.hpp"

namespace recald::csv {

struct LineIssue {
  std::uint64_t line;  ///< From 1; the header is line 1 unless comments precede it.
  std::string reason;
};

struct LineIssues {
  std::vector<LineIssue> listed;
  std::uint64_t total = 0;
  std::size_t listed_max = 100;

  void add(std::uint64_t line, std::string_view reason) {
    ++total;
    // Reasons quote what stands in the file, whatever that is.
    if (listed.size() < listed_max) listed.push_back({line, printable(reason)});
  }
};

/// What a file's time stamps name.
enum class Stamps : std::uint8_t { start, end };

}  // namespace recald::csv
