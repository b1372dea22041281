/// JSON on its way out.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "adapters/http/message.hpp"

namespace recald::daemon {

/// One line. Text that is no UTF-8 (a name out of a damaged file) is replaced and not an error.
[[nodiscard]] http::Response json_answer(const nlohmann::ordered_json& json, int status = 200);

}  // namespace recald::daemon
