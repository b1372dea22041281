#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "adapters/http/credentials.hpp"
#include "daemon/commands/commands.hpp"
#include "daemon/commands/service/ask_daemon.hpp"

namespace recald::daemon {
namespace {

using Json = nlohmann::ordered_json;

tl::expected<Question, std::vector<std::string>> question_for(const StatusArguments& arguments) {
  if (arguments.url.empty()) return question_for_file(arguments.site);
  const auto url = http::parse_url(arguments.url);
  if (!url) return tl::unexpected(std::vector<std::string>{url.error().message});
  Question question{.url = *url};
  if (!arguments.token_file.empty()) {
    const auto token = http::read_token_file(arguments.token_file);
    if (!token) return tl::unexpected(std::vector<std::string>{token.error().message});
    question.options.token = *token;
  }
  return question;
}

/// A member as people read it; whatever answers may be of another version.
std::string words(const Json& json, const char* key) {
  if (!json.is_object() || !json.contains(key) || json[key].is_null()) return "-";
  const Json& value = json[key];
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return fmt::format("{:.5g}", value.get<double>());
  return value.dump();
}

std::string status_words(const Json& site, const Json& ready, const Json& meters) {
  std::string text =
      fmt::format("{}: {}, version {}, since {}\n", words(site, "id"), words(ready, "status"),
                  words(site, "version"), words(site, "started_at"));
  for (const Json& reason : ready.value("reasons", Json::array())) {
    if (reason.is_string()) text += "  ! " + reason.get<std::string>() + "\n";
  }
  for (const Json& look : ready.value("look_at", Json::array())) {
    if (look.is_string()) text += "  - " + look.get<std::string>() + "\n";
  }
  text += fmt::format("{:<24} {:<9} {:>10} {:>14} {:<21} {:>8}\n", "meter", "state", "kW", "kWh",
                      "last answer", "coverage");
  for (const Json& meter : meters) {
    text +=
        fmt::format("{:<24} {:<9} {:>10} {:>14} {:<21} {:>8}\n", words(meter, "id"),
                    words(meter, "state"), words(meter, "power_kW"), words(meter, "register_kWh"),
                    words(meter, "read_at"), words(meter, "open_month_coverage"));
  }
  return text;
}

}  // namespace

int run_status(const StatusArguments& arguments, const Console& console) {
  const auto question = question_for(arguments);
  if (!question) return console.fail(question.error());
  const auto ready = ask(*question, "/readyz");
  if (!ready) return console.fail(ready.error());
  const auto sites = ask(*question, "/api/v1/sites");
  if (!sites) return console.fail(sites.error());
  const auto meters = ask(*question, "/api/v1/meters");
  if (!meters) return console.fail(meters.error());
  const Json site_list = sites->value("sites", Json::array());
  const Json site = site_list.is_array() && !site_list.empty() ? site_list[0] : Json();
  const Json meter_list = meters->value("meters", Json::array());
  if (arguments.json) {
    const Json json = {{"site", site}, {"ready", *ready}, {"meters", meter_list}};
    console.out << json.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
  } else {
    console.out << status_words(site, *ready, meter_list);
  }
  return kSuccess;
}

}  // namespace recald::daemon
