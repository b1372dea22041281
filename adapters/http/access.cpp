#include "adapters/http/access.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "adapters/http/ascii.hpp"
#include "adapters/http/credentials.hpp"
#include "adapters/http/dress.hpp"
#include "adapters/http/url.hpp"
#include "core/text/printable.hpp"

namespace recald::http {
namespace {

/// "tower.example.org" of "Tower.example.org.:8080", "::1" of "[::1]:80".
std::string host_in(std::string_view field) {
  std::string host = to_lower(field);
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    return end == std::string::npos ? host : host.substr(1, end - 1);
  }
  host = host.substr(0, host.find(':'));
  if (host.ends_with('.')) host.pop_back();
  return host;
}

Right right_for(const Request& request, const AccessRules& rules) {
  if (request.method == Method::get || request.method == Method::head) return Right::read;
  const bool is_push = request.method == Method::post && rules.push_paths.contains(request.path);
  return is_push ? Right::push : Right::operate;
}

std::string rights_in_words(const std::set<Right>& rights) {
  std::string words;
  for (const Right right : rights) {
    words += words.empty() ? "" : ", ";
    words += name_of(right);
  }
  return words;
}

std::optional<Response> refusal_of_host(const Request& request, const AccessRules& rules) {
  if (!rules.checks_host) return {};
  const std::string host = host_in(request.header("host"));
  if (host.empty() || is_this_machine(host) || rules.names.contains(host)) return {};
  constexpr std::size_t kShown_max = 100;
  return refused(421, "misdirected",
                 "this server is not called '" + printable(host.substr(0, kShown_max)) +
                     "'; if it is, list that under 'names' in [http] of its file");
}

}  // namespace

std::string_view name_of(Right right) {
  constexpr std::array<std::string_view, 3> kNames{"read", "push", "operate"};
  return kNames.at(static_cast<std::size_t>(right));
}

std::optional<Response> refusal_of_access(const Request& request, const AccessRules& rules) {
  if (auto refusal = refusal_of_host(request, rules)) return refusal;
  if (rules.tokens.empty() || rules.open_paths.contains(request.path)) return {};
  // All are compared, so that the time taken does not tell which one was near.
  const Token* carried = nullptr;
  for (const Token& token : rules.tokens) {
    if (carries_token(request.header("authorization"), token.text)) carried = &token;
  }
  if (carried == nullptr) {
    Response response = refused(401, "unauthorized",
                                "this needs the token of the site's token_file, as the header "
                                "Authorization: Bearer TOKEN, or in a browser as the password");
    response.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"recald\"");
    response.headers.emplace_back("WWW-Authenticate", "Basic realm=\"recald\"");
    return response;
  }
  const Right needed = right_for(request, rules);
  if (carried->rights.contains(needed)) return {};
  return refused(403, "forbidden",
                 "this token has the rights " + rights_in_words(carried->rights) +
                     "; this needs one with the right to " + std::string{name_of(needed)});
}

}  // namespace recald::http
