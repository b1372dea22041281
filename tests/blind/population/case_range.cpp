#include "tests/blind/population/case_range.hpp"

#include <sstream>

namespace recald::blind {

std::optional<CaseRange> case_range_of(const std::string& text, std::size_t size) {
  if (text.empty()) return CaseRange{1, size};
  std::size_t first = 0;
  std::size_t last = 0;
  char dash = 0;
  char rest = 0;
  std::istringstream words(text);
  if (!(words >> first)) return std::nullopt;
  last = words >> dash ? 0 : first;
  if (dash != 0 && (dash != '-' || !(words >> last))) return std::nullopt;
  if (words >> rest || first < 1 || first > last || last > size) return std::nullopt;
  return CaseRange{first, last};
}

}  // namespace recald::blind
