/// A request and its response as values, so neither handlers nor tests need a socket.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace recald::http {

enum class Method : std::uint8_t { get, head, post, remove, other };

struct Request {
  Method method = Method::get;
  std::string path = "/";                      ///< Decoded, without the query.
  std::map<std::string, std::string> query;    ///< Decoded.
  std::map<std::string, std::string> headers;  ///< Names in lower case.
  std::string body;

  /// Empty if it was not sent.
  [[nodiscard]] std::string_view header(const std::string& lower_case_name) const;
};

struct Response {
  int status = 200;
  std::string content_type;
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;  ///< Besides type and length.

  /// Empty if absent. The name may be in any case.
  [[nodiscard]] std::string_view header(std::string_view name) const;
};

using Handler = std::function<Response(const Request&)>;

inline constexpr std::string_view kJsonType = "application/json; charset=utf-8";

[[nodiscard]] Response json_response(std::string body, int status = 200);

/// {"error":{"code","message","field"}} in JSON.
/// @param code   A stable word for programs: "not_found".
/// @param field  The parameter or key at fault, or empty.
[[nodiscard]] Response error_response(int status, std::string_view code, std::string_view message,
                                      std::string_view field = "");

}  // namespace recald::http
