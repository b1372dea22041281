/// Files of results as they are served: with their type, and pages under a policy of their own.
#pragma once

#include <string>
#include <string_view>

#include "adapters/http/message.hpp"

namespace recald::daemon {

/// A plain name that ends in .html, .json or .csv: letters, digits, "_", "-" and ".", not beginning
/// with a dot.
[[nodiscard]] bool is_result_name(std::string_view name);

/// @pre is_result_name(name)
[[nodiscard]] http::Response result_response(std::string_view name, std::string bytes);

}  // namespace recald::daemon
