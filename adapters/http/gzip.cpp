#include "adapters/http/gzip.hpp"

#include <zlib.h>

#include <cassert>
#include <optional>

#include "adapters/http/ascii.hpp"

namespace recald::http {
namespace {

/// "gzip;q=0.5": only a weight of zero, with any number of digits, refuses it.
bool is_wanted(std::string_view parameters) {
  while (!parameters.empty()) {
    const std::string_view parameter = take_element(parameters, ';');
    if (parameter.size() < 2 || to_lower(parameter[0]) != 'q' || parameter[1] != '=') continue;
    return parameter.substr(2).find_first_of("123456789") != std::string_view::npos;
  }
  return true;
}

}  // namespace

bool accepts_gzip(std::string_view accept_encoding) {
  std::optional<bool> named;
  bool any = false;
  while (!accept_encoding.empty()) {
    std::string_view parameters = take_element(accept_encoding);
    const std::string_view coding = take_element(parameters, ';');
    if (equals_ignoring_case(coding, "gzip") || equals_ignoring_case(coding, "x-gzip")) {
      named = is_wanted(parameters);
    } else if (coding == "*") {
      any = is_wanted(parameters);
    }
  }
  return named.value_or(any);
}

std::string gzip(std::string_view text) {
  constexpr int kGzipWindow = 15 + 16;  // zlib's code for a gzip frame
  constexpr int kMemory = 8;
  z_stream stream{};
  [[maybe_unused]] const int begun =
      deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, kGzipWindow, kMemory, Z_DEFAULT_STRATEGY);
  assert(begun == Z_OK);
  std::string packed(deflateBound(&stream, text.size()), '\0');
  // zlib reads through a pointer to non-const, but does not write there.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  [[maybe_unused]] const int ended = deflate(&stream, Z_FINISH);
  assert(ended == Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

}  // namespace recald::http
