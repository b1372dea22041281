#include "adapters/http/exchange.hpp"

#include <boost/asio/error.hpp>
#include <boost/beast/core/error.hpp>
#include <boost/beast/http/error.hpp>
#include <exception>

#include "adapters/http/target.hpp"

namespace recald::http {
namespace {

namespace beast_http = boost::beast::http;

constexpr int kHttp11 = 11;

Method method_of(beast_http::verb verb) {
  switch (verb) {
    case beast_http::verb::get:
      return Method::get;
    case beast_http::verb::head:
      return Method::head;
    case beast_http::verb::post:
      return Method::post;
    case beast_http::verb::delete_:
      return Method::remove;
    default:
      return Method::other;
  }
}

template <class Body>
void set_fields(beast_http::response<Body>& message, const Response& response, bool keep_alive) {
  if (!response.content_type.empty()) {
    message.set(beast_http::field::content_type, response.content_type);
  }
  for (const auto& [name, value] : response.headers) message.insert(name, value);
  message.keep_alive(keep_alive);
}

beast_http::status status_of(const Response& response) {
  return beast_http::int_to_status(static_cast<unsigned>(response.status));
}

/// What two programs could read as two different requests is read by neither.
/// @return or malformed
Result<void> require_one_meaning(const beast_http::request<beast_http::string_body>& message) {
  const auto hosts = message.count(beast_http::field::host);
  if (hosts > 1 || (hosts == 0 && message.version() >= kHttp11)) {
    return failure(ErrorCode::malformed, hosts == 0 ? "the header Host is missing"
                                                    : "the header Host was sent more than once");
  }
  const auto encodings = message.count(beast_http::field::transfer_encoding);
  if (encodings == 0) return {};
  const auto encoding = message[beast_http::field::transfer_encoding];
  const bool is_chunked =
      equals_ignoring_case(std::string_view{encoding.data(), encoding.size()}, "chunked");
  if (encodings > 1 || !is_chunked || message.count(beast_http::field::content_length) > 0) {
    return failure(ErrorCode::malformed,
                   "a body is sent with Content-Length, or with Transfer-Encoding: chunked");
  }
  return {};
}

bool has_body(int status) { return status != 304 && status != 204; }

}  // namespace

Result<Request> request_head(const beast_http::request<beast_http::string_body>& message) {
  TRY(require_one_meaning(message));
  const auto text = message.target();
  auto target = TRY(parse_target({text.data(), text.size()}));
  Request request{.method = method_of(message.method()),
                  .path = std::move(target.path),
                  .query = std::move(target.query)};
  for (const auto& field : message) {
    const auto name = field.name_string();
    const auto value = field.value();
    std::string& known = request.headers[to_lower(std::string_view{name.data(), name.size()})];
    if (!known.empty()) known += ", ";  // RFC 9110, 5.3: a repeated header is a list
    known.append(value.data(), value.size());
  }
  return request;
}

std::optional<Response> preflight_answer(const Request& request, const SessionRules& rules) {
  const bool is_question =
      request.method == Method::other && !request.header("access-control-request-method").empty();
  if (!is_question || !rules.origins.contains(std::string{request.header("origin")})) return {};
  return Response{.status = 204,
                  .headers = {{"Access-Control-Allow-Methods", "GET, HEAD, POST, DELETE"},
                              {"Access-Control-Allow-Headers", "authorization, content-type"},
                              {"Access-Control-Max-Age", "600"}}};
}

Response readable_by_origin(const Request& request, const SessionRules& rules, Response response) {
  if (rules.origins.empty()) return response;
  response.headers.emplace_back("Vary", "Origin");
  const std::string origin{request.header("origin")};
  if (rules.origins.contains(origin)) {
    response.headers.emplace_back("Access-Control-Allow-Origin", origin);
    response.headers.emplace_back("Access-Control-Expose-Headers", "link, location, etag");
  }
  return response;
}

std::optional<Response> refusal_of_head(const Request& request, const SessionRules& rules) {
  if (auto refusal = refusal_of_access(request, rules.access)) return refusal;
  if (request.method == Method::post) {
    std::string_view type = request.header("content-type");
    if (!equals_ignoring_case(take_element(type, ';'), "application/json")) {
      return refused(415, "unsupported_media_type",
                     "a POST needs the header Content-Type: application/json");
    }
  }
  return {};
}

bool has_folded_line(std::string_view bytes) {
  const std::string_view head = bytes.substr(0, bytes.find("\r\n\r\n"));
  return head.find("\n ") != std::string_view::npos || head.find("\n\t") != std::string_view::npos;
}

std::optional<Response> refusal_of(const boost::system::error_code& error) {
  if (error == beast_http::error::body_limit) {
    return refused(413, "too_large", "the request's body is larger than the server takes");
  }
  if (error == beast_http::error::header_limit) {
    return refused(431, "header_too_large", "the request's header is larger than the server takes");
  }
  const bool is_gone =
      error == beast_http::error::end_of_stream || error == beast_http::error::partial_message;
  static const auto& http_errors = make_error_code(beast_http::error::bad_method).category();
  if (is_gone || error.category() != http_errors) return {};
  return refused(400, "malformed", "this is not an HTTP/1.1 request: " + error.message());
}

Response bad_request(const Error& error) { return refused(400, "malformed", error.message); }

Response called(const Handler& handler, const Request& request) {
  try {
    return handler(request);
  } catch (const std::exception&) {
    return error_response(500, "internal", "the answer could not be made; the log may say why");
  }
}

beast_http::response<beast_http::string_body> wire_message(const Response& response,
                                                           bool keep_alive) {
  beast_http::response<beast_http::string_body> message{status_of(response), kHttp11};
  set_fields(message, response, keep_alive);
  if (has_body(response.status)) {
    message.body() = response.body;
    message.prepare_payload();
  }
  return message;
}

beast_http::response<beast_http::empty_body> wire_head(const Response& response, bool keep_alive) {
  beast_http::response<beast_http::empty_body> message{status_of(response), kHttp11};
  set_fields(message, response, keep_alive);
  if (has_body(response.status)) message.content_length(response.body.size());
  return message;
}

}  // namespace recald::http
