#include "adapters/http/target.hpp"

#include <algorithm>
#include <optional>

#include "core/text/utf8.hpp"

namespace recald::http {
namespace {

constexpr std::size_t kLengthMax = 8 * 1024;
constexpr std::size_t kNamesMax = 32;

std::optional<int> hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return {};
}

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

Result<std::string> decode(std::string_view text, bool plus_is_space) {
  std::string decoded;
  decoded.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '+' && plus_is_space) c = ' ';
    if (c == '%') {
      const auto high = i + 2 < text.size() ? hex_digit(text[i + 1]) : std::nullopt;
      const auto low = i + 2 < text.size() ? hex_digit(text[i + 2]) : std::nullopt;
      if (!high || !low) {
        return failure(ErrorCode::malformed,
                       "a % in the request's target is not followed by two hexadecimal digits");
      }
      c = static_cast<char>(*high * 16 + *low);
      i += 2;
    }
    if (is_control(c)) {
      return failure(ErrorCode::malformed, "the request's target has a control character");
    }
    decoded += c;
  }
  if (!is_utf8(decoded)) return failure(ErrorCode::malformed, "the request's target is not UTF-8");
  return decoded;
}

Result<std::map<std::string, std::string>> parse_query(std::string_view text) {
  std::map<std::string, std::string> query;
  while (!text.empty()) {
    const std::string_view pair = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(pair.size() + 1, text.size()));
    if (pair.empty()) continue;
    const std::size_t equals = pair.find('=');
    auto name = TRY(decode(pair.substr(0, equals), true));
    auto value = TRY(decode(equals == std::string_view::npos ? "" : pair.substr(equals + 1), true));
    if (query.size() == kNamesMax) {
      return failure(ErrorCode::malformed, "the request's query has more than 32 parameters");
    }
    const auto [at, is_new] = query.emplace(std::move(name), std::move(value));
    if (!is_new) {
      return failure(ErrorCode::malformed,
                     "the request's query has '" + at->first + "' more than once");
    }
  }
  return query;
}

/// "http://host/path" without scheme and host; a proxy may send this form.
std::string_view without_authority(std::string_view text) {
  const std::size_t scheme = text.find("://");
  if (text.starts_with('/') || scheme == std::string_view::npos) return text;
  const std::size_t path = text.find('/', scheme + 3);
  return path == std::string_view::npos ? std::string_view{"/"} : text.substr(path);
}

}  // namespace

Result<Target> parse_target(std::string_view text) {
  if (text.size() > kLengthMax) {
    return failure(ErrorCode::malformed, "the request's target is longer than 8 KiB");
  }
  text = without_authority(text);
  if (!text.starts_with('/')) {
    return failure(ErrorCode::malformed, "the request's target does not begin with '/'");
  }
  if (text.find('#') != std::string_view::npos) {
    return failure(ErrorCode::malformed,
                   "the request's target has a '#', which stays with clients");
  }
  const std::size_t mark = text.find('?');
  auto path = TRY(decode(text.substr(0, mark), false));
  auto query = TRY(parse_query(mark == std::string_view::npos ? "" : text.substr(mark + 1)));
  return Target{std::move(path), std::move(query)};
}

}  // namespace recald::http
