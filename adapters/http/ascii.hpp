/// Pieces of header fields.
#pragma once

#include <string_view>

#include "core/text/ascii.hpp"

namespace recald::http {

/// The text without surrounding spaces and tabs.
[[nodiscard]] inline std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// Takes the next element off a list "a, b, c". Elements are trimmed; quoted commas split too.
[[nodiscard]] inline std::string_view take_element(std::string_view& list, char separator = ',') {
  const std::size_t end = list.find(separator);
  const std::string_view element = trimmed(list.substr(0, end));
  list.remove_prefix(end == std::string_view::npos ? list.size() : end + 1);
  return element;
}

}  // namespace recald::http
