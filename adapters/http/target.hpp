/// What a request line asks for: path and query, decoded and checked.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "core/result.hpp"

namespace recald::http {

struct Target {
  std::string path;  ///< Decoded; begins with '/'.
  std::map<std::string, std::string> query;
};

/// Origin form ("/path?a=1&b=2") and absolute form ("http://host/path"); '+' in a query is a space.
///
/// Takes anything: nothing that a client sends is believed. A name given twice is an error and not
/// a choice, since two programs in a row could choose differently.
/// @return or malformed: no path, a wrong escape, a control character, no UTF-8, a name twice, more
///         than 32 names, longer than 8 KiB.
[[nodiscard]] Result<Target> parse_target(std::string_view text);

}  // namespace recald::http
