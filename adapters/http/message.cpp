#include "adapters/http/message.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "adapters/http/ascii.hpp"

namespace recald::http {

std::string_view Request::header(const std::string& lower_case_name) const {
  const auto found = headers.find(lower_case_name);
  return found == headers.end() ? std::string_view{} : std::string_view{found->second};
}

std::string_view Response::header(std::string_view name) const {
  const auto found = std::ranges::find_if(
      headers, [&](const auto& one) { return equals_ignoring_case(one.first, name); });
  return found == headers.end() ? std::string_view{} : std::string_view{found->second};
}

Response json_response(std::string body, int status) {
  return {.status = status, .content_type = std::string{kJsonType}, .body = std::move(body)};
}

Response error_response(int status, std::string_view code, std::string_view message,
                        std::string_view field) {
  const nlohmann::ordered_json json = {
      {"error", {{"code", code}, {"message", message}, {"field", field}}}};
  // A message may quote what a client sent, which need not be UTF-8.
  return json_response(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n",
                       status);
}

}  // namespace recald::http
