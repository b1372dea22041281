/// The target of a request: path and query, decoded and checked.
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
/// Accepts any bytes; nothing from a client is trusted. A repeated name is an error, since two
/// programs in a row could pick different values.
/// @return the target; or malformed: no path, a wrong escape, a control character, not UTF-8, a
///         repeated name, more than 32 names, longer than 8 KiB.
[[nodiscard]] Result<Target> parse_target(std::string_view text);

}  // namespace recald::http
