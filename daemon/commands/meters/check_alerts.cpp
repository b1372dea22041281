#include "daemon/commands/meters/check_alerts.hpp"

#include <fmt/format.h>

#include <chrono>

#include "daemon/gateway/alert/deliver.hpp"

namespace recald::daemon {

std::vector<std::string> try_alerts(const SiteConfig& site, const Console& console, bool is_quiet) {
  const std::string file = site.file.filename().string();
  if (site.alerts.destinations.empty()) {
    return {file + ": there is no [alerts], so there is nobody to tell"};
  }
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  const AlertMessage message = trial_message(site, now);
  std::vector<std::string> problems;
  for (const AlertDestination& destination : site.alerts.destinations) {
    const std::string words = destination_of(destination).words;
    if (const auto sent = deliver(destination, message, {}); !sent) {
      problems.push_back(fmt::format("{}: {}: {}", file, words, sent.error().message));
    } else if (!is_quiet) {
      console.out << fmt::format("{}: a trial message was sent\n", words);
    }
  }
  return problems;
}

}  // namespace recald::daemon
