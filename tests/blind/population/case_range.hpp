/// Part of a population, as its cases are counted on a command line.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace recald::blind {

/// First and last case, counted from 1.
struct CaseRange {
  std::size_t first;
  std::size_t last;

  [[nodiscard]] std::size_t size() const { return last - first + 1; }
};

/// "3" or "3-17"; empty for all of `size` cases. Nothing where the text is neither, or where the
/// population has no such case.
[[nodiscard]] std::optional<CaseRange> case_range_of(const std::string& text, std::size_t size);

}  // namespace recald::blind
