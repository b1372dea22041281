#include "adapters/http/client.hpp"

#include <utility>

#include "adapters/curl/transfer.hpp"

namespace recald::http {
namespace {

struct Body {
  std::string text;
  std::size_t bytes_max;
};

/// Fewer bytes than were offered end the transfer.
std::size_t keep(char* bytes, std::size_t, std::size_t count, void* kept) {
  auto& body = *static_cast<Body*>(kept);
  if (count > body.bytes_max - body.text.size()) return 0;
  body.text.append(bytes, count);
  return count;
}

tl::unexpected<Error> no_answer(const Url& url, const curl::Handle& handle,
                                const curl::Outcome& outcome) {
  if (outcome.code == CURLE_WRITE_ERROR) {
    return failure(ErrorCode::io_failed,
                   "asking " + url.text() + " failed: the answer is too long");
  }
  curl_off_t connected_us = 0;
  curl_easy_getinfo(handle.get(), CURLINFO_CONNECT_TIME_T, &connected_us);
  if (connected_us == 0) {
    return failure(ErrorCode::not_found, "nothing answers at " + url.text() + ": " + outcome.why);
  }
  return failure(ErrorCode::io_failed, "asking " + url.text() + " failed: " + outcome.why);
}

Response response_of(const curl::Handle& handle, std::string body) {
  long status = 0;
  curl_easy_getinfo(handle.get(), CURLINFO_RESPONSE_CODE, &status);
  Response response{.status = static_cast<int>(status), .body = std::move(body)};
  for (curl_header* header = nullptr;
       (header = curl_easy_nextheader(handle.get(), CURLH_HEADER, -1, header)) != nullptr;) {
    response.headers.emplace_back(header->name, header->value);
  }
  response.content_type = response.header("Content-Type");
  return response;
}

}  // namespace

Result<Response> get(const Url& url, const ClientOptions& options) {
  const curl::Handle handle =
      curl::open_transfer(url.text(), {.protocols = "http,https",
                                       .trusted_certificate = options.trusted_certificate,
                                       .connect_timeout = options.timeout,
                                       .timeout = options.timeout});
  if (!handle) {
    return failure(ErrorCode::io_failed, "asking " + url.text() + " failed: not enough memory");
  }
  CURL* const easy = handle.get();
  curl_easy_setopt(easy, CURLOPT_HTTP_VERSION, static_cast<long>(CURL_HTTP_VERSION_1_1));
  curl_easy_setopt(easy, CURLOPT_PATH_AS_IS, 1L);
  curl_easy_setopt(easy, CURLOPT_NOPROXY, "*");  // a daemon is near
  // A daemon's own certificate, which seldom has the name by which it is asked.
  if (!options.trusted_certificate.empty()) curl_easy_setopt(easy, CURLOPT_SSL_VERIFYHOST, 0L);
  curl_easy_setopt(easy, CURLOPT_USERAGENT, "recald");
  curl::List headers;
  curl::add(headers, "Connection: close");
  if (!options.token.empty()) curl::add(headers, "Authorization: Bearer " + options.token);
  curl_easy_setopt(easy, CURLOPT_HTTPHEADER, headers.get());
  Body body{.text = {}, .bytes_max = options.body_max};
  curl_easy_setopt(easy, CURLOPT_WRITEFUNCTION, keep);
  curl_easy_setopt(easy, CURLOPT_WRITEDATA, &body);
  const curl::Outcome outcome = curl::perform(handle);
  if (outcome.code != CURLE_OK) return no_answer(url, handle, outcome);
  return response_of(handle, std::move(body.text));
}

}  // namespace recald::http
