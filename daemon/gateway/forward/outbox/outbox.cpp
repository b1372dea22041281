#include "daemon/gateway/forward/outbox/outbox.hpp"

#include <fmt/format.h>

#include "adapters/system/files/sha256.hpp"

namespace recald::daemon {

std::string destination_id(std::string_view kind, const std::string& address) {
  system::Sha256 digest;
  digest.add(address);
  return fmt::format("{} {}", kind, digest.hex().substr(0, 16));
}

void Outbox::report(Severity severity, std::string kind, std::string text) const {
  notify_({.time = loop_.now().instant(),
           .severity = severity,
           .kind = std::move(kind),
           .subject = destination_.words,
           .text = std::move(text),
           .is_counted = true});
}

}  // namespace recald::daemon
