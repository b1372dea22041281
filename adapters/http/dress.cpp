#include "adapters/http/dress.hpp"

#include "adapters/http/ascii.hpp"
#include "adapters/http/gzip.hpp"
#include "adapters/system/files/sha256.hpp"

namespace recald::http {
namespace {

constexpr std::size_t kWorthPacking = 1024;
constexpr std::size_t kTagDigits = 32;

constexpr std::pair<const char*, const char*> kSafety[] = {
    {"Content-Security-Policy",
     "default-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'self'"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Referrer-Policy", "no-referrer"},
};

std::string_view without_weakness(std::string_view etag) {
  if (etag.starts_with("W/")) etag.remove_prefix(2);
  return etag;
}

}  // namespace

std::string etag_of(std::string_view body) {
  system::Sha256 digest;
  digest.add(body);
  return "W/\"" + digest.hex().substr(0, kTagDigits) + "\"";
}

bool matches_etag(std::string_view if_none_match, std::string_view etag) {
  while (!if_none_match.empty()) {
    // Our own tags have no comma, so a tag that a comma splits is not ours.
    const std::string_view tag = take_element(if_none_match);
    if (tag == "*" || without_weakness(tag) == without_weakness(etag)) return true;
  }
  return false;
}

Response dressed(const Request& request, Response response) {
  for (const auto& [name, value] : kSafety) {
    if (response.header(name).empty()) response.headers.emplace_back(name, value);
  }
  if (response.header("Cache-Control").empty()) {
    response.headers.emplace_back("Cache-Control", "private, no-cache");
  }
  const bool is_read = request.method == Method::get || request.method == Method::head;
  if (is_read && response.status == 200) {
    const std::string etag = etag_of(response.body);
    response.headers.emplace_back("ETag", etag);
    response.headers.emplace_back("Vary", "Accept-Encoding");
    if (matches_etag(request.header("if-none-match"), etag)) {
      response.status = 304;
      response.body.clear();
      response.content_type.clear();
      return response;
    }
  }
  if (response.body.size() >= kWorthPacking && accepts_gzip(request.header("accept-encoding"))) {
    response.body = gzip(response.body);
    response.headers.emplace_back("Content-Encoding", "gzip");
  }
  return response;
}

}  // namespace recald::http
