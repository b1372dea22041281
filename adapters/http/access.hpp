/// Who may do what: tokens with rights, and the names under which a server is asked.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/http/message.hpp"

namespace recald::http {

enum class Right : std::uint8_t {
  read,     ///< GET and HEAD.
  push,     ///< POST to `push_paths`.
  operate,  ///< Everything else.
};

[[nodiscard]] std::string_view name_of(Right right);

struct Token {
  std::string text;
  std::set<Right> rights{Right::read, Right::push, Right::operate};
};

struct AccessRules {
  std::vector<Token> tokens;         ///< Empty: none is required.
  std::set<std::string> open_paths;  ///< Answered without a token.
  std::set<std::string> push_paths;
  /// Whether `Host` must be a name of this machine for itself or one of `names`. Without that, a
  /// page whose name is made to point to this machine (DNS rebinding) would pass for one of ours.
  bool checks_host = false;
  std::set<std::string> names;  ///< In lower case, without a port.
};

/// @return 421 for a `Host` that is none of this server's; 401 without one of the tokens; 403 with
///         one that has not the right that the request needs; or nothing.
[[nodiscard]] std::optional<Response> refusal_of_access(const Request& request,
                                                        const AccessRules& rules);

}  // namespace recald::http
