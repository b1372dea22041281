#include "daemon/gateway/serve/api/result_response.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace recald::daemon {
namespace {

struct FileKind {
  std::string_view ending;
  const char* type;
};
constexpr std::array kKinds{FileKind{".html", "text/html; charset=utf-8"},
                            FileKind{".json", "application/json; charset=utf-8"},
                            FileKind{".csv", "text/csv; charset=utf-8"}};

/// A report brings its script and style along; its own policy, in the page, allows just these by
/// their hashes. Nothing comes from outside, and nothing of this site either.
constexpr const char* kReportPolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'; sandbox allow-scripts "
    "allow-downloads allow-modals";

const FileKind* kind_of(std::string_view name) {
  const auto kind =
      std::ranges::find_if(kKinds, [&](const FileKind& one) { return name.ends_with(one.ending); });
  return kind == kKinds.end() ? nullptr : &*kind;
}

}  // namespace

bool is_result_name(std::string_view name) {
  return !name.empty() && name.front() != '.' && kind_of(name) != nullptr &&
         std::ranges::all_of(name, [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '_' || c == '-' || c == '.';
         });
}

http::Response result_response(std::string_view name, std::string bytes) {
  const FileKind* const kind = kind_of(name);
  http::Response response{.content_type = kind->type, .body = std::move(bytes)};
  if (kind->ending == ".html") {
    response.headers.emplace_back("Content-Security-Policy", kReportPolicy);
  }
  return response;
}

}  // namespace recald::daemon
