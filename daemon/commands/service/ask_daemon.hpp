/// Asks a running daemon over HTTP.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "adapters/http/client.hpp"
#include "daemon/site/config/site_config.hpp"

namespace recald::daemon {

/// Whom to ask, and how.
struct Question {
  http::Url url;
  http::ClientOptions options;
};

/// How to ask the daemon of a site from this machine.
/// @return or why it cannot be asked: no [http], a free port, or a token that cannot be read.
[[nodiscard]] Result<Question> question_for_site(const SiteConfig& site);

/// The same of a site file. @return the question, or every problem of the file.
[[nodiscard]] tl::expected<Question, std::vector<std::string>> question_for_file(
    const std::filesystem::path& file);

/// One route's JSON. 503 is an answer too: /readyz gives its reasons with it.
/// @return or as http::get; invalid_value: it needs a token; malformed: it is not recald.
[[nodiscard]] Result<nlohmann::ordered_json> ask(Question question, const std::string& path);

}  // namespace recald::daemon
