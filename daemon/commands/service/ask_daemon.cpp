#include "daemon/commands/service/ask_daemon.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "adapters/http/credentials.hpp"

namespace recald::daemon {
namespace {

/// Where a daemon with this configuration can be reached from this machine.
std::string reachable_address(const std::string& listens_on) {
  if (listens_on == "0.0.0.0") return "127.0.0.1";
  if (listens_on == "::") return "::1";
  return listens_on;
}

}  // namespace

Result<Question> question_for_site(const SiteConfig& site) {
  const std::string file = site.file.filename().string();
  if (!site.http) {
    return failure(
        ErrorCode::unsupported,
        fmt::format("{}: there is no [http], so its daemon cannot be asked; add [http] with listen "
                    "= \"127.0.0.1:8080\"",
                    file));
  }
  const HttpConfig& http = *site.http;
  if (http.port == 0) {
    return failure(
        ErrorCode::unsupported,
        fmt::format(
            "{}: [http] listens on a free port that the daemon's log names; pass it with --url",
            file));
  }
  Question question;
  question.url = {.is_tls = !http.certificate_file.empty(),
                  .host = reachable_address(http.address),
                  .port = http.port};
  question.options.trusted_certificate = http.certificate_file;
  const auto reader = std::ranges::find_if(http.tokens, [](const TokenConfig& token) {
    return std::ranges::find(token.rights, "read") != token.rights.end();
  });
  const bool has_all = !http.token_file.empty();
  if (has_all || reader != http.tokens.end()) {
    question.options.token = TRY(http::read_token_file(has_all ? http.token_file : reader->file));
  }
  return question;
}

tl::expected<Question, std::vector<std::string>> question_for_file(
    const std::filesystem::path& file) {
  const auto site = TRY(load_site(file));
  auto question = question_for_site(site);
  if (!question) return tl::unexpected(std::vector{question.error().message});
  return std::move(*question);
}

Result<nlohmann::ordered_json> ask(Question question, const std::string& path) {
  question.url.path = path;
  const auto response = TRY(http::get(question.url, question.options));
  auto json = nlohmann::ordered_json::parse(response.body, nullptr, false);
  if (response.status == 401) {
    return failure(ErrorCode::invalid_value,
                   question.url.text() + " needs a token; name its file with --token-file");
  }
  if (!json.is_object() || (response.status != 200 && response.status != 503)) {
    return failure(ErrorCode::malformed, fmt::format("the server at {} is not recald (status {})",
                                                     question.url.text(), response.status));
  }
  return json;
}

}  // namespace recald::daemon
