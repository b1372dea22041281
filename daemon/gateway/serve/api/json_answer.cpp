#include "daemon/gateway/serve/api/json_answer.hpp"

#include <nlohmann/json.hpp>

namespace recald::daemon {

http::Response json_answer(const nlohmann::ordered_json& json, int status) {
  return http::json_response(
      json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n", status);
}

}  // namespace recald::daemon
