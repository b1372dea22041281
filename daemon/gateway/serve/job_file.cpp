#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <iterator>

#include "daemon/gateway/serve/pages.hpp"

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

http::Response nothing(const std::string& name) {
  return http::error_response(404, "not_found",
                              fmt::format("no job has a file {}; /model lists the jobs", name));
}

/// A plain name: letters, digits, "_", "-" and ".", not beginning with a dot.
bool is_plain(std::string_view name) {
  return !name.empty() && name.front() != '.' && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  });
}

}  // namespace

http::Response job_file(const Served& served, const std::string& number_and_file) {
  const std::size_t slash = std::min(number_and_file.find('/'), number_and_file.size());
  const std::string name = number_and_file.substr(std::min(slash + 1, number_and_file.size()));
  std::int64_t number = 0;
  const char* end = number_and_file.data() + slash;
  const auto [stop, error] = std::from_chars(number_and_file.data(), end, number);
  const auto kind =
      std::ranges::find_if(kKinds, [&](const FileKind& one) { return name.ends_with(one.ending); });
  if (error != std::errc{} || stop != end || !is_plain(name) || kind == kKinds.end()) {
    return nothing(number_and_file);
  }
  const auto job = served.store.job(number);
  if (!job) {
    return http::error_response(503, "store_unavailable",
                                "the store cannot be read: " + job.error().message);
  }
  if (!*job || (*job)->folder.empty()) return nothing(number_and_file);
  std::ifstream file(std::filesystem::path{(*job)->folder} / name, std::ios::binary);
  if (!file) return nothing(number_and_file);
  http::Response response{.content_type = kind->type,
                          .body = {std::istreambuf_iterator<char>(file), {}}};
  if (kind->ending == ".html") {
    response.headers.emplace_back("Content-Security-Policy", kReportPolicy);
  }
  return response;
}

}  // namespace recald::daemon
