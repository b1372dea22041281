/// A guard before JSON from outside is parsed.
#pragma once

#include <cstddef>
#include <string_view>

namespace recald::daemon {

/// Whether JSON has more open brackets at once than that. Checked before parsing: a megabyte of
/// brackets would become a hundred times as much memory of nested values.
[[nodiscard]] inline bool is_nested_deeper(std::string_view json, int depth_max) {
  int depth = 0;
  bool is_text = false;
  for (std::size_t i = 0; i < json.size() && depth <= depth_max; ++i) {
    const char c = json[i];
    if (c == '"') is_text = !is_text;
    if (is_text && c == '\\') ++i;
    if (is_text) continue;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
  }
  return depth > depth_max;
}

}  // namespace recald::daemon
