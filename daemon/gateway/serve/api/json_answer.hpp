/// JSON responses.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "adapters/http/message.hpp"

namespace recald::daemon {

/// One line. Text that is not UTF-8 (a name from a damaged file) is replaced, not refused.
[[nodiscard]] http::Response json_answer(const nlohmann::ordered_json& json, int status = 200);

}  // namespace recald::daemon
