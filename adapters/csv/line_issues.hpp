/// The bad lines of a file: the first hundred are described, the rest counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/text/printable.hpp"

namespace recald::csv {

inline constexpr std::size_t kExcerptMax = 80;  ///< Bytes of a bad line that are shown.

struct LineIssue {
  std::uint64_t line;  ///< From 1; the header is line 1 unless comments precede it.
  std::string reason;
  std::string text = {};  ///< The start of the line; empty if it is no longer known.
};

/// The start of a line, made safe to print.
[[nodiscard]] inline std::string excerpt(std::string_view line) {
  if (line.size() <= kExcerptMax) return printable(line);
  std::size_t end = kExcerptMax;  // do not cut within a multi-byte character
  while (end > 0 && (static_cast<unsigned char>(line[end]) & 0xC0u) == 0x80u) --end;
  return printable(line.substr(0, end)) + "…";
}

struct LineIssues {
  std::vector<LineIssue> listed;
  std::uint64_t total = 0;
  std::size_t listed_max = 100;

  /// @param text  The line itself.
  void add(std::uint64_t line, std::string_view reason, std::string_view text = {}) {
    ++total;
    // Reasons quote the file, which may contain anything.
    if (listed.size() < listed_max) listed.push_back({line, printable(reason), excerpt(text)});
  }

  void append(LineIssues more) {
    total += more.total;
    for (LineIssue& issue : more.listed) {
      if (listed.size() < listed_max) listed.push_back(std::move(issue));
    }
  }
};

/// What a file's time stamps mark.
enum class Stamps : std::uint8_t { start, end };

}  // namespace recald::csv
