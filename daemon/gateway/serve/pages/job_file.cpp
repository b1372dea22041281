#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>

#include "daemon/gateway/serve/api/result_response.hpp"
#include "daemon/gateway/serve/pages/pages.hpp"

namespace recald::daemon {
namespace {

http::Response nothing(const std::string& name) {
  return http::error_response(404, "not_found",
                              fmt::format("no job has a file {}; /model lists the jobs", name));
}

}  // namespace

http::Response job_file(const Served& served, const std::string& number_and_file) {
  const std::size_t slash = std::min(number_and_file.find('/'), number_and_file.size());
  const std::string name = number_and_file.substr(std::min(slash + 1, number_and_file.size()));
  std::int64_t number = 0;
  const char* end = number_and_file.data() + slash;
  const auto [stop, error] = std::from_chars(number_and_file.data(), end, number);
  if (error != std::errc{} || stop != end || !is_result_name(name)) {
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
  return result_response(name, {std::istreambuf_iterator<char>(file), {}});
}

}  // namespace recald::daemon
