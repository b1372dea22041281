// A request target or an address that is accepted, written plainly, is the same again.
#include "adapters/http/target.hpp"
#include "adapters/http/url.hpp"
#include "tests/fuzz/require.hpp"

namespace recald::fuzz {
namespace {

using http::Target;
using http::Url;

/// Every byte as an escape: nothing is left to interpret.
std::string escaped(std::string_view text) {
  constexpr std::string_view kHexDigits = "0123456789ABCDEF";
  std::string written;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    written += '%';
    written += kHexDigits[byte >> 4];
    written += kHexDigits[byte & 0xF];
  }
  return written;
}

void require_same_again(const Target& target) {
  require(target.path.starts_with('/'), "a path begins with /");
  std::string written = "/" + escaped(target.path.substr(1));
  char mark = '?';
  for (const auto& [name, value] : target.query) {
    written += mark + escaped(name) + "=" + escaped(value);
    mark = '&';
  }
  if (written.size() > 8 * 1024) return;  // three times as long as it came
  const auto again = http::parse_target(written);
  require(again.has_value(), "what was written is a target");
  require(again->path == target.path && again->query == target.query, "and the same one");
}

void require_same_again(const Url& url) {
  require(!url.host.empty(), "an address has a host");
  const auto again = http::parse_url(url.text());
  require(again.has_value(), "what was written is an address");
  require(again->is_tls == url.is_tls && again->host == url.host && again->port == url.port &&
              again->path == url.path,
          "and the same one");
}

template <class Parsed>
void require_sound(const Result<Parsed>& parsed) {
  if (parsed) {
    require_same_again(*parsed);
  } else {
    require_sentence(parsed.error().message);
  }
}

}  // namespace
}  // namespace recald::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace recald::fuzz;
  require_sound(recald::http::parse_target(text_of(data, size)));
  require_sound(recald::http::parse_url(text_of(data, size)));
  return 0;
}
